// The filtered queue: 64-bit keys made from rounded times, and exact times only if keys are too close. Proves that it
// is equal to a loop that searches all gaps for the least (exact time, position): the same collisions in the same order
// at each particle, at the same times to the last bit, in collapses and in shocks, and under the wet law, where
// particles pass, merge and stream in. In lattices, where many collisions are simultaneous, collisions that commute may
// swap, and rounding decides triple collisions: there every single choice is checked against all gaps that might be
// first. The number of index bits in a key changes no bit of a run.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/slow_loop.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::filtered_queue_test {

template <class P> using FilteredQueue = InPrecision<P>;
using InDoubleToo = Joined<testing::Types<Precision<double>>, WidePrecision>::Types;  // where keys are exact times
TYPED_TEST_SUITE(FilteredQueue, InDoubleToo, PrecisionName);

// ---- the slow twin: it moves its origin of time as the run did (after the same number of collisions, by the same
// offset), since times are rounded as offsets; it uses nothing else of the run

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
  expect_same_state(run, unobserved, seen);
  EXPECT_EQ(run.counts().close_calls, unobserved.counts().close_calls);
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

// Particles at integers with small integer velocities: times are small rationals at first, and many are equal.
template <class T> Scene<T> integers() {
  std::vector<T> x, v;
  for (ParticleIndex i = 0; i < 60; ++i) {
    x.push_back(T(i));
    v.push_back(T(bits_of(i, 7, 3) - 1));
  }
  return list(std::move(x), std::move(v));
}

template <class Chain, class Law, class T>
Simulation<T, Law, Chain> make(const Scene<T>& particles, const Law& law, Policy<T> policy = {}, int queue_bits = 3) {
  return {law, Chain(particles, T(0)), std::move(policy), queue_bits};
}
template <class Chain, class Law, class T>
Counts expect_same_collisions(const Scene<T>& particles, const Law& law, const T& end, Policy<T> policy = {}) {
  const Recorded<T> run = recorded(make<Chain>(particles, law, std::move(policy)), end);
  expect_same_meetings(run.meetings, searched(Chain(particles, T(0)), law, run));
  return run.counts;
}

// Runs with several numbers of index bits in a key. Returns the close calls of the last.
template <class Chain, class Law, class T>
std::uint64_t expect_index_bits_change_no_bit(const Scene<T>& particles, const Law& law, const T& step, int steps) {
  auto run = make<Chain>(particles, law, {}, 3), run13 = make<Chain>(particles, law, {}, 13),
       run20 = make<Chain>(particles, law, {}, 20);
  T t(0);
  for (int k = 0; k < steps; ++k) {
    t += step;
    for (auto* each : {&run, &run13, &run20}) EXPECT_EQ(each->advance(t), Status::reached);
    for (const auto* other : {&run13, &run20}) expect_same_state(run, *other, t);
  }
  return run20.counts().close_calls;
}

TYPED_TEST(FilteredQueue, BouncingParticles) {
  using T = typename TypeParam::Scalar;
  const T most = T(15) / T(16);
  const struct {
    const char* name;
    Scene<T> particles;
    Inelastic<T> law;
    int end;
    std::uint64_t collisions;
  } rows[] = {
      {"mixed velocities", rmix<T>(32), Inelastic<T>(most, T(0)), 1000, 188},
      {"shock", rshock<T>(200), Inelastic<T>(from_text<T>(".9"), from_text<T>("1e-3")), 66, 5000},
      // Of a perfect lattice all pairs of a generation meet at one time, exactly representable.
      {"elastic lattice", lattice_rows<T>(40), Inelastic<T>(T(1), T(0)), 100, 20 * 21 / 2},
      // Mirror symmetry makes pairs of equal times, and triple collisions that rounding decides.
      {"inelastic lattice", lattice_rows<T>(40), Inelastic<T>(most, from_text<T>("1e-3")), 30, 100},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    EXPECT_GE(expect_same_collisions<GapChain<T>>(row.particles, row.law, T(row.end)).collisions, row.collisions);
  }
}

TYPED_TEST(FilteredQueue, WetParticles) {
  using T = typename TypeParam::Scalar;
  const struct {
    Scene<T> particles;
    const char* loss;
    int end;
    std::uint64_t collisions, merges;
  } rows[] = {{rmix<T>(100), ".01", 300, 200, 60},
              {rshock<T>(200), ".01", 250, 2000, 150},
              {rshock<T>(2000), ".05", 500, 1000, 400},
              {unequal_rows<T>(), ".02", 100, 501, 51}};
  for (const auto& row : rows) {
    const Wet<T> law(from_text<T>(row.loss));
    const Counts counts = expect_same_collisions<ClusterChain<T>>(row.particles, law, T(row.end));
    EXPECT_GE(counts.collisions, row.collisions);
    EXPECT_GE(counts.merges, row.merges);
  }
}

TYPED_TEST(FilteredQueue, Collapses) {
  using T = typename TypeParam::Scalar;
  const auto expect_many = [](const Scene<T>& particles, const char* restitution, int end, const char* gap) {
    const Inelastic<T> law(from_text<T>(restitution), T(0));
    const Policy<T> policy = stop_below(from_text<T>(gap));
    EXPECT_GE(expect_same_collisions<GapChain<T>>(particles, law, T(end), policy).collisions, 100U);
  };
  for (const char* restitution : {".05", ".01", ".0625"})
    expect_many(list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}), restitution, 10, "1e-280");
  // At eps = 0.4 seven particles are enough: 2/(1 - (4/pi) atan sqrt eps) = 7.1.
  expect_many(rshock<T>(12), ".4", 100, "1e-200");
}

TYPED_TEST(FilteredQueue, IntegerPlacesAndVelocities) {
  using T = typename TypeParam::Scalar;
  const Inelastic<T> elastic(T(1), T(0)), soft(T(3) / T(4), from_text<T>("1e-3")),
      hard(T(15) / T(16), from_text<T>("1e-3"));
  expect_each_the_first(gap_run(integers<T>(), elastic), T(200), 200, 1);
  expect_each_the_first(gap_run(integers<T>(), soft), T(10), 100, 1);
  expect_each_the_first(gap_run(lattice_rows<T>(40), elastic), T(100), 20 * 21 / 2, 1);
  expect_each_the_first(gap_run(lattice_rows<T>(40), hard), T(30), 100, 1);
}

TYPED_TEST(FilteredQueue, IndexBitsChangeNoBit) {
  using T = typename TypeParam::Scalar;
  using Chain = GapChain<T>;
  const T zero(0), most = T(15) / T(16);
  const Inelastic<T> law(from_text<T>(".9"), from_text<T>("1e-3"));
  expect_index_bits_change_no_bit<Chain>(rshock<T>(200), law, T(14), 5);
  expect_index_bits_change_no_bit<Chain>(rmix<T>(32), Inelastic<T>(most, zero), T(200), 5);
  for (const Scene<T>& particles : {rshock<T>(200), integers<T>()})
    expect_index_bits_change_no_bit<ClusterChain<T>>(particles, Wet<T>(from_text<T>(".01")), T(10), 6);
  // Where times are equal.
  EXPECT_GT(expect_index_bits_change_no_bit<Chain>(lattice_rows<T>(40), Inelastic<T>(most, zero), T(2), 8), 0U);
  EXPECT_GT(expect_index_bits_change_no_bit<Chain>(integers<T>(), Inelastic<T>(T(1), zero), T(2), 20), 0U);
}

}  // namespace cradle::test::filtered_queue_test
