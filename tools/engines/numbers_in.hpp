// Numbers, reports and collisions of one scalar type as code for all types has them (number.hpp, reported.hpp).
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "cradle/core/engine/status.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/tools/engines/any_engine.hpp"

namespace cradle::tools {

template <Real T> struct ExactIn final : ExactNumber {
  explicit ExactIn(const T& x) : value(x) {}
  std::string text() const override { return to_text(value); }
  bool is_less(const ExactNumber& other) const override { return value < static_cast<const ExactIn&>(other).value; }
  const T value;
};

template <Real T> double rounded(const T& x) { return x == x ? to_double(x) : none(); }

template <Real T> Number number_of(const T& x) {
  if constexpr (std::same_as<T, double>)
    return {rounded(x), nullptr};
  else
    return {rounded(x), std::make_shared<ExactIn<T>>(x)};
}
template <Real T> std::optional<Number> number_of(const std::optional<T>& x) {
  return x ? std::optional(number_of(*x)) : std::nullopt;
}
template <Real T> T exact_in(const Number& x) {
  if constexpr (std::same_as<T, double>)
    return x.value;
  else
    return static_cast<const ExactIn<T>&>(*x.exact).value;
}

template <Real T> Number rounded_once(std::string_view decimal) { return number_of(from_text<T>(decimal)); }

template <Real T> ReportedIncident reported(const Incident<T>& i) {
  return {number_of(i.time), to_double(i.gap), i.particle};
}
template <Real T> ReportedGuard reported(const GuardReport<T>& r, const T& time) {
  return {r.guard, to_double(r.found), to_double(r.bound), r.particle, number_of(time)};
}

template <Real T> struct CollisionIn final : ObservedCollision {
  explicit CollisionIn(const Collision<T>& c) : of(c) {
    left = c.left, right = c.right;
    time = to_double(T(c.time.value())), interval = rounded(c.interval), closing_speed = rounded(c.closing_speed);
  }
  double time_low() const override { return to_double(difference(of.time, Pair<T>{T(time), T(0)})); }
  Texts texts() const override {
    return {to_text(T(of.time.value())), to_text(of.interval), to_text(of.closing_speed)};
  }
  const Collision<T>& of;
};

}  // namespace cradle::tools
