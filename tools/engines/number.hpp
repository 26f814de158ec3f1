// Numbers of an engine for code that is the same for all scalar types: the nearest double, and what the type holds
// beyond that.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "cradle/precision/text.hpp"
#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {

inline double none() { return std::numeric_limits<double>::quiet_NaN(); }

/// A number of a type wider than double, or a decimal.
class ExactNumber {
 public:
  virtual ~ExactNumber() = default;
  virtual std::string text() const = 0;  // all digits
  /// The other number has the same type.
  virtual bool is_less(const ExactNumber& other) const = 0;
};

struct Number {
  double value = 0;                          // NaN has one form
  std::shared_ptr<const ExactNumber> exact;  // null if that is all

  std::string text() const { return exact ? exact->text() : to_text(value); }
  /// Of numbers of one engine.
  friend bool operator<(const Number& a, const Number& b) {
    return a.value != b.value ? a.value < b.value : a.exact && a.exact->is_less(*b.exact);
  }
};

/// A time of a run: in the type of its engine, and what it means, which for a time that the scene gives is a decimal,
/// rounded once to a double.
struct RunTime {
  Number exact, meant;

  RunTime(const Number& time) : exact(time), meant(time) {}
  RunTime(const Number& time, std::string_view decimal);
  RunTime(const Number& time, double rounded, std::string meant_text);
};

}  // namespace cradle::tools
