#include "cradle/tools/threshold/threshold.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "cradle/tools/scene/rational.hpp"

namespace cradle::tools {

namespace {

constexpr long most_digits = 5000;

Scaled within_limits(const Decimal& number) {
  Scaled parts = scaled(number.text);
  if (std::abs(parts.power) > most_digits)
    throw Error({"", 0, "--vary"}, "a number of too many digits", number.text,
                fmt::format("give ends between 1e-{0} and 1e{0}", most_digits));
  return parts;
}

// The largest power of ten that is not above a number, which is not 0.
long magnitude(const Scaled& number) {
  return static_cast<long>(Whole(abs(number.integer)).str().size()) - 1 + number.power;
}

// number/10^unit, rounded down
Whole floor_in(const Scaled& number, long unit) {
  if (number.power >= unit) return number.integer * power_of_ten(number.power - unit);
  const Whole divisor = power_of_ten(unit - number.power);
  Whole quotient = number.integer / divisor;
  if (quotient * divisor > number.integer) --quotient;
  return quotient;
}

Decimal decimal(const Whole& multiple, long unit) {
  constexpr auto many_zeros = [](std::int64_t power, std::int64_t digits) {
    return power > 30 || power + digits < -30;
  };
  return Decimal(decimal_text({multiple, unit}, many_zeros));
}

}  // namespace

Bracket::Bracket(Decimal low, Decimal high, unsigned digits, bool whole)
    : low_(std::move(low)), high_(std::move(high)) {
  const Scaled a = within_limits(low_), b = within_limits(high_);
  unit_ = std::max(a.integer == 0 ? b.power : magnitude(a), b.integer == 0 ? a.power : magnitude(b));
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
  const Scaled a = within_limits(low_), b = within_limits(high_);
  for (;; --unit_) {
    const Whole first = floor_in(a, unit_) + 1, last = -floor_in({-b.integer, b.power}, unit_) - 1;
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
