#include "cradle/tools/scene/rational.hpp"

#include <cstdlib>

namespace cradle::tools {

Whole power_of_ten(long exponent) { return pow(Whole(10), static_cast<unsigned>(exponent)); }

std::optional<Rational> rational(std::string_view decimal) {
  constexpr long most_exponent = 5000;
  const auto [digits, power] = scaled(decimal);
  if (std::abs(power) > most_exponent) return {};
  const Whole scale = power_of_ten(std::abs(power));
  return power < 0 ? Rational(digits, scale) : Rational(digits * scale);
}

std::string decimal_text(const Rational& number, unsigned digits) {
  if (number == 0) return "0";
  const Whole top = abs(numerator(number)), bottom = denominator(number);
  const auto length = [](const Whole& of) { return static_cast<long>(of.str().size()); };
  const long unit = length(top) - length(bottom) - static_cast<long>(digits);
  const Whole scaled = unit < 0 ? Whole(top * power_of_ten(-unit)) : top,
              by = unit < 0 ? bottom : Whole(bottom * power_of_ten(unit));
  const Whole quotient = scaled / by;
  const bool exact = quotient * by == scaled;
  return (number < 0 ? "-" : "") + quotient.str() + (exact ? "0" : "1") + "e" + std::to_string(unit - 1);
}

}  // namespace cradle::tools
