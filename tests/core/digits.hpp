#pragma once
// Numbers known to many digits, and a type of 168 bits to compare the theories with them.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <string>

namespace cradle::test {

using Wide = boost::multiprecision::cpp_bin_float_50;  // expression templates on
template <unsigned digits>                             // without
using Digits =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<digits>, boost::multiprecision::et_off>;

inline Wide decimal(const char* digits) { return Wide(std::string(digits)); }

// Half a unit in the last printed place of the reference.
inline Wide printed_tolerance(const std::string& digits) {
  const auto point = digits.find('.');
  const auto places = point == std::string::npos ? 0 : static_cast<int>(digits.size() - point - 1);
  return pow(Wide(10), -places) * Wide(51) / Wide(100);
}

#define EXPECT_WITHIN(value, expected, bound) EXPECT_LE(abs(Wide((value) - (expected))), Wide(bound))
#define EXPECT_DIGITS(value, digits)                                                                                   \
  EXPECT_WITHIN(value, decimal(digits), printed_tolerance(digits)) << "value " << Wide(value).str(30)

inline void expect_close(const Wide& value, const Wide& expected, const Wide& relative, const std::string& what) {
  EXPECT_LE(abs(Wide(value - expected)), Wide(relative * abs(expected))) << what << ": " << value << " / " << expected;
}

}  // namespace cradle::test
