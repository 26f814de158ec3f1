// The state of a run as a value: saved anywhere and loaded into a run of the same scene, it continues with the same
// bits. Truncated or contradictory states are refused, before memory is allocated for them.
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::state_test {

using Dry = Inelastic<double>;

template <class X> X there_and_back(const X& x) {
  X y{};
  restore(y, x);
  return y;
}

TEST(State, NumbersComeBackAsTheyWere) {
  const double never = std::numeric_limits<double>::infinity();
  for (const double x : {0., -0., 1. / 3, 5e-324, -1e308, never, -never})
    EXPECT_EQ(std::bit_cast<std::uint64_t>(there_and_back(x)), std::bit_cast<std::uint64_t>(x)) << x;
  EXPECT_TRUE(there_and_back(std::numeric_limits<double>::quiet_NaN()) != there_and_back(0.));
  const long double x = 1.L / 3;
  EXPECT_EQ(there_and_back(x), x);
  EXPECT_EQ(there_and_back(1.f / 3), 1.f / 3);
  for (const std::int64_t n : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min(), std::int64_t{1} << 62})
    EXPECT_EQ(there_and_back(n), n);
  EXPECT_EQ(there_and_back(-7), -7);
  EXPECT_TRUE(there_and_back(true));
}

TEST(State, ListsComeBackAsTheyWere) {
  const std::map<int, std::pair<double, double>> map{{-3, {1, 2}}, {4, {3, 4}}};
  EXPECT_EQ(there_and_back(map), map);
  const std::optional<std::vector<double>> there{{1, 2, 3}}, none;
  EXPECT_EQ(there_and_back(there), there);
  EXPECT_EQ(there_and_back(none), none);
  std::unordered_map<std::int64_t, double> one, other;  // the same, filled in another order
  for (std::int64_t k = 0; k < 100; ++k) one[k] = 1, other[99 - k] = 1;
  EXPECT_TRUE(SavedState::of(one) == SavedState::of(other));
}

TEST(State, ListsLongerThanTheFileAreRefusedBeforeTheyAreMade) {
  SavedState state;
  save(state, std::uint64_t{1} << 60);
  std::vector<double> values;
  EXPECT_THROW(load(state, values), std::invalid_argument);
  EXPECT_LT(values.capacity(), 1000U);
}

// A run that is made anew takes the state of one that has advanced, at any of these times.
template <class Make, class... Segments>
void expect_always_taken(const Make& make, double step, int steps, Segments&&... segments) {
  auto run = make();
  for (int k = 1; k <= steps; ++k) {
    run.advance(step * k, segments...);
    auto later = make();
    EXPECT_NO_THROW(restore(later, run)) << run.last_collision_time();
  }
}

// As do runs of all kinds, in engine/same_bits_test.cpp.
TEST(State, OfAGasWithoutEventsIsContinuedWithTheSameBits) {
  expect_same_from_anywhere([] { return StickyGas<double>(uniform_rows(60), 0.); }, 3.7, 40,
                            [](const auto& later, const auto& whole) {
                              EXPECT_EQ(later.energy_lost(), whole.energy_lost());
                              EXPECT_EQ(later.last_collision_time(), whole.last_collision_time());
                            });
}

// After a collision by which cells are laid out anew, fewer than before, nothing points beyond them.
TEST(State, OfCellsLaidOutAnewIsTaken) {
  using Run = Simulation<double, Sticky<double>, ClusterChain<double>>;
  expect_always_taken([] { return Run(Sticky<double>(), ClusterChain<double>(gaussian_ring(60, 60), 0.)); }, 5, 60);
}

// Every byte of a state changed: it is refused, or a run that can continue.
TEST(State, WhatDoesNotFitTogetherIsRefused) {
  using Run = Simulation<double, Wet<double>, ClusterChain<double>>;
  const auto make = [] { return Run(Wet<double>(0.01), ClusterChain<double>(gaussian_ring(12, 20), 0.)); };
  Run run = make();
  run.advance(3);
  const std::string bytes = SavedState::of(run).bytes();
  int refused = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x40);
    SavedState state(changed);
    Run later = make();
    refused += test::message_of([&] { load(state, later); }) != "nothing was refused";
  }
  EXPECT_GT(refused, 200) << "lengths, links, numbers of particles";
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    SavedState state(bytes.substr(0, size));
    Run later = make();
    EXPECT_THROW(load(state, later), std::invalid_argument) << size;
  }
}

// Slots beyond the gaps that are held keep what a time slab of segments has left there.
TEST(State, OfRowsThatWereRunInSegmentsIsTaken) {
  using Run = Simulation<double, Dry, GapChain<double>>;
  Segments<Dry, GapChain<double>> segments(Workers{});
  expect_always_taken([] { return Run(Dry(0.999, 1e-5), GapChain<double>(uniform_rows(4000, 0.05, 1), 0.)); }, 37.3, 30,
                      segments);
}

// A chain with fewer slots than before takes over none that name those it had.
TEST(State, OfRingsThatWereRunInSegmentsIsTaken) {
  using Run = Simulation<double, Sticky<double>, ClusterChain<double>>;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const auto count = static_cast<ParticleIndex>(600 + 37 * seed);
    const auto ring = gaussian_ring(count, static_cast<double>(count), seed);
    Segments<Sticky<double>, ClusterChain<double>> segments(Workers{}, {60, 8, 0, true});
    expect_always_taken([&] { return Run(Sticky<double>(), ClusterChain<double>(ring, 0.)); }, 0.4, 120, segments);
  }
}

// In absolute positions a collision may be due beyond the range of the type.
TEST(State, WithCollisionsThatNeverComeIsTaken) {
  expect_always_taken([] { return position_run(list<double>({0, 1, 3}, {1e-310, 0, -1}), Dry(0.9)); }, 1, 1);
}

}  // namespace cradle::test::state_test
