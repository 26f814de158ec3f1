#include "cradle/tools/threshold/bracket.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cradle/tools/scene/rational.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

constexpr long most_digits = 5000;

// mantissa times 10^exponent
struct Scaled {
  Whole mantissa;
  long exponent = 0;
};

Scaled scaled(const Decimal& number) {
  std::string text = number.text;
  Scaled parts;
  if (const auto e = text.find_first_of("eE"); e != text.npos) {
    parts.exponent = std::stol(text.substr(e + 1));
    text.resize(e);
  }
  const bool negative = text.starts_with('-');
  if (negative) text.erase(0, 1);
  if (const auto point = text.find('.'); point != text.npos) {
    parts.exponent -= static_cast<long>(text.size() - point - 1);
    text.erase(point, 1);
  }
  text.erase(0, std::min(text.find_first_not_of('0'), text.size() - 1));
  parts.mantissa = Whole(text);
  if (negative) parts.mantissa = -parts.mantissa;
  if (std::abs(parts.exponent) > most_digits)
    throw Error({"", 0, "--vary"}, "a number of too many digits", number.text,
                fmt::format("give ends between 1e-{0} and 1e{0}", most_digits));
  return parts;
}

// The largest power of ten that is not above a number, which is not 0.
long magnitude(const Scaled& number) {
  return static_cast<long>(Whole(abs(number.mantissa)).str().size()) - 1 + number.exponent;
}

// number/10^unit, rounded down
Whole floor_in(const Scaled& number, long unit) {
  if (number.exponent >= unit) return number.mantissa * power_of_ten(number.exponent - unit);
  const Whole divisor = power_of_ten(unit - number.exponent);
  Whole quotient = number.mantissa / divisor;
  if (quotient * divisor > number.mantissa) --quotient;
  return quotient;
}

Decimal decimal(const Whole& multiple, long unit) {
  std::string digits = Whole(abs(multiple)).str();
  if (multiple == 0) return Decimal("0");
  while (digits.size() > 1 && digits.back() == '0') digits.pop_back(), ++unit;
  constexpr long most_zeros = 30;
  const auto size = static_cast<long>(digits.size());
  if (unit > most_zeros || unit + size < -most_zeros) {
    digits += "e" + std::to_string(unit);
  } else if (unit >= 0) {
    digits.append(static_cast<std::size_t>(unit), '0');
  } else {
    if (size <= -unit) digits.insert(0, static_cast<std::size_t>(1 - unit - size), '0');
    digits.insert(digits.size() - static_cast<std::size_t>(-unit), 1, '.');
  }
  return Decimal((multiple < 0 ? "-" : "") + digits);
}

}  // namespace

Bracket::Bracket(Decimal low, Decimal high, unsigned digits, bool whole)
    : low_(std::move(low)), high_(std::move(high)) {
  const Scaled a = scaled(low_), b = scaled(high_);
  unit_ = std::max(a.mantissa == 0 ? b.exponent : magnitude(a), b.mantissa == 0 ? a.exponent : magnitude(b));
  last_ = unit_ + 1 - static_cast<long>(digits);
  if (whole) last_ = 0;
  unit_ = std::max(unit_, last_);
  find_next();
}

void Bracket::narrow(bool as_at_low) {
  (as_at_low ? low_ : high_) = next_.value();
  find_next();
}

void Bracket::find_next() {
  const Scaled a = scaled(low_), b = scaled(high_);
  for (;; --unit_) {
    const Whole first = floor_in(a, unit_) + 1, last = -floor_in({-b.mantissa, b.exponent}, unit_) - 1;
    next_.reset();
    if (first <= last) next_ = decimal((first + last) / 2, unit_);
    if (next_ || unit_ <= last_) return;
  }
}

unsigned Bracket::values_left() const {
  if (!next_) return 0;
  constexpr long tenths_per_digit = 34;  // bisection among nine values
  return static_cast<unsigned>(((unit_ - last_ + 1) * tenths_per_digit + 9) / 10);
}

}  // namespace cradle::tools
