#pragma once
// Reference numbers for tests of the wet shock's theory, from the validation table.

#include <array>

#include "cradle/core/theory/wet_shock.hpp"
#include "cradle/tests/core/digits.hpp"

namespace cradle::test {

inline constexpr double ulp = std::numeric_limits<double>::epsilon();
// Tolerance for identities in Wide: a few thousand roundings of 2^-168, some multiplied by up to 1e4.
inline const Wide tiny = pow(Wide(10), -42);

// A shock in the paper's units, u0 = 1/2.
template <class T> theory::WetShock<T> paper_shock(const T& loss, std::uint64_t particles = 0) {
  return {.loss = loss, .particles = particles};
}

// The front at its turnover, continuous and discrete, u0 = 1/2.
struct WetTurnover {
  const char *loss, *collisions, *time, *reach;
  std::uint64_t n;
  const char *discrete_time, *discrete_reach;
};
// Source: the table, and (8) and its recursion evaluated anew with 40 digits. (The table has the last digit of n* at
// 0.01, 36.79104537654821436, one unit too low.)
inline constexpr std::array<WetTurnover, 3> turnovers{
    WetTurnover{"1e-4", "3749.30670274438751", "4998.99976654257587", "1249.80681947309957", 3750,
                "4999.69313159489030", "1250.15343420255485"},
    WetTurnover{"0.01", "36.7910453765482144", "48.9753271281127897", "12.3033818124918195", 38, "50.6955378875243860",
                "12.6522310562378070"},
    WetTurnover{"0.05", "6.70069531050542507", "8.83037948678282598", "2.28550556711401208", 8, "10.7070144550196890",
                "2.64649277249015549"}};

}  // namespace cradle::test
