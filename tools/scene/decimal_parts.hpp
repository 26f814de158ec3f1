// Decimal literals in parts: sign, digits and a power of ten.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cradle::tools {

// The digits as they are written, and the power of ten of the last one.
struct DecimalLiteral {
  bool negative = false;
  std::string digits;
  std::int64_t power = 0;
};

DecimalLiteral literal_of(std::string_view text);

// The number 0.d1 d2 d3 ... times 10^exponent; d1 and the last digit are not 0; zero has no digits.
struct DecimalParts {
  bool negative = false;
  std::string digits;
  std::int64_t exponent = 0;
};

DecimalParts parts_of(std::string_view text);

using WithPower = bool (*)(std::int64_t power, std::int64_t digits);

// The digits, which may begin with zeros, times a power of ten; see rational.hpp.
std::string decimal_text(bool negative, std::string digits, std::int64_t power, WithPower with_power);

}  // namespace cradle::tools
