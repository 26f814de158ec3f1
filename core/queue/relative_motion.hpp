#pragma once
// The kinetic energy of all particles as P^2/2M, P the momentum, plus the energy of their relative motion:
//
//   E = P^2/2M + 1/2 sum m_i x_i^2 - (sum m_i x_i)^2/2M,   x_i = u_i - c,
//
// for any speed c. Chains in closing speeds have no u_i: there x_i is a sum of closing speeds from one particle on, and
// these sums stay small. If c is the mean velocity no term cancels another, however slow the particles are: the third
// term is rounding. So c is corrected by the mean of the x_i until the third term is below 2^-40 of the second: one
// pass over the particles is enough if c is known well, else three.
//
// Error, u = eps/2, in the native types (CompensatedSum), relative to the energy of the exact closing speeds: each x_i
// has the error u |x_i| and, from the sum, N u^2 sum |w|; its square times m 4u more, the sum of squares 2u, and the
// third term 2^-20 N u. With sum |w| <= sqrt(8 N^2 E/m) that is 8u in all for N up to 1e7: 1e-15 of E in double. Wider
// types use plain sums, with errors of N u. The result is never negative.

#include <type_traits>

#include "cradle/core/base/real.hpp"
#include "cradle/core/queue/ledger.hpp"

namespace cradle {

template <Real T> struct PlainSum {
  T sum{0};
  void add(const T& term) { sum += term; }
  T value() const { return sum; }
};
// As in the ledger: native types need compensated sums.
template <Real T> using EnergySum = std::conditional_t<Ledger<T>::in_any_order, CompensatedSum<T>, PlainSum<T>>;

// A sum of closing speeds minus the speed c.
template <Real T> T less(const CompensatedSum<T>& slowing, const T& c) { return (slowing.sum - c) + slowing.errors; }
template <Real T> T less(const PlainSum<T>& slowing, const T& c) { return slowing.sum - c; }

template <Real T> struct RelativeMotion {
  T energy{0};  // of the motion relative to the centre of mass
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
    c = passes == 1 ? T(0) : next;  // particles without relative motion: x = 0
  }
}

}  // namespace cradle
