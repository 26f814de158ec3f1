#pragma once
// Scenes whose end is known exactly: a collapse, and a gas whose velocities are reversed.

#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>

#include "engines.hpp"

namespace precision {

// Inelastic collapse of three and four equal particles in the checkerboard pattern: collapse time and gaps are known
// exactly. In units of the initial gap and closing speed,
//
//   three  x = (0, 1, 3),    v = (1, 0, -1),           eps = 0.05:  t_c = 12/7
//   four   x = (0, 1, 3, 4), v = (3, 1, -1, -3)/2,     eps = 0.15:  t_c = 11/7; the outer gaps close together
//
// Let p be the closing speed of the gap that closes, q and g those of the other kind, and c = 2 if both outer gaps push
// the middle one, else 1. Then  q -> q + c (1 + eps) p/2,  p -> -eps p,  and the next collision comes after g/q.

struct CollapseScene {
  std::string name;
  std::vector<int> positions, velocities_doubled;
  const char* restitution;
  int time_numerator;  // of t_c = numerator/7
  Wide time() const { return Wide(time_numerator) / 7; }
  bool outer_together() const { return positions.size() == 4; }
};

inline std::vector<CollapseScene> collapse_scenes() {
  return {{"three", {0, 1, 3}, {2, 0, -2}, "0.05", 12}, {"four", {0, 1, 3, 4}, {3, 1, -1, -3}, "0.15", 11}};
}

struct CollapseOutcome {
  std::uint64_t collisions = 0;  // made until the collapse time is known (policy stop); `seconds` are for these
  double seconds = 0;
  double extrapolated = 1;             // relative error of the collapse time
  double claimed = 1;                  // the engine's estimate of it
  double summed = 1;                   // of the sum of all intervals that the type resolves
  std::uint64_t collisions_right = 0;  // in the right order and with the gap right to 1e-6
};

inline constexpr std::uint64_t most_collisions = 2000;  // counted at most

template <class Chain> Run<Chain> prepare(const CollapseScene& scene, cradle::Policy<typename Chain::Scalar> policy) {
  using T = typename Chain::Scalar;
  std::vector<T> x, v;
  for (const int position : scene.positions) x.push_back(T(position));
  for (const int doubled : scene.velocities_doubled) v.push_back(T(doubled) / T(2));
  return {cradle::Inelastic<T>(cradle::from_text<T>(scene.restitution), T(0)),
          Chain(std::make_shared<cradle::List<T>>(std::move(x), std::move(v)), T(0)), std::move(policy)};
}

// The exact sequence, one step per half cycle.
class ExactCollapse {
 public:
  explicit ExactCollapse(const CollapseScene& scene)
      : restitution_(scene.restitution), together_(scene.outer_together()) {}

  bool outer() const { return outer_; }  // which kind closes: the outer gaps (with three particles, the left one)
  const Wide& gap() const { return gap_; }
  void step() {
    const Wide flight = gap_ / closing_;
    gap_ = first_ ? Wide(2 - flight) : Wide(-other_ * flight);  // the other gap, which has opened since
    first_ = false;
    const Wide pushed = other_ + (outer_ && together_ ? 2 : 1) * (1 + restitution_) / 2 * closing_;
    other_ = -restitution_ * closing_;
    closing_ = pushed;
    outer_ = !outer_;
  }

 private:
  Wide restitution_, gap_{1}, closing_{1}, other_{1};
  bool together_, outer_ = true, first_ = true;
};

// Follows a collapse as long as the type resolves it. Counts the collisions until one is out of order or its gap has an
// error above 1e-6. The time of the last collision is the sum of all intervals.
template <class Chain> void follow(const CollapseScene& scene, CollapseOutcome& outcome) {
  using T = typename Chain::Scalar;
  std::uint64_t right = 0, seen = 0;
  bool wrong = false;
  cradle::Policy<T> policy;
  policy.interrupt = [&] { return seen >= most_collisions; };
  Run<Chain> run = prepare<Chain>(scene, policy);
  ExactCollapse exact(scene);
  unsigned closed = 0;  // gaps that have closed in this half cycle, as bits
  run.advance(T(2), [&](const cradle::Collision<T>& collision) {
    ++seen;
    const unsigned outer = scene.outer_together() ? 0b101 : 0b001, all = exact.outer() ? outer : 0b010;
    const unsigned own = 1U << collision.left;
    if (wrong || !(own & all & ~closed)) {
      wrong = true;
      return;
    }
    if (closed == 0) {
      const cradle::Slot slot = run.chain().first() + static_cast<cradle::Slot>(collision.left);
      const T gap = run.chain().gap_at(slot, T(run.chain().due(slot) - collision.interval));
      wrong = !(relative_error(widen(gap), exact.gap()) < 1e-6);
    }
    right += !wrong;
    closed |= own;
    if (closed == all) {
      exact.step();
      closed = 0;
    }
  });
  outcome.collisions_right = std::min(right, most_collisions);
  outcome.summed = relative_error(widen(run.last_collision_time()), scene.time());
}

inline CollapseOutcome measure(const Engine& engine, const CollapseScene& scene) {
  return with_chain<CollapseOutcome>(engine, [&]<class Chain>(std::type_identity<Chain>) {
    using T = typename Chain::Scalar;
    CollapseOutcome outcome;
    cradle::Policy<T> stop;
    stop.collapse = cradle::CollapsePolicy::stop;
    outcome.seconds = best_seconds([&] {
      Run<Chain> run = prepare<Chain>(scene, stop);
      run.advance(T(2));
      outcome.collisions = run.counts().collisions;
      if (!run.collapse().settled) return;
      const auto& found = run.collapse();
      outcome.extrapolated = relative_error(widen(found.time.high) + widen(found.time.low), scene.time());
      outcome.claimed = relative_error(scene.time() + widen(found.uncertainty), scene.time());
    });
    follow<Chain>(scene, outcome);
    return outcome;
  });
}

// Time reversal of an elastic gas, 64 particles with alternating masses 1 and 3: run to t = 320, reverse all
// velocities, run for the same time again. In exact arithmetic every particle returns to its initial position. Unequal
// masses make the gas unstable, so the deviation is rounding error, amplified by the collisions.

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
