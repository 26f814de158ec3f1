// Particles on a ring: the chains against their slow twin, exactly in rational arithmetic (all laws that need no root)
// and to what the scene makes of roundings for the wet law; and the initial state of free cooling.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <random>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/precision/reference_gas.hpp"

namespace cradle::test::ring_test {

// Particles at multiples of 1/64 on a ring of circumference n, integer velocities: ties happen.
template <class T> std::shared_ptr<const List<T>> random_ring(std::mt19937& random, int n, bool equal_masses) {
  std::vector<T> x, v, m;
  int place = static_cast<int>(random() % 8);
  for (int b = 0; b < n; ++b) {
    x.push_back(T(place) / T(64));
    place += 1 + static_cast<int>(random() % 62);
    v.push_back(T(static_cast<int>(random() % 2001) - 1000) / T(512));
    m.push_back(equal_masses ? T(1) : T(1 + static_cast<int>(random() % 5)));
  }
  return std::make_shared<List<T>>(std::move(x), std::move(v), std::move(m), T(n));
}

template <class T> struct Particle {
  T x, v, m;
  ParticleIndex index;
};
// From the first particle right of 0.
template <class T> std::vector<Particle<T>> folded(const cradle::test::Gas<T>& gas) {
  std::vector<Particle<T>> particles;
  for (const auto& cell : gas.cells) {
    T x = gas.place(cell);
    while (x < T(0)) x += gas.length;
    while (!(x < gas.length)) x -= gas.length;
    particles.push_back({x, gas.velocity(cell), cell.m, cell.particles.front()});
  }
  std::ranges::sort(particles, {}, &Particle<T>::x);
  return particles;
}

template <class T, class Law, class Chain>
void expect_as_twin(const Law& law, Chain chain, const Particles<T>& particles, cradle::test::Gas<T> twin) {
  twin.ties_from_left = true;
  Simulation run(law, std::move(chain));
  for (const int t : {1, 3, 8, 20}) {
    twin.advance(T(t));
    ASSERT_EQ(run.advance(T(t)), Status::reached);
    ASSERT_EQ(run.counts().collisions, twin.collisions) << t;
    ASSERT_EQ(run.counts().merges, twin.merges) << t;
    const auto c = run.chain().configuration(run.chain().local_time(T(t)));
    const auto expected = folded(twin);
    ASSERT_EQ(c.x.size(), expected.size());
    for (std::size_t j = 0; j < expected.size(); ++j) {
      EXPECT_EQ(c.x[j], expected[j].x) << t;
      EXPECT_EQ(c.v[j], expected[j].v) << t;
      EXPECT_EQ(c.m[j], expected[j].m);
      EXPECT_EQ(c.index[j], expected[j].index);
    }
    ASSERT_EQ(c.gap.size(), expected.size());
    EXPECT_EQ(kinetic_energy(c, particles), T(particles.kinetic_energy() - run.energy_lost()));
  }
}

TEST(Ring, IsItsSlowTwinInRationalArithmetic) {
  using R = Rational;
  using Heavy = GapChain<R, IndividualMasses<R>>;
  std::mt19937 random(4);
  for (int n = 1; n <= 9; ++n)
    for (int repeat = 0; repeat < 6; ++repeat) {
      SCOPED_TRACE(testing::Message() << n << " particles, " << repeat);
      const auto alike = random_ring<R>(random, n, true), unlike = random_ring<R>(random, n, false);
      auto sticky = gas_like<R>(*unlike), merging = sticky, stiff = sticky;
      sticky.law = GasLaw::sticky;
      merging.law = GasLaw::merging, merging.restitution = R(1) / 4, merging.merge_speed = R(1) / 2;
      stiff.restitution = R(7) / 8, stiff.cutoff = R(1) / 4;
      // Elastic particles only for long: every inelastic collision makes the numbers longer.
      expect_as_twin<R>(Inelastic<R>(R(1)), GapChain<R>(alike, R(0)), *alike, gas_like<R>(*alike));
      expect_as_twin<R>(Sticky<R>{}, ClusterChain<R>(unlike, R(0)), *unlike, sticky);
      const InelasticMerging<R> law(Inelastic<R>(R(1) / 4), R(1) / 2);
      expect_as_twin<R>(law, ClusterChain<R>(unlike, R(0)), *unlike, merging);
      if (n > 3) continue;
      expect_as_twin<R>(Inelastic<R>(R(7) / 8, R(1) / 4), Heavy(unlike, R(0)), *unlike, stiff);
    }
}

// The wet law takes roots, so its twin is no oracle to the last bit. The effect of roundings on a scene is measured by
// the twin itself: its error in double and in long double, against the twin in 100 digits, in units of the type's
// rounding, is the same to a factor of two or so. The chain rounds as often, other numbers: it must be within 3 times
// that of the twin in 100 digits, in both types, and agree with it to 1e-97 in 100 digits, where both round.
constexpr int wet_times[] = {1, 3, 8, 20};
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

struct WetState {
  std::uint64_t collisions, merges;
  std::vector<ParticleIndex> index;
  std::vector<Wide> numbers;  // places, velocities, masses
};

template <class T> void record(WetState& state, ParticleIndex index, const T& x, const T& v, const T& m) {
  state.index.push_back(index);
  for (const T& number : {x, v, m}) state.numbers.push_back(Wide(number));
}

template <class T> std::vector<WetState> wet_twin(const List<T>& particles) {
  std::vector<WetState> states;
  auto twin = gas_like<T>(particles);
  twin.ties_from_left = true, twin.law = GasLaw::wet, twin.loss = T(1) / T(8);
  for (const int t : wet_times) {
    twin.advance(T(t));
    states.push_back({twin.collisions, twin.merges, {}, {}});
    for (const auto& b : folded(twin)) record(states.back(), b.index, b.x, b.v, b.m);
  }
  return states;
}

template <class T> std::vector<WetState> wet_chain(const std::shared_ptr<const List<T>>& particles) {
  std::vector<WetState> states;
  Simulation run(Wet<T>(T(1) / T(8)), ClusterChain<T>(particles, T(0)));
  for (const int t : wet_times) {
    EXPECT_EQ(run.advance(T(t)), Status::reached);
    const auto c = run.chain().configuration(run.chain().local_time(T(t)));
    states.push_back({run.counts().collisions, run.counts().merges, {}, {}});
    for (std::size_t j = 0; j < c.x.size(); ++j) record(states.back(), c.index[j], c.x[j], c.v[j], c.m[j]);
  }
  return states;
}

// In units of T's rounding.
template <class T> double difference(const WetState& a, const WetState& b) {
  EXPECT_EQ(a.collisions, b.collisions);
  EXPECT_EQ(a.merges, b.merges);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.numbers.size(), b.numbers.size());
  Wide greatest = 0;
  for (std::size_t k = 0; k < std::min(a.numbers.size(), b.numbers.size()); ++k)
    greatest = std::max(greatest, Wide(abs(a.numbers[k] - b.numbers[k])));
  return to_double(Wide(greatest / Wide(std::numeric_limits<T>::epsilon() / 2)));
}

TEST(Ring, WetParticlesPassAndMergeAsTheTwin) {
  for (int n = 1; n <= 12; ++n)
    for (unsigned repeat = 0; repeat < 20; ++repeat) {
      const unsigned seed = 100 * static_cast<unsigned>(n) + repeat;
      SCOPED_TRACE(testing::Message() << n << " particles, seed " << seed);
      const auto particles = [&]<class T>(T) {
        std::mt19937 random(seed);
        return random_ring<T>(random, n, repeat % 2 == 0);
      };
      const auto twin = wet_twin(*particles(Wide())), chain = wet_chain(particles(Wide()));
      const auto double_twin = wet_twin(*particles(0.0)), double_chain = wet_chain(particles(0.0));
      const auto long_twin = wet_twin(*particles(0.0L)), long_chain = wet_chain(particles(0.0L));
      for (std::size_t k = 0; k < twin.size(); ++k) {
        // At least what reading off a place of up to 12 rounds, 16 units.
        const double units = std::max(
            {difference<double>(double_twin[k], twin[k]), difference<long double>(long_twin[k], twin[k]), 16.});
        EXPECT_LE(difference<double>(double_chain[k], twin[k]), 3 * units) << wet_times[k];
        EXPECT_LE(difference<long double>(long_chain[k], twin[k]), 3 * units) << wet_times[k];
        EXPECT_LE(difference<Wide>(chain[k], twin[k]), std::min(8 * units, 2000.)) << wet_times[k];
        EXPECT_LE(units, 1000) << "no chaos yet: else this would prove nothing";
      }
    }
}

TEST(Ring, StartsWithZeroMomentumAndTheRequestedVariance) {
  constexpr ParticleIndex n = 200000;
  for (const bool gaussian : {true, false}) {
    const Ring<double> ring(n, 2.0 * n, 0.5, gaussian ? gaussian_velocity(7, 3) : uniform_velocity(7, 3),
                            uniform_displacement(0.25, 7, 3));
    double momentum = 0, fourth = 0, gaps = 0, closing = 0, least = 1e9;
    for (ParticleIndex b = 0; b < n; ++b) {
      const double v = ring.velocity(b);
      momentum += v;  // multiples of 2^-29, below 2^53 of them: exact
      fourth += v * v * v * v;
      gaps += ring.gap(b);
      closing += ring.closing_speed(b);
      least = std::min(least, ring.gap(b));
      if (b + 1 < n) {
        EXPECT_NEAR(ring.gap(b), ring.position(b + 1) - ring.position(b), 1e-10);
      }
    }
    EXPECT_EQ(momentum, 0);
    EXPECT_EQ(closing, 0);
    EXPECT_NEAR(gaps, 2.0 * n, 1e-8);
    EXPECT_GT(least, 0);
    // Five standard errors of variance (kurtosis k): sqrt((k - 1)/n) of it, and of the fourth moment likewise.
    const double kurtosis = gaussian ? 3 : 1.8, sixth_over = gaussian ? 105 : 9;  // <v^8>/s^8: 105, 81/9
    EXPECT_NEAR(2 * ring.kinetic_energy() / n, 0.25, 5 * 0.25 * std::sqrt((kurtosis - 1) / n));
    EXPECT_NEAR(fourth / n, kurtosis / 16, 5 * std::sqrt((sixth_over - kurtosis * kurtosis) / n) / 16);
  }
}

TEST(Ring, PortableLogarithm) {
  for (double x = 1; x > 1e-19; x *= 0.77) EXPECT_NEAR(detail::portable_log(x), std::log(x), 4e-16 * -std::log(x)) << x;
}

TEST(Ring, RefusesWhatIsNoRing) {
  EXPECT_THROW(Ring<double>(0, 1.0, 1.0, still, still), std::invalid_argument);
  EXPECT_THROW(Ring<double>(3, 0.0, 1.0, still, still), std::invalid_argument);
  EXPECT_THROW(Ring<double>(3, 1.0, 0.0, still, still), std::invalid_argument);
  EXPECT_THROW(List<double>({0, 1}, {0, 0}, {}, 1.0), std::invalid_argument);
}

}  // namespace cradle::test::ring_test
