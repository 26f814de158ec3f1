#include "cradle/tools/engines/number.hpp"

namespace cradle::tools {

namespace {

struct DecimalNumber final : ExactNumber {
  explicit DecimalNumber(std::string decimal) : digits(std::move(decimal)) {}
  std::string text() const override { return digits; }
  bool is_less(const ExactNumber& other) const override { return Decimal(digits) < Decimal(other.text()); }
  std::string digits;
};

}  // namespace

RunTime::RunTime(const Number& time, double rounded, std::string meant_text)
    : exact(time), meant{rounded, time.exact ? std::make_shared<DecimalNumber>(std::move(meant_text)) : nullptr} {}

// All digits of the type, or the decimal if that is shorter and another number.
RunTime::RunTime(const Number& time, std::string_view decimal) : RunTime(time) {
  if (!time.exact) return;
  const std::string text = time.text();
  const bool shorter = decimal.size() < text.size() && Decimal(decimal) != Decimal(text);
  *this = RunTime(time, from_text<double>(decimal), shorter ? std::string(decimal) : text);
}

}  // namespace cradle::tools
