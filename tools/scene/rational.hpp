// Decimals as quotients of integers of any size, for what is computed exactly from numbers of a scene.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {

using Rational = boost::multiprecision::cpp_rational;
using Whole = boost::multiprecision::cpp_int;

/// An integer times a power of ten.
struct Scaled {
  Whole integer;
  std::int64_t power = 0;
};
/// The value of a canonical decimal, without zeros at the end of the integer; 0 has the power 0.
Scaled scaled(std::string_view decimal);

/// Without zeros at the end.
std::string decimal_text(Scaled number, WithPower with_power);

/// For exponents of 0 and more.
Whole power_of_ten(long exponent);

/// The value of a canonical decimal. Nothing for a power of ten beyond 5000.
std::optional<Rational> rational(std::string_view decimal);

/// A decimal of this many digits; one more, not 0, if they are not all: it is rounded to the same number in any type of
/// fewer digits.
std::string decimal_text(const Rational& number, unsigned digits);

}  // namespace cradle::tools
