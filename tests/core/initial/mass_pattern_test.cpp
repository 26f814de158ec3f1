// Masses that repeat, on rows, rings and in cold gases. Proves: particles have the masses of the pattern and their sums
// are those particle by particle; a pattern of equal masses changes no bit; a ring has no momentum. (Energy and
// momentum are kept, streamed is held and listed, at any cadence: engine/same_bits_test.cpp. Gaps against positions:
// engine/properties_test.cpp. In segments: parallel/segments_test.cpp.)
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::mass_pattern_test {

const auto &three = three_masses, &two = one_and_two;

Scene<double> rows(MassPattern<double> masses, std::optional<CentralParticle<double>> centre = {}) {
  return unequal_rows(std::move(centre), std::move(masses));
}
Scene<double> ring(MassPattern<double> masses) { return gaussian_ring(300, 300, 3, 0.05, 0, std::move(masses)); }

void expect_sums(const Particles<double>& particles) {
  double mass = 0, momentum = 0, energy = 0, least = INFINITY;
  for (ParticleIndex b = 0; b < particles.count(); ++b) {
    const double m = particles.mass(b), v = particles.velocity(b);
    mass += m, momentum += m * v, energy += m * v * v / 2, least = std::min(least, m);
    if (b + 1 == particles.count()) continue;
    // Positions below 2^9, velocities below 4: a difference of two rounds each of them.
    EXPECT_NEAR(particles.gap(b), particles.position(b + 1) - particles.position(b), 0x1p-43);
    EXPECT_NEAR(particles.closing_speed(b), v - particles.velocity(b + 1), 0x1p-50);
  }
  EXPECT_NEAR(particles.total_mass(), mass, 1e-12 * mass);
  EXPECT_NEAR(particles.momentum(), momentum, 1e-12 * mass);
  EXPECT_NEAR(particles.kinetic_energy(), energy, 1e-12 * energy);
  EXPECT_EQ(particles.least_mass(), least);
}

TEST(MassPattern, RepeatsFromTheFirstParticleOn) {
  const auto scene = rows(three);
  EXPECT_EQ(scene->mass(0), 1);
  EXPECT_EQ(scene->mass(1), 4.25);
  EXPECT_EQ(scene->mass(2), 0.5);
  EXPECT_EQ(scene->mass(399), 1);  // 399 = 3 * 133
  EXPECT_FALSE(scene->identical_masses());
  const auto with_centre = rows(three, heavy_particle<double>());
  EXPECT_EQ(with_centre->mass(160), 20);
  EXPECT_EQ(with_centre->mass(161), 0.5);  // 161 = 3 * 53 + 2
  EXPECT_TRUE(rows(MassPattern<double>({2, 2}))->identical_masses());
  EXPECT_TRUE(rows(MassPattern<double>({2, 2}), CentralParticle<double>{2, 0})->identical_masses());
  EXPECT_FALSE(rows(MassPattern<double>({2, 2}), CentralParticle<double>{1, 0})->identical_masses());
}

TEST(MassPattern, SumsAreThoseOfTheParticles) {
  for (const auto& scene : {rows(three), rows(three, heavy_particle<double>()), ring(three), ring(two),
                            ring(MassPattern<double>({2, 2})), cold_gas(1, HotPlace::left),
                            cold_gas(1, HotPlace::middle), cold_gas(32, HotPlace::middle), cold_gas(7, HotPlace::left)})
    expect_sums(*scene);
}

TEST(MassPattern, RingsHaveNoMomentum) {
  for (const auto& scene : {ring(two), ring(three)}) {
    CompensatedSum<double> momentum;
    for (ParticleIndex b = 0; b < 300; ++b) momentum.add(scene->mass(b) * scene->velocity(b));
    EXPECT_NEAR(momentum.value(), 0, 300 * 4.25 * 4 * 0x1p-52);  // every velocity, up to 4, and product is rounded
    EXPECT_EQ(scene->momentum(), 0);
  }
}

TEST(MassPattern, ColdGasHasItsEnergyAndNoMomentum) {
  const auto hot = cold_gas(32, HotPlace::middle);
  EXPECT_NEAR(hot->kinetic_energy(), 10, 10 * 64 * 0x1p-53);
  EXPECT_EQ(hot->momentum(), 0);
  EXPECT_EQ(hot->velocity(983), 0);
  EXPECT_NE(hot->velocity(984), 0);
  EXPECT_NE(hot->velocity(1015), 0);
  EXPECT_EQ(hot->velocity(1016), 0);
  const auto kick = cold_gas(1, HotPlace::left);
  EXPECT_EQ(kick->velocity(0), 0.75);
  EXPECT_EQ(kick->kinetic_energy(), 0.75 * 0.75 / 2);
  EXPECT_EQ(kick->momentum(), 0.75);
}

// Equal masses in a pattern are masses that are equal: same particles, same chain, same bits.
TEST(MassPattern, OfOnesChangesNoBit) {
  const std::vector<std::pair<Scene<double>, Scene<double>>> pairs{{rows({}), rows(MassPattern<double>({1, 1}))},
                                                                   {ring({}), ring(MassPattern<double>({1, 1, 1}))}};
  for (const auto& [plain, ones] : pairs) {
    EXPECT_EQ(plain->kinetic_energy(), ones->kinetic_energy());
    EXPECT_EQ(plain->momentum(), ones->momentum());
    EXPECT_EQ(plain->total_mass(), ones->total_mass());
    auto first = gap_run(plain, Inelastic<double>(0.9, 1e-3)), second = gap_run(ones, Inelastic<double>(0.9, 1e-3));
    ASSERT_EQ(first.advance(60.), Status::reached);
    ASSERT_EQ(second.advance(60.), Status::reached);
    expect_same_state(first, second, 60.);
  }
}

TEST(MassPattern, BadOnesAreRefused) {
  EXPECT_THROW(MassPattern<double>({1, 0}), std::invalid_argument);
  EXPECT_THROW(MassPattern<double>({1, -2}), std::invalid_argument);
  EXPECT_THROW(MassPattern<double>({1, INFINITY}), std::invalid_argument);
  EXPECT_THROW(ring(MassPattern<double>({1, 2, 3, 4, 5, 6, 7})), std::invalid_argument);  // 300 = 42 * 7 + 6
  EXPECT_THROW(heated(0, 1, 1., two, 1, 0), std::invalid_argument);
  EXPECT_THROW(heated(0, 2, 0., two, 1, 0), std::invalid_argument);
  EXPECT_THROW((Cold<double>(4, 1., HotPlace::left, heated(0, 5, 1., two, 1, 0), rshock_displacement)),
               std::invalid_argument);
  EXPECT_THROW((Cold<double>(4, 0., HotPlace::left, kicked<double>(0, 1.), rshock_displacement)),
               std::invalid_argument);
}

}  // namespace cradle::test::mass_pattern_test
