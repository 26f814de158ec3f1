// Numbers of an engine for code that is the same for all scalar types: the nearest double, and what the type holds
// beyond that.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "cradle/precision/text.hpp"
#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {

inline double none() { return std::numeric_limits<double>::quiet_NaN(); }

/// A number of a type wider than double, or a decimal.
struct ExactNumber {
  virtual ~ExactNumber() = default;
  virtual std::string text() const = 0;  // all digits
  /// The other number has the same type.
  virtual bool is_less(const ExactNumber& other) const = 0;
};

struct Number {
  double value = 0;                                    // NaN has one form
  std::shared_ptr<const ExactNumber> exact = nullptr;  // null if that is all

  std::string text() const { return exact ? exact->text() : to_text(value); }
  /// Of numbers of one engine.
  friend bool operator<(const Number& a, const Number& b) {
    return a.value != b.value ? a.value < b.value : a.exact && a.exact->is_less(*b.exact);
  }
};

struct DecimalNumber final : ExactNumber {
  explicit DecimalNumber(std::string decimal) : digits(std::move(decimal)) {}
  std::string text() const override { return digits; }
  bool is_less(const ExactNumber& other) const override { return Decimal(digits) < Decimal(other.text()); }
  const std::string digits;
};

/// A time of a run: in the type of its engine, and what it means, which for a time that the scene gives is a decimal,
/// rounded once to a double.
struct RunTime {
  Number exact, meant;

  RunTime(const Number& time) : exact(time), meant(time) {}
  RunTime(const Number& time, double rounded, std::string meant_text)
      : exact(time), meant{rounded, time.exact ? std::make_shared<DecimalNumber>(std::move(meant_text)) : nullptr} {}
  /// All digits of the type, or the decimal if that is shorter and another number.
  RunTime(const Number& time, std::string_view decimal) : RunTime(time) {
    if (!time.exact) return;
    const std::string text = time.text();
    const bool shorter = decimal.size() < text.size() && Decimal(decimal) != Decimal(text);
    *this = RunTime(time, from_text<double>(decimal), shorter ? std::string(decimal) : text);
  }
};

}  // namespace cradle::tools
