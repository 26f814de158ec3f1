// The sticky gas without events against the event-driven one and against the plainest form of the same solution.
// Proves: equal masses, positions, velocities, energies and merges in 1000 random cases on the line and 1000 on a ring,
// exactly in rational arithmetic and to rounding in double, ties and merges of everything at one time among them; rows
// taken in as they are hit. (The cluster between rows: theory/sticky_shock_test.cpp.)
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test::sticky_gas_test {

// Up to 24 particles at multiples of 1/8 with few different velocities: particles meet three and more at a time. Every
// tenth case has all of them meet in one point at t = 1.
template <class T> std::shared_ptr<const List<T>> random_particles(std::mt19937& random, int repeat, bool ring) {
  const int n = 1 + static_cast<int>(random() % 24);
  std::vector<T> x, v, m;
  int place = 0;
  for (int b = 0; b < n; ++b) {
    place += 1 + static_cast<int>(random() % 12);
    x.push_back(T(place) / T(8));
    v.push_back(repeat % 10 == 0 ? T(T(3) - x.back()) : T(static_cast<int>(random() % 17) - 8) / T(4));
    m.push_back(T(1 + static_cast<int>(random() % 7)));
  }
  const T circumference = ring ? T(place + static_cast<int>(random() % 12)) / T(8) : T(0);
  return std::make_shared<List<T>>(std::move(x), std::move(v), std::move(m), circumference);
}

// Errors in units of rounding: positions and velocities come from sums of at most 24 terms of size below 100.
template <class T> void expect_equal(const Configuration<T>& a, const Configuration<T>& b, double tolerance) {
  ASSERT_EQ(a.x.size(), b.x.size());
  for (std::size_t j = 0; j < a.x.size(); ++j) {
    EXPECT_EQ(a.m[j], b.m[j]);
    EXPECT_LE(std::abs(to_double(T(a.x[j] - b.x[j]))), tolerance);
    EXPECT_LE(std::abs(to_double(T(a.v[j] - b.v[j]))), tolerance);
  }
}

template <class T> void event_driven_is_the_solution(bool ring, double tolerance) {
  std::mt19937 random(9);
  for (int repeat = 0; repeat < 1000; ++repeat) {
    SCOPED_TRACE(testing::Message() << "case " << repeat);
    const auto particles = random_particles<T>(random, repeat, ring);
    StickyGas<T> gas(particles, T(0));
    Simulation run(Sticky<T>{}, ClusterChain<T>(particles, T(0)));
    // In double no particle may be within rounding of another at the time of looking: an odd time.
    for (const T& t : {T(1) / T(4), T(1), T(5) / T(2), T(20)}) {
      const T time = tolerance > 0 ? T(t + T(1) / T(1024)) : t;
      ASSERT_EQ(run.advance(time), Status::reached);
      ASSERT_EQ(gas.advance(time), Status::reached);
      ASSERT_EQ(gas.counts().merges, run.counts().merges);
      EXPECT_EQ(gas.counts().collisions, run.counts().collisions);
      EXPECT_LE(std::abs(to_double(T(gas.energy_lost() - run.energy_lost()))), tolerance);
      const auto of_gas = gas.configuration(time), of_run = run.chain().configuration(run.chain().local_time(time));
      expect_equal(of_gas, of_run, tolerance);
      const T direct = kinetic_energy(of_gas, *particles);
      EXPECT_LE(std::abs(to_double(T(direct + gas.energy_lost() - particles->kinetic_energy()))), tolerance);
    }
  }
}

TEST(StickyGas, IsTheEventDrivenGasInRationalArithmetic) { event_driven_is_the_solution<Rational>(false, 0); }
TEST(StickyGas, IsTheEventDrivenGasInDouble) { event_driven_is_the_solution<double>(false, 1e-11); }
TEST(StickyGas, IsTheEventDrivenGasOnARingInRationalArithmetic) { event_driven_is_the_solution<Rational>(true, 0); }
TEST(StickyGas, IsTheEventDrivenGasOnARingInDouble) { event_driven_is_the_solution<double>(true, 1e-11); }

// Weighted isotonic regression in its plainest form: particle j lies at the largest, over all that begin at or left of
// it, of the smallest, over all that end at or right of it, average of free flights.
TEST(StickyGas, IsTheIsotonicRegressionOfFreeFlights) {
  std::mt19937 random(10);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const auto particles = random_particles<Rational>(random, repeat, false);
    const Rational t = Rational(repeat % 7 + 1) / 3;
    StickyGas<Rational> gas(particles, Rational(0));
    gas.advance(t);
    const auto c = gas.configuration(t);
    std::vector<Rational> places;  // of every particle
    for (ParticleIndex j = 0; j < particles->count(); ++j) {
      std::optional<Rational> largest;
      for (ParticleIndex from = 0; from <= j; ++from) {
        std::optional<Rational> smallest;
        Rational mass = 0, moment = 0;
        for (ParticleIndex b = from; b < particles->count(); ++b) {
          mass += particles->mass(b);
          moment += particles->mass(b) * (particles->position(b) + particles->velocity(b) * t);
          const Rational average = moment / mass;
          if (b >= j && (!smallest || average < *smallest)) smallest = average;
        }
        if (!largest || *smallest > *largest) largest = smallest;
      }
      places.push_back(*largest);
    }
    places.erase(std::unique(places.begin(), places.end()), places.end());
    // The configuration leaves out free particles beyond the next ones.
    const auto first = std::find(places.begin(), places.end(), c.x.front());
    ASSERT_NE(first, places.end());
    EXPECT_TRUE(std::equal(c.x.begin(), c.x.end(), first)) << repeat;
  }
}

TEST(StickyGas, TakesInOnlyWhatIsHit) {
  int calls = 0;
  const auto counted = [&](ParticleIndex particle) { return ++calls, rshock_displacement(particle); };
  const auto rows = std::make_shared<Rows<double>>(symmetric_rows<double>(20'000'000, 0.5, 1.0, counted));
  StickyGas<double> gas(rows, 0.0);
  for (const double t : {10.0, 49.9, 50.1}) gas.advance(t);
  EXPECT_LE(calls, 56);
  Simulation run(Sticky<double>{}, ClusterChain<double>(rows, 0.0));
  run.advance(50.1);
  EXPECT_EQ(gas.counts().merges, run.counts().merges);
  expect_equal(gas.configuration(50.1), run.chain().configuration(run.chain().local_time(50.1)), 1e-12);
  EXPECT_NEAR(gas.front_left(50.1), run.chain().front_left(run.chain().local_time(50.1)), 1e-12);
  EXPECT_EQ(gas.collided_particles(), run.chain().collided_particles());
}

// Interrupted again and again while rows are taken in, it ends in the bits of a gas that was left alone.
TEST(StickyGas, InterruptedItContinuesToTheSameBits) {
  const auto rows = rshock<double>(400'000);
  Policy<double> policy;
  int calls = 0;
  policy.interrupt = [&] { return ++calls % 3 != 0; };
  StickyGas<double> alone(rows, 0.0), interrupted(rows, 0.0, policy);
  for (const double t : {1e5, 3e5}) {
    alone.advance(t);
    int times = 0;
    for (; interrupted.advance(t) == Status::interrupted; ++times) {
      StickyGas<double> loaded(rows, 0.0, policy);
      SavedState state = SavedState::of(interrupted);
      load(state, loaded);
      interrupted = std::move(loaded);
    }
    EXPECT_GE(times, 2);
    EXPECT_EQ(SavedState::of(interrupted), SavedState::of(alone));
  }
}

// Two particles of a row, 2^-30 apart, at t = 1e9: rounding of their places is 1e-7, yet they never meet.
TEST(StickyGas, EqualVelocitiesNeverMeet) {
  StickyGas<double> gas(list<double>({1, 1 + 0x1p-30}, {0.7, 0.7}), 0.0);
  gas.advance(1e9);
  EXPECT_EQ(gas.counts().merges, 0U);
}

// E/N -> 0.221376226650747359 s^{4/3} t^{-2/3} (an independent oracle: ratios 1.0010 and 1.0037 at t = 10 and 1000 for
// 2e7 particles). At N = 1e6 and t = 100 the energy is that of some 5e4 clusters, of about its own size each: 1 %.
TEST(StickyGas, CoolsByTheTwoThirdsLaw) {
  constexpr ParticleIndex n = 1'000'000;
  const auto ring = gaussian_ring(n, double(n), 1, 0);
  StickyGas<double> gas(ring, 0.0);
  for (const double t : {10.0, 30.0, 100.0}) {
    gas.advance(t);
    const double energy = (ring->kinetic_energy() - gas.energy_lost()) / n;
    EXPECT_NEAR(energy / (0.221376226650747359 * std::pow(t, -2.0 / 3)), 1, 0.01) << t;
  }
}

}  // namespace cradle::test::sticky_gas_test
