#pragma once
// The collapse of three_particles() in numbers (McNamara and Young, Phys. Fluids A 4, 496 (1992), evaluated to 40
// digits).

#include <ostream>

namespace cradle::test {

struct ThreeCollapse {
  double restitution;
  const char* collapse_time;
  int passes_e16, passes_e34, passes_e100, passes_e300;  // collision at which the gap is first below 1e-16, ...
  unsigned plain_clock_stops;                            // last collision that moves a plain clock, in double

  friend void PrintTo(const ThreeCollapse& r, std::ostream* out) { *out << "eps=" << r.restitution; }
};
inline constexpr ThreeCollapse three_collapses[] = {
    {.05, "1.714285714285714285714285714285714285714285714286", 18, 38, 111, 333, 31},
    {.01, "1.6736937682559527405521559675474991365441632665957", 11, 21, 61, 179, 13},
    {1. / 16, "1.7377984054260977582367587110958928498213699562943", 22, 45, 133, 398, 49},
};

}  // namespace cradle::test
