// Random initial states: positions of a Poisson process, random masses, a gas between walls, a density that falls with
// the distance. Proves: gaps and places have the exact distributions, by the bound of Dvoretzky, Kiefer and Wolfowitz
// (Massart, Ann. Probab. 18, 1269, 1990): an empirical distribution of n independent numbers is further than c/sqrt(n)
// from the true one with a probability of at most 2 exp(-2 c^2); masses, energy and momentum are sums of those of the
// particles. (What is streamed is what is held: engine/same_bits_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/core/initial/poisson.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::random_places_test {

constexpr ParticleIndex many = 20000;

// Seeds are fixed; at this distance one in 5e5 of them would fail, at 4 standard deviations one in 16000.
constexpr double far = 2.5, deviations = 4;

template <class Distribution> void expect_distribution(std::vector<double> numbers, const Distribution& below) {
  std::sort(numbers.begin(), numbers.end());
  const auto n = static_cast<double>(numbers.size());
  double distance = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const double p = below(numbers[k]), before = static_cast<double>(k) / n;
    distance = std::max({distance, p - before, before + 1 / n - p});
  }
  EXPECT_LT(distance, far / std::sqrt(n));
  EXPECT_GT(distance, 0.2 / std::sqrt(n)) << "too even for independent numbers";  // probability below 1e-9
}

double exponential(double x) { return 1 - std::exp(-x); }
double uniform(double x) { return x; }

// Neighbouring gaps are independent: their correlation is a mean of n products of variance 1.
void expect_independent(const std::vector<double>& gaps) {
  double sum = 0;
  for (std::size_t k = 1; k < gaps.size(); ++k) sum += (gaps[k] - 1) * (gaps[k - 1] - 1);
  EXPECT_LT(std::abs(sum), deviations * std::sqrt(static_cast<double>(gaps.size())));
}

std::vector<double> gaps(const Particles<double>& particles, ParticleIndex from, ParticleIndex to) {
  std::vector<double> all;
  for (ParticleIndex p = from; p < to; ++p) {
    all.push_back(particles.gap(p));
    // Positions are below 2^15, so each is rounded by 2^-38 at most.
    if (p + 1 < particles.count()) {
      EXPECT_NEAR(all.back(), particles.position(p + 1) - particles.position(p), 0x1p-37);
    }
  }
  return all;
}

Rows<double> poisson_rows(ParticleIndex left, ParticleIndex right, bool centre) {
  const auto half_steps = [=](ParticleIndex p) {
    return !centre || p < left ? 2 * (p - left) + 1 : p == left ? 0 : 2 * (p - left) - 1;
  };
  return {{left, 0.5, 1.0},
          {right, -0.5, 1.0},
          centre ? std::optional(CentralParticle<double>{2, 0}) : std::nullopt,
          poisson_displacement(left + right + (centre ? 1 : 0), left, centre, half_steps, 7, 3)};
}

TEST(PoissonPositions, GapsAreExponentialAndIndependent) {
  std::vector<double> gaps;
  for (ParticleIndex p = 0; p < many; ++p) {
    const std::int64_t gap = exponential_gap(11, 5, p);
    ASSERT_GE(gap, 1);
    gaps.push_back(std::ldexp(static_cast<double>(gap), -28));
  }
  expect_distribution(gaps, exponential);
  expect_independent(gaps);
  EXPECT_NE(exponential_gap(11, 5, 0), exponential_gap(11, 6, 0));
  EXPECT_NE(exponential_gap(11, 5, 0), exponential_gap(12, 5, 0));
}

TEST(PoissonPositions, RowsOnEitherSideOfTheOriginAreAlike) {
  for (const bool centre : {false, true}) {
    const Rows<double> rows = poisson_rows(many, many, centre);
    const ParticleIndex right = many + (centre ? 1 : 0);
    EXPECT_LT(rows.position(many - 1), 0);
    EXPECT_GT(rows.position(right), 0);
    const auto of_left = gaps(rows, 0, many - 1), of_right = gaps(rows, right, rows.count() - 1);
    expect_distribution(of_left, exponential);
    expect_distribution(of_right, exponential);
    // The first particles of both rows are exponential distances away from the origin.
    EXPECT_EQ(rows.position(many - 1), -std::ldexp(static_cast<double>(exponential_gap(7, 3, many - 1)), -28));
    EXPECT_EQ(rows.position(right), std::ldexp(static_cast<double>(exponential_gap(7, 3, right)), -28));
    // The outermost ones are as far as n gaps of mean and variance 1.
    for (const double far_out : {-rows.position(0), rows.position(rows.count() - 1)})
      EXPECT_LT(std::abs(far_out - many), deviations * std::sqrt(many));
  }
}

TEST(PoissonPositions, RingsAndGasesHaveUniformPlaces) {
  const double length = 3 * many;
  const Ring<double> ring(many, length, 1., gaussian_velocity(2, 0), uniform_places(many, 2, 0));
  const cradle::Gas<double> gas(many, 0., length, 1., gaussian_velocity(2, 0), uniform_places(many, 2, 0));
  std::vector<double> places, gaps;
  double sum = 0;
  for (ParticleIndex p = 0; p < many; ++p) {
    places.push_back(ring.position(p) / length);
    gaps.push_back(ring.gap(p) / 3);
    sum += ring.gap(p);
    EXPECT_EQ(gas.position(p), ring.position(p));
    ASSERT_GT(ring.gap(p), 0);
    ASSERT_LT(p == 0 ? 0 : places[static_cast<std::size_t>(p) - 1], places.back());
  }
  ASSERT_LT(places.back(), 1);
  EXPECT_NEAR(sum, length, 1e-10 * length);
  expect_distribution(places, uniform);
  expect_distribution(gaps, exponential);  // but for corrections of order 1/n
  expect_independent(gaps);
}

TEST(PoissonPositions, FewPlacesOfManyReplicasAreUniform) {
  for (const ParticleIndex count : {1, 2, 3}) {
    std::vector<double> places, first;
    for (std::uint64_t replica = 0; replica < 4000; ++replica) {
      const cradle::Gas<double> gas(count, -1., 2., 1., gaussian_velocity(5, replica),
                                    uniform_places(count, 5, replica));
      first.push_back((gas.position(0) + 1) / 2);
      // One of the places, drawn by the parity of other random numbers, is one uniform number.
      const auto one = static_cast<ParticleIndex>(random_bits(6, replica, 0) % static_cast<std::uint64_t>(count));
      places.push_back((gas.position(one) + 1) / 2);
    }
    expect_distribution(places, uniform);
    const auto n = static_cast<double>(count);
    expect_distribution(first, [n](double x) { return 1 - std::pow(1 - x, n); });
  }
}

TEST(PoissonPositions, SharesAreRoundedDown) {
  constexpr std::int64_t big = (std::int64_t{1} << 62) + 12345, odd = (std::int64_t{1} << 59) - 987;
  EXPECT_EQ(detail::share_of(7, 10, 8), 8);
  EXPECT_EQ(detail::share_of(0, 10, 8), 0);
  EXPECT_EQ(detail::share_of(big / 2, odd, big - 1), (odd - 1) / 2);
  EXPECT_EQ(detail::share_of(big - 1, odd, big), odd - 1);
}

TEST(RandomMasses, AreUniformAndSumUp) {
  const MassPattern<double> masses(.5, 3.5, many, 4, 1);
  std::vector<double> shares;
  double sum = 0, least = INFINITY, greatest = 0;
  for (ParticleIndex p = 0; p < many; ++p) {
    shares.push_back((masses.of(p) - .5) / 3);
    sum += masses.of(p), least = std::min(least, masses.of(p)), greatest = std::max(greatest, masses.of(p));
    // Sums of the whole numbers are exact; the plain sum rounds once a particle, by 2^-38 at most.
    if (p % 777 == 0) {
      EXPECT_NEAR(masses.total(0, p + 1), sum, static_cast<double>(p + 1) * 0x1p-37);
    }
  }
  expect_distribution(shares, uniform);
  // No mass is in the outer 20/n of the range: probability e^-20.
  EXPECT_LT((least - .5) / 3, 20. / many);
  EXPECT_GT((greatest - .5) / 3, 1 - 20. / many);
  EXPECT_EQ(masses.least(), least);
  EXPECT_EQ(masses.greatest(), greatest);
  EXPECT_FALSE(masses.identical());
  EXPECT_EQ(masses.total(5, 5), 0);
  EXPECT_NEAR(masses.total(100, 103), masses.of(100) + masses.of(101) + masses.of(102), 1e-14);
}

TEST(RandomNumbers, OfMassesPlacesAndVelocitiesAreIndependent) {
  const MassPattern<double> masses(1., 2., many, 4, 1);
  const std::vector<std::int64_t> velocities = drawn(gaussian_velocity(4, 1), 0, many);
  double with_gaps = 0, with_velocities = 0, with_shifts = 0, gaps_with_velocities = 0;
  const Displacement shift = uniform_displacement(0.49, 4, 1);
  for (ParticleIndex p = 0; p < many; ++p) {
    const double mass = (masses.of(p) - 1.5) * std::sqrt(12);
    const double gap = std::ldexp(static_cast<double>(exponential_gap(4, 1, p)), -28) - 1;
    const double speed = std::ldexp(static_cast<double>(velocities[static_cast<std::size_t>(p)]), -28);
    with_gaps += mass * gap, with_velocities += mass * speed, gaps_with_velocities += gap * speed;
    with_shifts += mass * std::ldexp(static_cast<double>(shift(p)), -28) / 0.49 * std::sqrt(3);
  }
  for (const double sum : {with_gaps, with_velocities, with_shifts, gaps_with_velocities})
    EXPECT_LT(std::abs(sum), deviations * std::sqrt(many));
}

TEST(Gas, HasTheSumsOfItsParticlesAndFillsTheRoom) {
  const MassPattern<double> masses(.5, 2., 500, 9, 0);
  for (const auto& displacement : {uniform_displacement(0, 9, 0), uniform_places(500, 9, 0)}) {
    const cradle::Gas<double> gas(500, -20., 1000., 1.5, gaussian_velocity(9, 0), displacement, masses);
    double energy = 0, momentum = 0, square = 0;
    for (ParticleIndex p = 0; p < 500; ++p) {
      const double m = gas.mass(p), v = gas.velocity(p);
      energy += m * v * v / 2, momentum += m * v, square += v * v / 2.25;
      EXPECT_GT(gas.position(p), -20);
      EXPECT_LT(gas.position(p), 980);
      if (p + 1 < 500) {
        EXPECT_NEAR(gas.closing_speed(p), v - gas.velocity(p + 1), 1e-14);
      }
    }
    EXPECT_NEAR(gas.kinetic_energy(), energy, 1e-12 * energy);
    EXPECT_NEAR(gas.momentum(), momentum, 1e-10);
    EXPECT_LT(std::abs(square - 500), deviations * std::sqrt(2 * 500.));  // variance 2 each
  }
  const cradle::Gas<double> even(4, 1., 2., 1., gaussian_velocity(9, 0), uniform_displacement(0, 9, 0));
  EXPECT_EQ(even.position(0), 1.25);
  EXPECT_EQ(even.position(3), 2.75);
  EXPECT_EQ(even.gap(1), 0.5);
}

Scene<double> falling(HotPlace place, double falls, Displacement displacement, ParticleIndex count = 2001) {
  return std::make_shared<Cold<double>>(count, 2., place, kicked(first_hot(place, count, 1), 10.), displacement,
                                        MassPattern<double>(), falls);
}

TEST(FallingDensity, IsThePowerOfTheDistance) {
  for (const double falls : {-1., 0.25, 0.5, 0.75}) {
    const auto gas = falling(HotPlace::middle, falls, uniform_displacement(0, 1, 0));
    EXPECT_EQ(gas->position(1000), 0);
    for (const ParticleIndex p : {1001, 1007, 1500, 2000}) {
      // Between the origin and x there are x^(1 - b)/(1 - b) particles, x in spacings.
      const double x = gas->position(p) / 2;
      EXPECT_NEAR(std::pow(x, 1 - falls) / (1 - falls), static_cast<double>(p - 1000), 1e-12 * 1000);
      EXPECT_EQ(gas->position(2000 - p), -gas->position(p));
      if (p < 2000) {
        EXPECT_NEAR(gas->gap(p), gas->position(p + 1) - gas->position(p), 1e-15 * gas->position(p + 1));
      }
      EXPECT_EQ(gas->gap(2000 - p), gas->gap(p - 1));
    }
  }
  const auto left = falling(HotPlace::left, 0.5, uniform_displacement(0, 1, 0));
  EXPECT_EQ(left->position(0), 0);
  EXPECT_EQ(left->position(6), 2 * 9.);  // (6/2)^2 spacings
  const auto even = falling(HotPlace::left, 0, uniform_displacement(0, 1, 0));
  EXPECT_EQ(even->position(6), 12);
}

TEST(FallingDensity, OfAPoissonProcessIsOneToo) {
  const auto places = poisson_displacement(
      many, 0, true, [](ParticleIndex p) { return 2 * p; }, 3, 0);
  const auto gas = falling(HotPlace::left, 0.5, places, many);
  std::vector<double> gaps;
  for (ParticleIndex p = 1; p < many; ++p)
    gaps.push_back(2 * (std::sqrt(gas->position(p) / 2) - std::sqrt(gas->position(p - 1) / 2)));
  expect_distribution(gaps, exponential);
}

TEST(FallingDensity, RefusesWhatHasNoDistance) {
  EXPECT_THROW(falling(HotPlace::left, 1, uniform_displacement(0, 1, 0)), std::invalid_argument);
  EXPECT_THROW(falling(HotPlace::left, .999, uniform_displacement(0, 1, 0)), std::invalid_argument);  // 10^3300
  EXPECT_THROW(cradle::Gas<double>(3, 0., -1., 1., gaussian_velocity(1, 0), uniform_places(3, 1, 0)),
               std::invalid_argument);
  EXPECT_THROW(MassPattern<double>(2., 1., 5, 1, 0), std::invalid_argument);
  EXPECT_THROW(uniform_places(0, 1, 0), std::invalid_argument);
}

}  // namespace cradle::test::random_places_test
