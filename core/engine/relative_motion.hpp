#pragma once
// The kinetic energy of all particles as P^2/2M, P the momentum, plus the energy of their motion against each other:
//
//   E = P^2/2M + 1/2 sum m_i x_i^2 - (sum m_i x_i)^2/2M,   x_i = u_i - c,
//
// for any speed c. Chains in closing speeds have no u_i: there x_i is a sum of closing speeds from one particle on,
// which stay small together. With c the mean velocity no term cancels another, however little the particles move: the
// third term is rounding. So c is corrected by the mean of what it leaves until the third term is below 2^-40 of the
// second: that takes one pass over the particles where c is known well beforehand, three where it is not.
//
// Error, u = eps/2, in the types with no digits to spare (CompensatedSum), of the energy that the closing speeds held
// stand for: each x_i is off by u |x_i| and, from the sum, by N u^2 sum |w|; its square times m by 4u more, the sum of
// squares by 2u, and the third term by 2^-20 N u. With sum |w| <= sqrt(8 N^2 E/m) that is 8u in all for N up to 1e7:
// 1e-15 of E in double. Wider types sum plainly, to N u. The result is never negative.

#include <type_traits>

#include "cradle/core/engine/ledger.hpp"
#include "cradle/core/real.hpp"

namespace cradle {

template <Real T> struct PlainSum {
  T sum{0};
  void add(const T& term) { sum += term; }
  T value() const { return sum; }
};
// As the ledger has it: native types have no digits to spare.
template <Real T> using EnergySum = std::conditional_t<Ledger<T>::in_any_order, CompensatedSum<T>, PlainSum<T>>;

// A sum of closing speeds less the speed c.
template <Real T> T less(const CompensatedSum<T>& slowing, const T& c) { return (slowing.sum - c) + slowing.errors; }
template <Real T> T less(const PlainSum<T>& slowing, const T& c) { return slowing.sum - c; }

template <Real T> struct RelativeMotion {
  T energy{0};  // of the motion against the centre of mass
  T mean{0};    // the centre's own x, with c = 0
};

// `pass(c, add)` calls add(m, x) for every particle, or for several of one velocity with all of their mass; c: a guess.
template <Real T, class Pass> RelativeMotion<T> relative_motion(const T& mass, T c, const Pass& pass) {
  for (int passes = 1;; ++passes) {
    EnergySum<T> twice;
    T momentum(0);
    pass(c, [&](const T& m, const T& x) {
      const T p = m * x;
      momentum += p;
      twice.add(p * x);
    });
    const T mean = momentum / mass, missing = momentum * mean, next = c + mean;
    if (!(twice.value() < missing * T(std::int64_t{1} << 40)) || passes == 4) {
      const T rest = twice.value() - missing;
      return {is_negative(rest) ? T(0) : T(rest / T(2)), next};
    }
    c = passes == 1 ? T(0) : next;  // particles that do not move against each other at all: x = 0
  }
}

}  // namespace cradle
