#pragma once
// The collapse of three_particles() in numbers (McNamara and Young, Phys. Fluids A 4, 496 (1992), evaluated to 40
// digits).

#include <array>
#include <cstdint>
#include <ostream>
#include <string>

namespace cradle::test {

struct ThreeCollapse {
  const char *eps, *collapse_time;
  std::array<std::uint64_t, 4> passes;  // collision at which the gap is first below 1e-16, 1e-34, 1e-100, 1e-300
  std::uint64_t plain_clock_stops;      // last collision that moves a plain clock, in double

  double restitution() const { return std::stod(eps); }
  friend void PrintTo(const ThreeCollapse& r, std::ostream* out) { *out << "eps=" << r.eps; }
};
inline constexpr ThreeCollapse three_collapses[] = {
    {"0.05", "1.714285714285714285714285714285714285714285714286", {18, 38, 111, 333}, 31},
    {"0.01", "1.6736937682559527405521559675474991365441632665957", {11, 21, 61, 179}, 13},
    {"0.0625", "1.7377984054260977582367587110958928498213699562943", {22, 45, 133, 398}, 49},
};

}  // namespace cradle::test
