// Gravity: one ball against closed forms (its bounces to the last bit: precision/wall_gaps_test.cpp); columns in free
// fall, which are those without gravity to the last bit; frames and mirrors; the account of energy; a gas over a
// thermal floor. (In gaps and positions against a gas in 100 digits: precision/exact_gas_test.cpp; what is refused:
// walls_test.cpp.)
#include "cradle/core/observe/batch_means.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/compare.hpp"

namespace cradle::test::gravity_test {

// A ball at the height 1, with the acceleration 2, over a floor of the restitution 1/2.
const Scene<double> soft_floor = between(-2, list<double>({1}, {0}), Wall<double>{0., 0., 0.5});

// With the restitution 1/2 it meets the floor at 3 - 2^(1 - n): in double exactly, while these times are doubles.
TEST(Gravity, AnInelasticBallCollapsesOnTheFloor) {
  auto run = mass_run(soft_floor, Inelastic<double>(1));
  std::vector<double> times, speeds;
  const auto status = run.advance(
      4., [&](const Collision<double>& c) { times.push_back(c.time.value()), speeds.push_back(c.closing_speed); });
  EXPECT_EQ(status, Status::exhausted);  // without a cut-off it has no end
  ASSERT_GT(times.size(), 900U);
  for (std::size_t n = 0; n < 52; ++n) EXPECT_EQ(times[n], 3 - std::ldexp(1, 1 - int(n)));
  for (std::size_t n = 0; n < 900; ++n) EXPECT_EQ(speeds[n], std::ldexp(1, 1 - int(n)));
  EXPECT_NEAR(run.energy_lost(), 2, 1e-14);  // losses below the grid of the ledger are 0
}

// It leaves the floor at the speeds 1, 1/2, ..., and rises to 1/4 of their squares: 4^-k after k collisions.
TEST(Gravity, AStopGapIsComparedWithTheReboundFromAFloor) {
  const auto check = [&](auto&& chain) {
    for (const int k : {3, 40, 200}) {
      Policy<double> policy{CollapsePolicy::stop, std::ldexp(1.5, -2 * k)};
      Simulation run(Inelastic<double>(1), chain, policy);
      EXPECT_EQ(run.advance(4.), Status::collapsed);
      EXPECT_EQ(run.counts().collisions, static_cast<std::uint64_t>(k));
      EXPECT_EQ(run.collapse().gap, std::ldexp(1, -2 * k));
      EXPECT_EQ(run.collapse().particle, -1);
      EXPECT_EQ(run.last_collision_time(), 3 - std::ldexp(1, 2 - k));
      EXPECT_EQ(run.kinetic_energy(run.last_collision_time()), std::ldexp(1, 1 - 2 * k));
    }
  };
  check(GapChain<double>(soft_floor, 0.));
  check(PositionChain<double>(soft_floor, 0.));
}

// Below the cut-off collisions with the floor are elastic too.
TEST(Gravity, ACutOffEndsTheCollapseOnTheFloor) {
  const auto check = [&](auto run) {
    EXPECT_EQ(run.advance(10), Status::reached);
    // Speeds 2, 1, ..., 2^-6 lose; 2^-7 and below do not.
    EXPECT_EQ(run.energy_lost(), 2 - std::ldexp(1, -15));
    EXPECT_GT(run.counts().below_cutoff, 800U);
    EXPECT_EQ(run.counts().collisions - run.counts().below_cutoff, 8U);
  };
  check(mass_run(soft_floor, Inelastic<double>(1, 0.01)));
  check(position_run(soft_floor, Inelastic<double>(1, 0.01)));
  check(mass_run(soft_floor, SpeedDependent<double>(0.9, 0.01, 2)));
  // A contact time: the first collisions that follow within it are elastic.
  auto brief = mass_run(soft_floor, ContactTime<double>(Inelastic<double>(1), 0.1));
  EXPECT_EQ(brief.advance(10), Status::reached);
  // Flights of 1, 1/2, ..., 1/16 end inelastically: that of 1/16 is shorter than the contact time.
  EXPECT_EQ(brief.energy_lost(), 2 - std::ldexp(1, -9));
  EXPECT_GT(brief.counts().below_cutoff, 100U);
  EXPECT_EQ(brief.counts().collisions - brief.counts().below_cutoff, 5U);
  // A thermal floor is never elastic.
  auto warm = mass_run(between(-2, list<double>({1}, {0}), thermal(0, 1)), Inelastic<double>(1, 1e9));
  EXPECT_EQ(warm.advance(10), Status::reached);
  EXPECT_GT(warm.counts().collisions, 1U);
  EXPECT_EQ(warm.counts().below_cutoff, 0U);
}

// Without walls gravity changes no gap.
TEST(Gravity, AColumnInFreeFallIsTheSame) {
  const Inelastic<double> law(0.9, 1e-2);
  const auto check = [&](const Scene<double>& particles, double until) {
    const double a = -0.75;
    auto at_rest = mass_run<double>(particles, law);
    auto identical_masses = gap_run<double>(particles, law);
    const auto falls = between(a, particles);
    auto fallen = mass_run(falls, law);
    for (const double t : {until / 3, until / 2, until}) {
      at_rest.advance(t), fallen.advance(t), identical_masses.advance(t);
      const auto wanted = configuration_at(at_rest, t), found = configuration_at(fallen, t);
      EXPECT_EQ(found.gap, wanted.gap);
      EXPECT_EQ(found.closing_speed, wanted.closing_speed);
      EXPECT_EQ(found.gap, configuration_at(identical_masses, t).gap);
      EXPECT_TRUE(same_collisions(fallen.counts(), at_rest.counts()));
      EXPECT_EQ(fallen.energy_lost(), at_rest.energy_lost());
      for (std::size_t j = 0; j < wanted.x.size(); ++j) {
        EXPECT_NEAR(found.x[j], wanted.x[j] + a * t * t / 2, 1e-12 * (1 + t * t));
        EXPECT_NEAR(found.v[j], wanted.v[j] + a * t, 1e-13 * (1 + t));
      }
      EXPECT_LT(unaccounted(fallen, *falls, t), 1e-13);
      EXPECT_TRUE(guards_hold(fallen, *falls, t));
    }
    EXPECT_GT(fallen.counts().collisions, 500U);
  };
  check(rmix<double>(100), 60);
  check(rshock<double>(200), 150);
}

// Profiles have the particles of rows that are not held where they have fallen to.
TEST(Gravity, ProfilesOfRowsThatAreStreamed) {
  const auto particles = between(-0.01, uniform_rows(400), Wall<double>{-205., 0.25, .8});
  auto run = mass_run(particles, Inelastic<double>(0.99, 0.1));
  for (const double t : {20., 40., 120.}) {
    run.advance(t);
    const auto now = configuration_at(run, t);
    double count = 0, moment = 0, momentum = 0;
    for_each_particle(now, *particles, t, {-1e4, 1e4},
                      [&](double x, double v, double m) { count += m, moment += m * x, momentum += m * v; });
    EXPECT_EQ(count, 400);
    EXPECT_NEAR(0.01 * moment, potential_energy(now, *particles, t), 1e-11 * 400 * 200);
    EXPECT_NEAR(momentum, run.chain().walls().tally(End::left).momentum.value() - 0.01 * 400 * t, 1e-9);
  }
}

// An elastic column keeps its energy; a wrong one is found.
TEST(Gravity, AnElasticColumnKeepsItsEnergy) {
  const auto particles = between(-1, rmix<double>(50), Wall<double>{-1.});
  auto run = mass_run(particles, Inelastic<double>(1));
  EXPECT_EQ(run.advance(400), Status::reached);
  EXPECT_GT(run.counts().collisions, 10000U);
  EXPECT_LT(unaccounted(run, *particles, 400.), 1e-13);
  EXPECT_EQ(run.energy_lost(), 0);
  EXPECT_TRUE(guards_hold(run, *particles, 400.));
  EXPECT_FALSE(
      guards_hold(run, *particles, 400., 1e-6 * (particles->mechanical_energy() + particles->energy_of_fall())));
}

// In the frame of a floor that moves uniformly it is at rest: gaps are the same to the last bit.
TEST(Gravity, AFloorThatMovesUniformly) {
  const Inelastic<double> law(0.95, 1e-2);
  const auto particles = rmix<double>(20);
  auto at_rest = mass_run(between(-0.5, particles, Wall<double>{-1., 0., .9}), law);
  auto moving = mass_run(between(-0.5, seen_in(*particles, {.drift = 0.375}), Wall<double>{-1., .375, .9}), law);
  at_rest.advance(50), moving.advance(50);
  EXPECT_GT(moving.counts().collisions, 200U);
  EXPECT_EQ(configuration_at(moving, 50.).gap, configuration_at(at_rest, 50.).gap);
  EXPECT_EQ(moving.counts().collisions, at_rest.counts().collisions);
  EXPECT_NE(sample(moving, 0., 50.).given, 0);
}

// The mirror image has the mirrored gaps, bit for bit; the walls are at rest, or shaken.
TEST(Gravity, AMirrorImage) {
  const auto particles = rmix<double>(30);
  const auto expect_mirror = [&](const Shaking& low, const Shaking& high, double speed, double end) {
    auto run = mass_run(between(-0.5, particles, wall(-1, low, 0.9, speed), wall(33, high)),
                        Inelastic<double>(0.95, 1e-2)),
         mirrored =
             mass_run(between(0.5, seen_in(*particles, mirror_frame), wall(-33, high), wall(1, low, 0.9, -speed)),
                      Inelastic<double>(0.95, 1e-2));
    run.advance(end), mirrored.advance(end);
    EXPECT_GT(run.counts().collisions, 300U);
    auto gap = configuration_at(mirrored, end).gap;
    std::reverse(gap.begin(), gap.end());
    EXPECT_EQ(configuration_at(run, end).gap, gap);
  };
  expect_mirror(nullptr, nullptr, 0, 60);
  for (const Shape shape : shapes) expect_mirror(shaken(shape, 0.5, 0.25), shaken(shape, 0.125, 1, 7), 0.0625, 30);
}

// A ceiling above a ball that is thrown at it, grazes it, or does not reach it. The ball rises by v^2/2a.
TEST(Gravity, ACeiling) {
  const auto bounces = [](double speed, double ceiling) {
    auto run = mass_run(between(-2, list<double>({1}, {speed}), Wall<double>{0.}, Wall<double>{ceiling}),
                        Inelastic<double>(1));
    std::vector<ParticleIndex> walls;
    run.advance(6., [&](const Collision<double>& c) { walls.push_back(c.left); });
    return walls.empty() ? -2 : walls.front();
  };
  EXPECT_EQ(bounces(2, 2), -1);  // it just touches the ceiling, without speed: then the floor
  EXPECT_EQ(bounces(2, std::nextafter(2., 3.)), -1);
  EXPECT_EQ(bounces(2, std::nextafter(2., 0.)), 0);
  EXPECT_EQ(bounces(std::nextafter(2., 3.), 2), 0);
  EXPECT_EQ(bounces(std::nextafter(2., 0.), 2), -1);
  EXPECT_EQ(bounces(4, 2), 0);
  EXPECT_EQ(bounces(-4, 2), -1);
}

// N elastic particles over a floor of the temperature T, at the heights 0 < x_1 < ... < x_N with the density exp(-sum
// m_i a x_i/T): its domain scales, so the mean of the sum is N T, whatever the masses; that of the kinetic energy is N
// T/2.
TEST(Gravity, AGasOverAThermalFloor) {
  constexpr ParticleIndex n = 12;
  std::vector<double> x, v, m;
  for (ParticleIndex i = 0; i < n; ++i) x.push_back(double(i) + 0.5), v.push_back(0), m.push_back(i % 3 == 0 ? 2.5 : 1);
  constexpr double temperature = 3, a = -1.5;
  const auto particles = between(a, list<double>(x, v, m), thermal(0., temperature));
  auto run = mass_run(particles, Inelastic<double>(1));
  EXPECT_EQ(run.advance(6400), Status::reached);  // by which it has forgotten how it began
  SampledMeans means(2, 25600);
  for (double t = 6404; !means.complete(); t += 4) {
    EXPECT_EQ(run.advance(t), Status::reached);
    means.add({sample(run, 0., t).energy, potential_energy(configuration_at(run, t), *particles, t)});
  }
  const auto kinetic = means.means()[0], potential = means.means()[1];
  EXPECT_LT(kinetic.error, 0.5);
  EXPECT_LT(potential.error, 1.5);
  EXPECT_NEAR(kinetic.mean, n * temperature / 2, 4 * kinetic.error);
  EXPECT_NEAR(potential.mean, n * temperature, 4 * potential.error);
}

}  // namespace cradle::test::gravity_test
