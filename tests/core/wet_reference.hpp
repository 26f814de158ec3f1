#pragma once
// What the tests of the wet shock's theory compare with: numbers of the validation table and a type of 168 bits.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "cradle/core/theory/wet_shock.hpp"

namespace cradle::test {

using Wide = boost::multiprecision::cpp_bin_float_50;  // expression templates on

inline constexpr double ulp = std::numeric_limits<double>::epsilon();
// Identities evaluated in Wide: a few thousand roundings of 2^-168, some after factors of up to 1e4.
inline const Wide tiny = pow(Wide(10), -42);

inline Wide decimal(const char* digits) { return Wide(std::string(digits)); }

// In the paper's units, u0 = 1/2.
template <class T> theory::WetShock<T> paper_shock(const T& loss, std::uint64_t particles = 0) {
  theory::WetShock<T> shock{loss};
  shock.particles = particles;
  return shock;
}

// Half a unit in the last place that the reference was printed to.
inline Wide printed_tolerance(const std::string& digits) {
  const auto point = digits.find('.');
  const auto places = point == std::string::npos ? 0 : static_cast<int>(digits.size() - point - 1);
  return pow(Wide(10), -places) * Wide(51) / Wide(100);
}

#define EXPECT_DIGITS(value, digits)                                                                                   \
  EXPECT_LE(abs(Wide((value)-decimal(digits))), printed_tolerance(digits)) << "value " << Wide(value).str(30)

inline void expect_close(const Wide& value, const Wide& expected, const Wide& relative, const std::string& what) {
  EXPECT_LE(abs(Wide(value - expected)), Wide(relative * abs(expected))) << what << ": " << value << " / " << expected;
}

// The front at its turnover, continuous and discrete, u0 = 1/2.
struct WetTurnover {
  const char *loss, *contacts, *time, *reach;
  std::uint64_t n;
  const char *discrete_time, *discrete_reach;
};
// Source: the table, and (8) and its recursion evaluated anew with 40 digits. (The table has the last digit of n* at
// .01, 36.79104537654821436, one unit too low.)
inline constexpr std::array<WetTurnover, 3> turnovers{
    WetTurnover{"1e-4", "3749.30670274438751", "4998.99976654257587", "1249.80681947309957", 3750,
                "4999.69313159489030", "1250.15343420255485"},
    WetTurnover{"0.01", "36.7910453765482144", "48.9753271281127897", "12.3033818124918195", 38, "50.6955378875243860",
                "12.6522310562378070"},
    WetTurnover{"0.05", "6.70069531050542507", "8.83037948678282598", "2.28550556711401208", 8, "10.7070144550196890",
                "2.64649277249015549"}};

}  // namespace cradle::test
