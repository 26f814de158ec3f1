#pragma once
// The event loop in its plainest form, the slow twin of Simulation: no queue, no keys, no rounded ties. Before every
// collision it searches all gaps for the least exact time; ties go left to right. The origin of time may be moved after
// any number of collisions. It makes one collision at a time, which the real loop cannot do.

#include <gtest/gtest.h>

#include "cradle/core/chains/chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle::test {

template <class T> struct Step {
  ParticleIndex particle;  // on the left of the gap
  Pair<T> time;            // in the scene
  T closing_speed;         // before the collision
  T nearest_gap;           // the smaller of the neighbouring gaps
};

template <class Law, class Chain> class SlowLoop {
 public:
  using T = typename Chain::Scalar;

  SlowLoop(Law law, Chain chain, int collisions_per_move = 1)
      : law_(std::move(law)), chain_(std::move(chain)), collisions_per_move_(collisions_per_move) {}

  const Chain& chain() const { return chain_; }

  // The gap that closes next; none if all particles part.
  std::optional<Slot> next() const {
    std::optional<Slot> first;
    for (Slot s = chain_.first(); s <= chain_.last(); ++s)
      if (chain_.queue_due(s) != EventQueue::never && (!first || chain_.due(s) < chain_.due(*first))) first = s;
    return first;
  }

  Step<T> collide(Slot s) {
    const T time = chain_.due(s);
    Step<T> step{chain_.particle(s), chain_.stamp(time), chain_.closing(s), T(0)};
    const CollisionResult<T> collision = chain_.collide(law_, s, time);
    step.nearest_gap = chain_.nearest_gap(s);
    if constexpr (StreamingChain<Chain>)
      if (includes(collision.notice, Notice::needs_slots)) chain_.make_room();
    if (++since_move_ == collisions_per_move_) {
      chain_.move_origin(time);
      since_move_ = 0;
    }
    return step;
  }

 private:
  Law law_;
  Chain chain_;
  int collisions_per_move_, since_move_ = 0;
};

// Of all gaps the chosen one is the first by (exact time, position), whatever the keys of the queue, and collides then.
template <class Run, class T>
Counts expect_each_the_first(Run run, const T& end, std::uint64_t least_collisions,
                             std::uint64_t least_close_calls = 0) {
  const auto& chain = run.chain();
  run.advance(end, [&](const Collision<T>& collision) {
    std::optional<Slot> first;
    for (Slot s = chain.first(); s <= chain.last(); ++s)
      if (chain.right(s) != s && chain.closing(s) > T(0) && (!first || chain.due(s) < chain.due(*first))) first = s;
    ASSERT_TRUE(first.has_value());
    ASSERT_EQ(chain.particle(*first), collision.left) << "collision " << run.counts().collisions;
    ASSERT_EQ(chain.particle(chain.right(*first)), collision.right) << "collision " << run.counts().collisions;
    ASSERT_TRUE(chain.stamp(chain.due(*first)).value() == collision.time.value())
        << "collision " << run.counts().collisions;
  });
  EXPECT_EQ(run.account().order_lost, 0U);
  EXPECT_GE(run.counts().collisions, least_collisions);
  EXPECT_GE(run.counts().close_calls, least_close_calls);
  return run.counts();
}

}  // namespace cradle::test
