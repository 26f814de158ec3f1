#pragma once
// Exact arithmetic: quotients of integers of any size, without expression templates, as the engine's scalar. It is the
// reference for small cases: without rounding every identity of the dynamics holds with ==.

#include <algorithm>
#include <string>

#include <boost/multiprecision/cpp_int.hpp>

#include "cradle/core/base/real.hpp"

namespace cradle::test {

using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;

// A double as a quotient of integers, beside those of other types.
using cradle::exactly;
inline Rational exactly(double x) { return Rational(x); }

// Converts 12.5, -3e-20 without rounding if T is rational.
template <class T> T decimal(const std::string& text) {
  const auto e = text.find_first_of("eE");
  std::string digits = text.substr(0, e);
  long power = e == text.npos ? 0 : std::stol(text.substr(e + 1));
  const bool negative = digits.starts_with('-');
  if (negative || digits.starts_with('+')) digits.erase(0, 1);
  if (const auto point = digits.find('.'); point != digits.npos) {
    power -= static_cast<long>(digits.size() - point - 1);
    digits.erase(point, 1);
  }
  // Boost reads a leading 0 as octal.
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
  using Integer = boost::multiprecision::cpp_int;
  const Integer shift = pow(Integer(10), static_cast<unsigned>(power < 0 ? -power : power));
  const T size = power < 0 ? T(T(Integer(digits)) / T(shift)) : T(Integer(Integer(digits) * shift));
  return negative ? T(-size) : size;
}

}  // namespace cradle::test
