// The filtered queue under the wet law: 64-bit keys made from rounded times, exact times only where keys are too close
// to call. Proves it equal to a loop that looks through all gaps for the least (exact time, position): every body has
// the same contacts with the same others in the same order, at the same times to the last bit, where bodies pass, merge
// and stream in. The number of index bits in a key changes no bit of a run.
//
// The twin moves its origin of time where the run did (after the same number of contacts, by the same offset), since
// times are rounded as offsets; it knows nothing else of the run.
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "cradle/core/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace wet_filtered_queue_test {

using namespace cradle;
using namespace cradle::test;

template <class P> using WetFilteredQueue = InPrecision<P>;
TYPED_TEST_SUITE(WetFilteredQueue, WidePrecision, PrecisionName);

template <class T> using WetRun = Simulation<T, Wet<T>, ClusterChain<T>>;
template <class T> WetRun<T> wet_run(const Scene<T>& bodies, const T& loss, int least_queue_bits = 3) {
  return {Wet<T>(loss), ClusterChain<T>(bodies, T(0)), Policy<T>{}, least_queue_bits};
}

template <class T> struct Meeting {
  BodyIndex other;
  T time;
};
// Of each body, in order.
template <class T> using Meetings = std::map<BodyIndex, std::vector<Meeting<T>>>;
template <class T> void note(Meetings<T>& meetings, BodyIndex left, BodyIndex right, const T& time) {
  meetings[left].push_back({right, time});
  meetings[right].push_back({left, time});
}

template <class T> struct Origin {
  std::uint64_t contacts;  // made before it moved
  T offset;                // to where
};

template <class T> struct Recorded {
  Meetings<T> meetings;
  std::vector<Origin<T>> origins;
  Counts counts;
};

template <class T> Recorded<T> filtered(const Scene<T>& bodies, const T& loss, const T& end) {
  auto run = wet_run(bodies, loss);
  Recorded<T> record;
  T last(0);
  const auto take_origin = [&] {
    if (run.counts().origin_moves > record.origins.size()) record.origins.push_back({run.counts().contacts, last});
  };
  run.advance(end, [&](const Contact<T>& contact) {
    take_origin();
    const auto& chain = run.chain();
    for (Slot s = chain.first(); s <= chain.last(); ++s)
      if (chain.right(s) != s && chain.body(s) == contact.left) last = chain.due(s);
    note(record.meetings, contact.left, contact.right, contact.time.value());
  });
  take_origin();
  record.counts = run.counts();
  EXPECT_EQ(record.origins.size(), run.counts().origin_moves);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
  return record;
}

template <class T> Meetings<T> unfiltered(const Scene<T>& bodies, const T& loss, const Recorded<T>& run) {
  const Wet<T> law(loss);
  ClusterChain<T> chain(bodies, T(0));
  Meetings<T> meetings;
  auto origin = run.origins.begin();
  for (std::uint64_t n = 1; n <= run.counts.contacts; ++n) {
    Slot first = chain.slots();
    T time(0);
    for (Slot s = chain.first(); s <= chain.last(); ++s) {
      if (chain.right(s) == s || !(chain.closing(s) > T(0))) continue;
      const T due = chain.due(s);
      if (first == chain.slots() || due < time) first = s, time = due;
    }
    if (first == chain.slots()) break;
    note(meetings, chain.body(first), chain.body(chain.right(first)), chain.stamp(time).value());
    const Collision<T> collision = chain.collide(law, first, time);
    if (asks(collision.notice, Notice::needs_slots)) chain.make_room();
    if (origin != run.origins.end() && origin->contacts == n) chain.move_origin((origin++)->offset);
  }
  return meetings;
}

template <class T>
void expect_same_contacts(const Scene<T>& bodies, const T& loss, const T& end, std::uint64_t least_contacts,
                          std::uint64_t least_merges) {
  const Recorded<T> run = filtered(bodies, loss, end);
  EXPECT_GE(run.counts.contacts, least_contacts);
  EXPECT_GE(run.counts.merges, least_merges);
  const Meetings<T> twin = unfiltered(bodies, loss, run);
  ASSERT_EQ(run.meetings.size(), twin.size());
  for (const auto& [body, meetings] : run.meetings) {
    const auto& expected = twin.at(body);
    ASSERT_EQ(meetings.size(), expected.size()) << "body " << body;
    for (std::size_t k = 0; k < meetings.size(); ++k) {
      ASSERT_EQ(meetings[k].other, expected[k].other) << "body " << body << ", contact " << k;
      ASSERT_TRUE(meetings[k].time == expected[k].time) << "body " << body << ", time of contact " << k;
    }
  }
}

TYPED_TEST(WetFilteredQueue, MixedVelocities) {
  using T = typename TypeParam::Scalar;
  expect_same_contacts(rmix<T>(100), from_text<T>(".01"), T(300), 200, 60);
}

TYPED_TEST(WetFilteredQueue, Shock) {
  using T = typename TypeParam::Scalar;
  expect_same_contacts(rshock<T>(200), from_text<T>(".01"), T(250), 2000, 150);
}

TYPED_TEST(WetFilteredQueue, SlowShock) {
  using T = typename TypeParam::Scalar;
  expect_same_contacts(rshock<T>(2000), from_text<T>(".05"), T(500), 1000, 400);
}

TYPED_TEST(WetFilteredQueue, IndexBitsChangeNoBit) {
  using T = typename TypeParam::Scalar;
  // Bodies on integers with a few integer velocities: times are small rationals at first, equal ones abound.
  std::vector<T> x, v;
  for (BodyIndex i = 0; i < 60; ++i) {
    x.push_back(T(i));
    v.push_back(T(bits_of(i, 7, 3) - 1));
  }
  for (const Scene<T>& bodies : {rshock<T>(200), list(std::move(x), std::move(v))}) {
    auto run = wet_run(bodies, from_text<T>(".01")), run13 = wet_run(bodies, from_text<T>(".01"), 13),
         run18 = wet_run(bodies, from_text<T>(".01"), 18);
    for (int t = 10; t <= 60; t += 10) {
      for (auto* each : {&run, &run13, &run18}) ASSERT_EQ(each->advance(T(t)), Status::reached);
      for (const auto* other : {&run13, &run18}) {
        EXPECT_TRUE(same_contacts(run.counts(), other->counts())) << t;
        EXPECT_TRUE(run.energy_lost() == other->energy_lost()) << t;
        EXPECT_TRUE(identical(run.configuration(T(t)), other->configuration(T(t)))) << t;
      }
    }
  }
}

}  // namespace wet_filtered_queue_test
