#pragma once
// Time reversal of an elastic gas, 64 particles with alternating masses 1 and 3: run to t = 320, reverse all
// velocities, run for the same time again. In exact arithmetic every particle returns to its initial position. Unequal
// masses make the gas unstable, so the deviation is rounding error, amplified by the collisions.

#include <algorithm>
#include <memory>
#include <type_traits>

#include "engines.hpp"

namespace precision {

struct ReversalOutcome {
  std::uint64_t collisions = 0;  // forwards and back
  double seconds = 0;
  double error = 1;  // root mean square distance from the initial positions, in mean spacings; at most 1
};

inline constexpr int reversal_particles = 64, reversal_time = 320;

inline ReversalOutcome reverse(const Engine& engine) {
  return with_chain<ReversalOutcome, cradle::IndividualMasses>(engine, []<class Chain>(std::type_identity<Chain>) {
    using T = typename Chain::Scalar;
    const T elastic(1), time(reversal_time);
    std::vector<T> x, v, m;
    for (int i = 0; i < reversal_particles; ++i) {
      const std::uint64_t bits = bench::hash(static_cast<std::uint64_t>(i));
      x.push_back(T(i) + T(static_cast<std::int64_t>(bits & 0x3FF)) / T(2048));
      v.push_back(T(static_cast<std::int64_t>((bits >> 20) & 0x3FFF) - 8192) / T(8192));
      m.push_back(T(i % 2 ? 3 : 1));
    }
    ReversalOutcome outcome;
    std::vector<T> back;
    outcome.seconds = best_seconds([&] {
      const cradle::Inelastic<T> law(elastic, T(0));
      Run<Chain> forward(law, Chain(std::make_shared<cradle::List<T>>(x, v, m), T(0)));
      forward.advance(time);
      auto turned = forward.chain().configuration(forward.chain().local_time(time));
      for (T& velocity : turned.v) velocity = -velocity;
      Run<Chain> backward(law, Chain(std::make_shared<cradle::List<T>>(turned.x, turned.v, turned.m), T(0)));
      backward.advance(time);
      back = backward.chain().configuration(backward.chain().local_time(time)).x;
      outcome.collisions = forward.counts().collisions + backward.counts().collisions;
    });
    if (back.size() != x.size()) return outcome;
    Wide squares = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Wide way = widen(back[i]) - widen(x[i]);
      squares += way * way;
    }
    outcome.error = std::min(static_cast<double>(Wide(sqrt(Wide(squares / reversal_particles)))), 1.0);
    return outcome;
  });
}

}  // namespace precision
