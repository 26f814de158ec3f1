#pragma once
// The ledger of energy: the sum of the losses in collisions. In the native types the sum does not depend on the order
// of its terms, since collisions that commute are made in different orders (segments.hpp). Each term is rounded to a
// grid on which sums of up to four times the energy E are exact; the rest of the term is rounded to a finer grid, of E
// eps / 2^22 or less, and summed as an integer, which does not overflow in 1e12 terms. The error of a term is at most
// half of the finer grid.
//
// In wider types this sum is expensive, and a plain sum is precise enough: chains keep one sum for each gap
// (timed_gaps.hpp).

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/base/real.hpp"

namespace cradle {

template <Real T> class Ledger {
 public:
  static constexpr bool in_any_order =
      std::same_as<T, float> || std::same_as<T, double> || std::same_as<T, long double>;

  // `energy`: the largest possible loss (Particles::energy_to_lose).
  explicit Ledger(const T& energy = T(1)) {
    if constexpr (in_any_order) {
      T above(1);
      const T least = std::numeric_limits<T>::min() / std::numeric_limits<T>::epsilon() * T(1 << 30);
      while (above <= energy && is_finite(above)) above += above;
      while (above > least && above > energy + energy) above /= T(2);
      if (!is_finite(T(T(8) * above))) return;  // a plain sum
      rounder_ = T(3) * above;
      fine_ = above * std::numeric_limits<T>::epsilon() / T(1 << 22);
      per_fine_ = T(1) / fine_;
    }
  }

  [[gnu::always_inline]] void add(const T& loss) {
    if constexpr (in_any_order) {
      const T coarse = (loss + rounder_) - rounder_;
      sum_ += coarse;
      add_rest(std::llrint((loss - coarse) * per_fine_));  // compiles to one instruction
    } else {
      sum_ += loss;
    }
  }
  // Adds another ledger of the same energy.
  void add(const Ledger& other) { add_sums(other.sum_, other.rest_); }
  // The grid, for callers that add many terms at once: coarse parts, and the rests in units of the fine grid.
  const T& rounder() const { return rounder_; }
  const T& per_fine() const { return per_fine_; }
  void add_sums(const T& coarse, std::int64_t rest) {
    sum_ += coarse;
    add_rest(rest);
  }
  void clear() {
    sum_ = T(0);
    rest_ = 0;
  }

  T value() const {
    if constexpr (in_any_order)
      return sum_ + static_cast<T>(rest_) * fine_;
    else
      return sum_;
  }
  static auto state(auto& self) { return fields(self.sum_, self.rest_); }

 private:
  // Wraps around if the losses are far more than the energy, which a state from a damaged file may cause.
  [[gnu::always_inline]] void add_rest(std::int64_t more) {
    rest_ = static_cast<std::int64_t>(static_cast<std::uint64_t>(rest_) + static_cast<std::uint64_t>(more));
  }

  T rounder_{0};             // adding and then subtracting it rounds a number to the grid
  T fine_{1}, per_fine_{1};  // the grid of the rest
  T sum_{0};
  std::int64_t rest_ = 0;  // in units of fine_
};

}  // namespace cradle
