// The kinetic energy of a run (relative_motion.hpp, sample.hpp) is that of the numbers in the chain, to the last
// digits, even if very little energy is left.
//
// References are sums of exact rationals over what chains hold: closing speeds, or velocities. The bound of
// relative_motion.hpp is 8u of the energy of relative motion, and 4u are for the rest: 16u, u = 2^-53, holds in any
// run.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test::energy_test {

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

template <class Run> void expect_near(const Run& run, const Rational& exact) {
  const double energy = run.kinetic_energy(), wanted = to_double(exact);
  EXPECT_GE(energy, 0);
  EXPECT_LE(std::abs(energy - wanted), 16 * u * wanted) << energy << " " << wanted;
}

// P^2/2M and what particles of these velocities, against any of them, have against each other.
Rational energy_of(const std::vector<Rational>& m, const std::vector<Rational>& v, const Rational& momentum) {
  Rational mass(0), sum(0), twice(0);
  for (std::size_t j = 0; j < m.size(); ++j) mass += m[j], sum += m[j] * v[j], twice += m[j] * v[j] * v[j];
  return (momentum * momentum / mass + twice - sum * sum / mass) / Rational(2);
}

// Of a chain in closing speeds, without walls.
template <class Chain> Rational exact_energy(const Chain& chain) {
  const Particles<double>& particles = chain.particles();
  std::vector<Rational> m, v;
  Rational slowing(0);
  const Slot end = chain.on_ring() ? chain.last() : chain.last() + 1;
  const ParticleIndex first = chain.particle(chain.first());
  for (ParticleIndex b = 0; b < particles.count(); ++b) {
    const auto s = chain.first() + static_cast<Slot>(b - first);
    if (b > first && s <= end) slowing -= Rational(chain.closing(s - 1));
    m.push_back(Rational(particles.mass(b)));
    v.push_back(slowing);
  }
  return energy_of(m, v, Rational(particles.conserved_momentum()));
}

Scene<double> moving(double drift, std::vector<double> m = {}) {
  std::vector<double> x, v;
  for (ParticleIndex b = 0; b < 12; ++b)
    x.push_back(double(b) + 0.25 * double(b % 3)), v.push_back(drift + 0.5 * double(b % 4) - 0.125 * double(b));
  return list(std::move(x), std::move(v), std::move(m));
}

TEST(Energy, IsNeverNegative) {
  for (const double restitution : {0., 0.03, 0.05, 0.0717, 0.0719, 0.072, 0.08, 0.2, .5}) {
    SCOPED_TRACE(restitution);
    auto run = gap_run<double>(three_particles(), Inelastic(restitution), {CollapsePolicy::stop, 1e-290});
    double before = 1;
    for (double t = 0.25; t < 40; t += 0.25) {
      const Status status = run.advance(t);
      const double energy = sample(run, 1., status == Status::reached ? t : run.last_collision_time()).energy;
      EXPECT_GE(energy, 0) << t;
      EXPECT_LE(energy, before) << t;
      before = energy;
      if (status != Status::reached) break;
    }
    expect_near(run, exact_energy(run.chain()));
    // Each of more than 300 collisions leaves 2/5 of the closing speeds.
    EXPECT_TRUE(restitution != 0.05 || (run.counts().collisions > 300 && before > 1e-257 && before < 1e-254)) << before;
  }
}

template <class Run> void expect_exact_at(double until, Run run) {
  SCOPED_TRACE(until);
  run.advance(until);
  expect_near(run, exact_energy(run.chain()));
}

TEST(Energy, OfClosingSpeeds) {
  const std::vector<double> masses{1, 3, 1e-6, 1, 7, 1e6, 1, 1, 0.3, 2, 5, 1e3};
  for (const double drift : {0., 1., 1e6})
    for (const auto& [restitution, until] : {std::pair{.1, .5}, {.1, 30.}, {.9, 5.}, {.9, 50.}}) {
      SCOPED_TRACE(testing::Message() << "drift " << drift << ", restitution " << restitution);
      expect_exact_at(until, gap_run<double>(moving(drift), Inelastic(restitution, 1e-9)));
      expect_exact_at(until, mass_run<double>(moving(drift, masses), Inelastic(restitution, 1e-3)));
    }
}

TEST(Energy, OfRowsAndRings) {
  const Inelastic law(0.9, 1e-4);
  for (const double until : {.25, 10., 60., 90.}) {
    expect_exact_at(until, gap_run(rshock<double>(200), law));
    expect_exact_at(until, gap_run(rshock<double>(200), law, {}, 0., {.hold_all = true}));
    expect_exact_at(until, gap_run(gaussian_ring(100, 100), law));
  }
}

// Velocities are relative to the wall that closing speeds begin or end with.
TEST(Energy, BetweenWalls) {
  for (const double speed : {0., .25})
    for (const bool left : {true, false})
      for (const double until : {40., 60.}) {
        SCOPED_TRACE(testing::Message() << speed << (left ? " left, t = " : " right, t = ") << until);
        const Wall<double> wall{left ? -1. : 20., left ? -speed : speed, .5};
        const auto particles = between(0, moving(left ? -0.5 : 0.5), left ? std::optional(wall) : std::nullopt,
                                       left ? std::nullopt : std::optional(wall));
        auto run = gap_run(particles, Inelastic(0.5, 1e-6));
        run.advance(until);
        EXPECT_GT(run.chain().walls().tally(left ? End::left : End::right).collisions, 0U);
        const auto& chain = run.chain();
        Rational v(wall.speed), twice(0);
        for (Slot s = left ? chain.first() : chain.last(), n = 0; n < 12; ++n, left ? ++s : --s) {
          left ? v -= Rational(chain.closing(s)) : v += Rational(chain.closing(s));
          twice += v * v;
        }
        expect_near(run, twice / Rational(2));
      }
}

// Chains that hold velocities: those of a configuration that holds all particles, in the frame of their momentum.
TEST(Energy, OfVelocities) {
  const auto expect_exact = [](double until, auto run) {
    run.advance(until);
    const Configuration<double> c = run.configuration(until);
    Rational twice(0);
    for (std::size_t j = 0; j < c.x.size(); ++j) twice += Rational(c.m[j]) * Rational(c.v[j]) * Rational(c.v[j]);
    EXPECT_NEAR(run.kinetic_energy() / to_double(Rational(twice / Rational(2))), 1, 64 * u) << until;
  };
  for (const double until : {5., 40.}) {
    expect_exact(until, position_run(rmix<double>(60), Inelastic(0.9)));
    expect_exact(until, Simulation(Wet(0.01), ClusterChain<double>(gaussian_ring(100, 100), 0)));
    expect_exact(until, StickyGas<double>(gaussian_ring(100, 100), 0));
  }
  // Of rows, where most particles are not held.
  const Scene<double> rows = rshock<double>(2000);
  Simulation wet(Wet(0.01), ClusterChain<double>(rows, 0));
  StickyGas<double> sticky(rows, 0);
  for (const double until : {.1, 20., 200.}) {
    wet.advance(until), sticky.advance(until);
    EXPECT_NEAR(wet.kinetic_energy() + wet.energy_lost(), 250, 1e-11);
    EXPECT_NEAR(sticky.kinetic_energy() + sticky.energy_lost(), 250, 1e-11);
  }
  sticky.advance(3000);
  EXPECT_EQ(sticky.kinetic_energy(), 0);  // all are one
}

// While half of the energy is left it is the ledger's, which for elastic particles is that at the start.
TEST(Energy, OfElasticParticlesStays) {
  const Scene<double> particles = rmix<double>(50);
  auto run = gap_run(particles, Inelastic(1.));
  for (const double t : {1., 10., 100.}) {
    run.advance(t);
    EXPECT_EQ(sample(run, particles->kinetic_energy(), t).energy, particles->kinetic_energy());
    EXPECT_NEAR(run.kinetic_energy(), particles->kinetic_energy(), 1e-13);
  }
}

}  // namespace cradle::test::energy_test
