// Decimal literals in parts: sign, digits and a power of ten.
#pragma once

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

namespace cradle::tools {

// `power`: the power of ten of the last digit.
struct DecimalParts {
  bool negative = false;
  std::string digits;
  std::int64_t power = 0;

  // The number is 0.d1 d2 d3 ... times 10^exponent.
  std::int64_t exponent() const { return power + std::ssize(digits); }
};

// With the digits as they are written.
DecimalParts literal_of(std::string_view text);
// Neither the first digit nor the last one is 0; zero has no digits.
DecimalParts parts_of(std::string_view text);

using WithPower = bool (*)(std::int64_t power, std::int64_t digits);

// Without zeros at the end; see rational.hpp.
std::string decimal_text(const DecimalParts& number, WithPower with_power);

}  // namespace cradle::tools
