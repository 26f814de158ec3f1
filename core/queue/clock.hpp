#pragma once
// Time as origin and offset (README.md, Time). The origin is stored as an unevaluated sum, with a relative error of the
// square of the type's precision. All times are in units of the scene.

#include "cradle/core/base/real.hpp"
#include "cradle/core/base/state.hpp"

namespace cradle {

template <Real T> class Clock {
 public:
  explicit Clock(const T& start) : start_(start), origin_{start, T(0)} {}

  const T& start() const { return start_; }

  // Offset of the given time from the origin.
  T offset(const T& time) const { return (time - origin_.high) - origin_.low; }

  // Time at an offset, and time since the start.
  Pair<T> stamp(const T& offset) const { return origin_ + offset; }
  T time(const T& offset) const { return stamp(offset).value(); }
  T elapsed(const T& offset) const { return difference(stamp(offset), Pair<T>{start_, T(0)}); }
  Pair<T> since_start(const T& offset) const { return start_ == T(0) ? stamp(offset) : stamp(offset) - start_; }

  void move_origin(const T& by) { origin_ = origin_ + by; }
  static auto state(auto& self) { return fields(self.origin_); }
  void loaded() const { require_state(is_finite(origin_.high) && is_finite(origin_.low), "times"); }

 private:
  T start_;
  Pair<T> origin_;
};

}  // namespace cradle
