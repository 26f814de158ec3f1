#pragma once
// The ledger of energy: the sum of what contacts have lost.

#include <concepts>

#include "cradle/core/real.hpp"

namespace cradle {

// Compensated where the type has no digits to spare for 1e12 terms.
template <Real T> class Ledger {
 public:
  void add(const T& loss) {
    if constexpr (compensated)
      sum_.add(loss);
    else
      sum_.sum += loss;
  }
  T value() const { return sum_.value(); }

 private:
  static constexpr bool compensated = std::same_as<T, float> || std::same_as<T, double> || std::same_as<T, long double>;
  CompensatedSum<T> sum_;
};

}  // namespace cradle
