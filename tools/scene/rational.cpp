#include "cradle/tools/scene/rational.hpp"

#include <cstdlib>

namespace cradle::tools {
namespace {

constexpr long most_exponent = 5000;

}  // namespace

Whole power_of_ten(long exponent) { return pow(Whole(10), static_cast<unsigned>(exponent)); }

std::optional<Rational> rational(std::string_view decimal) {
  std::string text(decimal);
  long exponent = 0;
  if (const auto e = text.find_first_of("eE"); e != text.npos) {
    exponent = std::stol(text.substr(e + 1));
    text.resize(e);
  }
  if (const auto point = text.find('.'); point != text.npos) {
    exponent -= static_cast<long>(text.size() - point - 1);
    text.erase(point, 1);
  }
  if (std::abs(exponent) > most_exponent) return {};
  const bool negative = text.starts_with('-');
  const auto first = text.find_first_not_of("-0");
  const Whole digits(first == text.npos ? "0" : text.substr(first));
  const Whole scale = power_of_ten(std::abs(exponent));
  const Rational number = exponent < 0 ? Rational(digits, scale) : Rational(digits * scale);
  return negative ? Rational(-number) : number;
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
