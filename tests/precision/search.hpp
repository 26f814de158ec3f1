#pragma once
// A slow twin of the filtered queue: a loop that searches all gaps for the least (exact time, position). It moves its
// origin of time as the run did (after the same number of collisions, by the same offset), since times are rounded as
// offsets; it uses nothing else of the run.

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test {

template <class T> struct Meeting {
  ParticleIndex other;
  T time;
};
// For each particle its collisions, in order.
template <class T> using Meetings = std::map<ParticleIndex, std::vector<Meeting<T>>>;

template <class T> void note(Meetings<T>& meetings, ParticleIndex left, ParticleIndex right, const T& time) {
  meetings[left].push_back({right, time});
  meetings[right].push_back({left, time});
}

template <class T> struct Origin {
  std::uint64_t collisions;  // made before the move
  T offset;                  // the new origin
};

template <class T> struct Recorded {
  Meetings<T> meetings;
  std::vector<Origin<T>> origins;
  Counts counts;
};

// Records a run with and without an observer: observed runs take another path through the loop, and must be the same.
template <class Run, class T> Recorded<T> recorded(Run run, const T& end) {
  Run unobserved = run;
  const Status status = unobserved.advance(end);
  Recorded<T> record;
  T last(0);
  const auto take_origin = [&] {
    if (run.counts().origin_moves > record.origins.size()) record.origins.push_back({run.counts().collisions, last});
  };
  EXPECT_EQ(status, run.advance(end, [&](const Collision<T>& collision) {
    take_origin();
    const auto& chain = run.chain();
    for (Slot s = chain.first(); s <= chain.last(); ++s)
      if (chain.right(s) != s && chain.particle(s) == collision.left) last = chain.due(s);
    note(record.meetings, collision.left, collision.right, collision.time.value());
  }));
  take_origin();
  record.counts = run.counts();
  EXPECT_EQ(record.origins.size(), run.counts().origin_moves);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
  const T seen = status == Status::reached ? end : run.last_collision_time();
  EXPECT_TRUE(same_collisions(run.counts(), unobserved.counts()));
  EXPECT_EQ(run.counts().close_calls, unobserved.counts().close_calls);
  EXPECT_TRUE(run.energy_lost() == unobserved.energy_lost());
  EXPECT_TRUE(identical(run.configuration(seen), unobserved.configuration(seen)));
  return record;
}

template <class Chain, class Law, class T> Meetings<T> searched(Chain chain, const Law& law, const Recorded<T>& run) {
  Meetings<T> meetings;
  auto origin = run.origins.begin();
  for (std::uint64_t n = 1; n <= run.counts.collisions; ++n) {
    Slot first = chain.slots();
    T time(0);
    for (Slot s = chain.first(); s <= chain.last(); ++s) {
      if (chain.right(s) == s || !(chain.closing(s) > T(0))) continue;
      const T due = chain.due(s);
      if (first == chain.slots() || due < time) first = s, time = due;
    }
    if (first == chain.slots()) break;
    note(meetings, chain.particle(first), chain.particle(chain.right(first)), chain.stamp(time).value());
    const CollisionResult<T> collision = chain.collide(law, first, time);
    if (includes(collision.notice, Notice::needs_slots)) chain.make_room();
    if (origin != run.origins.end() && origin->collisions == n) chain.move_origin((origin++)->offset);
  }
  return meetings;
}

// Every particle has the same collisions with the same partners in the same order, at the same times to the last bit.
template <class T> void expect_same_meetings(const Meetings<T>& found, const Meetings<T>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [particle, meetings] : found) {
    const auto& others = expected.at(particle);
    ASSERT_EQ(meetings.size(), others.size()) << "particle " << particle;
    for (std::size_t k = 0; k < meetings.size(); ++k) {
      ASSERT_EQ(meetings[k].other, others[k].other) << "particle " << particle << ", collision " << k;
      ASSERT_TRUE(meetings[k].time == others[k].time) << "particle " << particle << ", time of collision " << k;
    }
  }
}

// Tests runs from `make` with several numbers of index bits in a key. Returns the close calls of the last.
template <class Make, class T>
std::uint64_t expect_index_bits_change_no_bit(const Make& make, const T& step, int steps) {
  auto run = make(3), run13 = make(13), run20 = make(20);
  T t(0);
  for (int k = 0; k < steps; ++k) {
    t += step;
    for (auto* each : {&run, &run13, &run20}) EXPECT_EQ(each->advance(t), Status::reached);
    for (const auto* other : {&run13, &run20}) {
      EXPECT_TRUE(same_collisions(run.counts(), other->counts())) << to_double(t);
      EXPECT_TRUE(run.energy_lost() == other->energy_lost()) << to_double(t);
      EXPECT_TRUE(identical(run.configuration(t), other->configuration(t))) << to_double(t);
    }
  }
  return run20.counts().close_calls;
}

// Particles at integers with small integer velocities: times are small rationals at first, and many are equal.
template <class T> Scene<T> integers() {
  std::vector<T> x, v;
  for (ParticleIndex i = 0; i < 60; ++i) {
    x.push_back(T(i));
    v.push_back(T(bits_of(i, 7, 3) - 1));
  }
  return list(std::move(x), std::move(v));
}

}  // namespace cradle::test
