#pragma once
// The ledger of energy: the sum of what contacts have lost. In the native types it is the same whatever the order of
// its terms, for contacts that commute are not always made in one order (segments.hpp): it is kept in a fixed-point
// number of 118 bits, of which the first stands for all the energy that there is, so that 1e12 terms together are cut
// off by less than a double resolves. Wider types have digits to spare for a plain sum, and no cheap fixed-point
// number: chains keep one sum for each gap (timed_gaps.hpp).

#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "cradle/core/real.hpp"

namespace cradle {

template <Real T> class Ledger {
 public:
  static constexpr bool in_any_order =
      std::same_as<T, float> || std::same_as<T, double> || std::same_as<T, long double>;

  // `energy`: that there is; no more can be lost.
  explicit Ledger(const T& energy = T(1)) {
    if constexpr (in_any_order) {
      const T two_to_60(static_cast<T>(std::int64_t{1} << 60)), least = std::numeric_limits<T>::min() * two_to_60;
      while (energy > unit_ * two_to_60) unit_ += unit_;
      while (unit_ > least && energy < unit_ * two_to_60 / T(2)) unit_ /= T(2);
      scale_ = T(1) / unit_;  // of an infinite energy 0
    }
  }

  [[gnu::always_inline]] void add(const T& loss) {
    if constexpr (in_any_order) {
      const T scaled = loss * scale_;
      const auto whole = static_cast<std::int64_t>(scaled);
      const auto rest = static_cast<std::int64_t>((scaled - static_cast<T>(whole)) * static_cast<T>(one));
      sum_ += static_cast<Wide>(whole) * one + rest;
    } else {
      sum_ += loss;
    }
  }
  // What another one of the same energy has taken in.
  void add(const Ledger& other) { sum_ += other.sum_; }
  void clear() { sum_ = decltype(sum_)(0); }

  T value() const {
    if constexpr (in_any_order)
      return static_cast<T>(sum_) * (unit_ / static_cast<T>(one));
    else
      return sum_;
  }

 private:
  __extension__ using Wide = __int128;
  static constexpr std::int64_t one = std::int64_t{1} << 56;

  T unit_{1}, scale_{1};
  std::conditional_t<in_any_order, Wide, T> sum_{0};
};

}  // namespace cradle
