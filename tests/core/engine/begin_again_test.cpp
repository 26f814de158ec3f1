// A run that begins again with other particles is the run of these particles, in every chain: its state has the same
// bytes, whatever the run before has left.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/initial/gas.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/tests/core/between_walls.hpp"

namespace cradle::test::begin_again_test {

using Start = Scene<double>;

Start ring(ParticleIndex count, std::uint64_t replica) {
  return gaussian_ring(count, static_cast<double>(count), 1, 0.2, replica);
}
Start rows(ParticleIndex count, std::uint64_t replica) {
  return displaced_rows(count, uniform_displacement(0.2, 1, replica));
}
// Above a floor, or between two walls.
Start walled(ParticleIndex count, std::uint64_t replica, double acceleration) {
  const auto length = static_cast<double>(count);
  const Start gas = std::make_shared<cradle::Gas<double>>(count, 0., length, 1., gaussian_velocity(2, replica),
                                                          uniform_displacement(0.2, 2, replica));
  return between(acceleration, gas, Wall<double>{.position = 0, .restitution = 0.9, .rest_speed = 0.05},
                 Wall<double>{length});
}

template <class Chain, class Law>
void expect_as_new(const Law& law, const Start& before, const Start& after, double until,
                   const Policy<double>& policy = {}) {
  Simulation again(law, Chain(before, 0.), policy), anew(law, Chain(after, 0.), policy);
  again.advance(until);
  again.begin_again(after);
  for (const double time : {until / 3, until}) {
    EXPECT_EQ(again.advance(time), anew.advance(time));
    EXPECT_EQ(SavedState::of(again).bytes(), SavedState::of(anew).bytes());
    EXPECT_EQ(again.counts().close_calls, anew.counts().close_calls);
    EXPECT_EQ(again.kinetic_energy(time), anew.kinetic_energy(time));
  }
  EXPECT_GT(anew.counts().collisions, 4U);
}

TEST(BeginAgain, IsANewRunInGaps) {
  const Inelastic<double> law(0.9, 1e-2);
  for (const ParticleIndex count : {3, 10, 600}) {
    expect_as_new<GapChain<double>>(law, ring(count, 0), ring(count, 1), 10);
    expect_as_new<GapChain<double>>(law, ring(600, 0), ring(count, 1), 10);
    expect_as_new<GapChain<double>>(law, ring(3, 0), ring(count, 1), 10);
  }
  expect_as_new<GapChain<double>>(law, rows(100, 0), rows(100, 1), 50);  // more slots than at the start
  expect_as_new<GapChain<double>>(law, walled(8, 0, 0), walled(8, 1, 0), 30);
  expect_as_new<GapChain<double>>(law, walled(4, 0, -1), walled(4, 1, -1), 4);
  expect_as_new<GapChain<double, IndividualMasses<double>>>(law, rows(100, 0), rows(100, 1), 50);
  expect_as_new<GapChain<double, WatchedMasses<double>>>(law, walled(4, 0, -1), walled(4, 1, -1), 4);
  expect_as_new<GapChain<double, IndividualMasses<double>>>(ContactTime<double>(law, 0.01), ring(10, 0), ring(10, 1),
                                                            20);
}

TEST(BeginAgain, ForgetsACollapse) {
  const Policy<double> stop{CollapsePolicy::stop};
  expect_as_new<GapChain<double>>(Inelastic<double>(0.05), rows(6, 0), rows(6, 2), 8, stop);
  expect_as_new<PositionChain<double>>(Inelastic<double>(0.05), rows(6, 0), rows(6, 2), 8, stop);
}

TEST(BeginAgain, IsANewRunInOtherChains) {
  expect_as_new<PositionChain<double>>(Inelastic<double>(0.9, 1e-2), rows(100, 0), rows(100, 1), 50);
  expect_as_new<ClusterChain<double>>(Wet<double>(0.05), rows(100, 0), rows(100, 1), 90);
  expect_as_new<ClusterChain<double>>(Wet<double>(0.05), ring(100, 0), ring(100, 1), 20);
}

// Segments may be kept: how they are made does not show.
TEST(BeginAgain, WithTheSegmentsOfTheRunBefore) {
  const Inelastic<double> law(0.9, 1e-2);
  using Chain = GapChain<double>;
  Segments<Inelastic<double>, Chain> segments({}, {.gaps = 100, .anywhere = true});
  for (const auto& [before, after] : {std::pair{ring(1000, 0), ring(1000, 1)}, {rows(3000, 0), rows(3000, 1)}}) {
    Simulation again(law, Chain(before, 0.)), anew(law, Chain(after, 0.));
    again.advance(30., segments);
    again.begin_again(after);
    again.advance(30., segments), anew.advance(30.);
    EXPECT_EQ(SavedState::of(again).bytes(), SavedState::of(anew).bytes());
  }
  EXPECT_GT(segments.statistics().slabs, 4U);
}

}  // namespace cradle::test::begin_again_test
