// Results of other authors in small systems: a blast in a cold gas, dominoes, a splash, collapse on a ring, free
// cooling by Haff's law, as the sticky gas on the same initial data, and of wet particles. Proves: particles follow the
// published solutions as closely as small systems do, and the exponents of a splash are those of Euler's equations.
// bench/results/classics.md and paper.md have the solutions and larger systems; tests/tools/python/test_plot.py checks
// the functions that pictures draw them by.
#include <boost/numeric/odeint.hpp>
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/theory/free_cooling.hpp"
#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::classics_test {

const Inelastic<double> elastic(1.);

// ---- blast

// Against 1, the front of 8 blasts: known to the scatter between them, some 1 %, of a front that is early by the free
// path of single particles, 1.4 % at this time (falling as 1/R).
TEST(Blast, FrontOfAlternateMassesIsWhereEulersEquationsHaveIt) {
  const MassPattern<double> masses({1, 2});
  const double t = 4000, front = std::cbrt(1071. / 152 * 32 * t * t / 1.5);  // (A E t^2/rho)^(1/3)
  double sum = 0;
  constexpr int replicas = 8;
  for (int replica = 0; replica < replicas; ++replica) {
    const auto particles = std::make_shared<Cold<double>>(
        6000, 1., HotPlace::middle, heated(2984, 32, 32., masses, 1, static_cast<std::uint64_t>(replica)),
        uniform_displacement(0, 1, 0), masses);
    auto run = mass_run<double>(particles, elastic);
    ASSERT_EQ(run.advance(t), Status::reached);
    const double now = run.chain().local_time(t);
    sum += (run.chain().front_right(now) - run.chain().front_left(now)) / 2;
  }
  EXPECT_NEAR(sum / replicas / front, 1.014, 0.02);
}

// ---- dominoes

TEST(Domino, HeavyParticlesAreHitOnTime) {
  for (int k = 1; k <= 4; ++k) {
    const double c = std::cos(std::numbers::pi / (2 * k + 1)), ratio = c / (1 - c);
    const auto particles = std::make_shared<Cold<double>>(
        400, 1., HotPlace::left, kicked<double>(0, 1.), uniform_displacement(0, 1, 0), MassPattern<double>({ratio, 1}));
    auto run = mass_run<double>(particles, elastic);
    ParticleIndex reached = 0;
    double worst = 0;
    run.advance(300., [&](const Collision<double>& collision) {
      if (collision.right <= reached) return;
      reached = collision.right;
      const double due = static_cast<double>(reached) - 1 + 1 / (2 * c);
      if (reached % 2 == 0) worst = std::max(worst, std::abs(collision.time.value() - due));
    });
    EXPECT_GE(reached, 300);
    EXPECT_LT(worst, 1e-10) << k;  // drift of velocities by roundings, 150 wedges: 3e-12 found for k = 2
    EXPECT_NEAR(static_cast<double>(run.counts().collisions), 150 * 2 * k, 2 * k) << k;
  }
}

// ---- splash

// Whether the solution of Euler's equations with the exponent d runs into c^2 = a^2; by Runge and Kutta's fourth order
// in steps of s, d xi/ds = -gamma (c^2 - a^2), along which 1 - a^2/c^2 falls, to 0 if d is too small. The equations are
// in bench/results/classics.md.
bool splash_breaks_off(double d, double gamma, double step) {
  using State = std::array<double, 4>;  // xi, U, G, P
  const double k = (d - 1) / d;
  const auto slope = [k, gamma](const State& y, State& along_it, double) {
    const double a = y[1] - y[0], c2 = gamma * y[3] / y[2];
    const double along = gamma * (c2 - a * a), u = k * (gamma * a * y[1] - 2 * c2);
    along_it = {-along, -u, y[2] * u / a, y[2] * (k * y[1] * along + a * u)};
  };
  boost::numeric::odeint::runge_kutta4<State> stepper;
  State y{1, 2 / (gamma + 1), (gamma + 1) / (gamma - 1), 2 / (gamma + 1)};
  for (double before = 1;;) {
    stepper.do_step(slope, y, 0, step);
    const double a = y[1] - y[0], subsonic = 1 - a * a * y[2] / (gamma * y[3]);
    if (!(subsonic > 0)) return true;
    if (!(subsonic < before)) return false;
    before = subsonic;
  }
}

// d of R ~ t^d: the least exponent whose solution does not break off.
double splash_exponent(double gamma, double step) {
  double below = 0.55, above = 2.0 / 3;  // 2/3: of a shock whose energy is kept
  for (int halvings = 0; halvings < 48; ++halvings) {
    const double d = (below + above) / 2;
    (splash_breaks_off(d, gamma, step) ? below : above) = d;
  }
  return above;
}

// The picture and classics.md compare with that of gamma = 3. An impulsive load on air goes as t^(3/5), exactly
// (Zel'dovich and Raizer, chapter XII); the others are from an integration of Euler's equations through c^2 = a^2 by
// another program, to so many digits. Of a method of fourth order the error is a fifteenth of what a step twice as long
// changes.
TEST(Splash, ExponentsAreThoseOfEulersEquations) {
  struct Known {
    double gamma, exponent, unit;  // unit: of the last digit known
  };
  for (const auto& [gamma, exponent, unit] : {Known{1.4, 0.6, 1e-11}, Known{5. / 3, 0.610727, 1e-6},
                                              Known{2.8, 0.626697, 1e-6}, Known{3, 0.62795204166, 1e-11}}) {
    const double found = splash_exponent(gamma, 0.0025);
    const double error = std::abs(found - splash_exponent(gamma, 0.005)) / 15;
    EXPECT_NEAR(found, exponent, 2 * error + unit / 2) << gamma;
    EXPECT_LT(error, 1e-10) << gamma;
  }
}

TEST(Splash, FrontAndEnergyAreThatOfOneSolution) {
  // Local exponents from t = 5000 to 20000: 0.628 and -0.116 less what goes as t^-0.7, 0.02 here.
  const MassPattern<double> masses({1, 2});
  double front[2] = {0, 0}, energy[2] = {0, 0};
  constexpr int replicas = 24;
  for (int replica = 0; replica < replicas; ++replica) {
    const auto particles =
        std::make_shared<Cold<double>>(3000, 1., HotPlace::left, kicked<double>(0, 1.),
                                       uniform_displacement(0.49, 1, static_cast<std::uint64_t>(replica)), masses);
    auto run = mass_run<double>(particles, elastic);
    for (const int k : {0, 1}) {
      const double t = k == 0 ? 5000 : 20000;
      ASSERT_EQ(run.advance(t), Status::reached);
      front[k] += std::log(run.chain().front_right(run.chain().local_time(t))) / replicas;
      const auto now = configuration_at(run, t);
      double inside = 0;
      for (std::size_t j = 0; j < now.x.size(); ++j)
        if (now.x[j] > 0) inside += now.m[j] * now.v[j] * now.v[j] / 2;
      energy[k] += std::log(inside) / replicas;
    }
    EXPECT_NEAR(run.energy_lost(), 0, 1e-12);
  }
  EXPECT_NEAR((front[1] - front[0]) / std::log(4.), 0.628, 0.03);
  EXPECT_NEAR((energy[1] - energy[0]) / std::log(4.), -0.116, 0.03);
}

// ---- collapse on a ring

// No ring collapses that is smaller than the number of particles that do in free space, and rings of three times as
// many do.
TEST(CollapseNumber, OfRingsIsThatOfFreeParticlesOrMore) {
  for (const double eps : {.5, .8}) {
    const double onset = *theory::collapse_onset_particles(eps);
    for (const bool few : {true, false}) {
      const auto count = static_cast<ParticleIndex>(few ? std::floor(onset) : 3 * onset);
      int collapsed = 0;
      for (std::uint64_t replica = 0; replica < 20; ++replica) {
        const auto particles = gaussian_ring(count, static_cast<double>(count), 7, 0.4, replica);
        auto run = gap_run(particles, Inelastic<double>(eps), {CollapsePolicy::stop, 1e-12});
        collapsed += run.advance(1e4) == Status::collapsed;
      }
      EXPECT_EQ(collapsed, few ? 0 : 20) << eps << ", " << count << " particles";
    }
  }
}

TEST(CollapseNumber, EstimateOfMcNamaraAndYoung) {
  EXPECT_NEAR(theory::cushion_particles(0.9), 36.9, 0.05);
  EXPECT_NEAR(theory::cushion_particles(0.95), 87.6, 0.05);
  EXPECT_NEAR(theory::cushion_particles(0.99), 599, 0.5);
}

// ---- free cooling

// Of all particles, at this time.
template <class Run> double energy_left(Run& run, const Scene<double>& particles, double t) {
  EXPECT_EQ(run.advance(t), Status::reached);
  return particles->kinetic_energy() - run.energy_lost();
}

// The energy is that of the sticky gas whatever the form of the restitution, even of one that is nearly elastic by
// then.
TEST(FreeCooling, ByRestitutionsOfTheSpeedHasTheEnergyOfTheStickyGas) {
  const auto particles = gaussian_ring(2000, 2000, 3, 0, 1);
  auto sharp = gap_run(particles, Inelastic<double>(0.5, 0.02));
  auto smooth = gap_run(particles, SpeedDependent<double>(0.5, 0.02, 4.));
  auto slow = gap_run(particles, SpeedDependent<double>(0.5, 0.5, 1.));
  for (const double t : {20., 100.}) {
    const double energy = energy_left(sharp, particles, t);
    EXPECT_NEAR(energy / (2000 * 0.2214 * std::pow(t, -2. / 3)), 1.2, 0.2);
    EXPECT_NEAR(energy_left(smooth, particles, t) / energy, 1, 0.02);
    EXPECT_NEAR(energy_left(slow, particles, t) / energy, 1, 0.05);
  }
}

Scene<double> gas(ParticleIndex n, double variance) {
  return std::make_shared<Ring<double>>(n, double(n), std::sqrt(variance), gaussian_velocity(1, 0),
                                        uniform_displacement(0.49, 1, 0));
}

// Near the elastic limit particles hardly change their velocities when they pass, so those stay uncorrelated; but the
// slow ones lose less, and the Gaussian turns into two peaks (McNamara and Young, Phys. Fluids A 5, 34 (1993)), by
// which the energy is 3 % above the law at t = tau. 2 % until 0.3 tau, when 41 % of the energy are gone, N = 1e5.
TEST(FreeCooling, EarlyInelasticGasFollowsHaff) {
  const auto ring = gas(100000, 1);
  const double restitution = 0.99;
  const theory::FreeCooling parameters;
  auto run = gap_run(ring, Inelastic<double>(restitution));
  for (const double part : {0.1, 0.2, 0.3}) {
    const double t = part * theory::haff_time(parameters, restitution),
                 expected = theory::haff_energy_per_particle(parameters, restitution, t) * 2 * ring->kinetic_energy();
    EXPECT_NEAR(energy_left(run, ring, t) / expected, 1, 0.02) << part;
  }
}

// N = 2e4, eps = 0.5, cut-off 0.01 s: within 4 % of the sticky gas (2 % at N = 1e5, with 5 times the clusters).
TEST(FreeCooling, LateInelasticGasIsTheStickyOne) {
  const auto ring = gas(20000, 1);
  auto dry = gap_run(ring, Inelastic<double>(0.5, 0.01));
  StickyGas<double> sticky(ring, 0.0);
  for (const double t : {30.0, 60.0, 100.0})
    EXPECT_NEAR(energy_left(dry, ring, t) / energy_left(sticky, ring, t), 1, 0.04) << t;
}

// N = 2e5, E_loss = 0.3, s^2 = 1/3: over t = 100 to 1000 the exponent is -2/3 within 0.03, the energy some 4 % above
// the sticky gas's.
TEST(FreeCooling, WetGasHasTheStickyExponent) {
  const auto ring = gas(200000, 1.0 / 3);
  Simulation wet(Wet<double>(0.3), ClusterChain<double>(ring, 0.0));
  StickyGas<double> sticky(ring, 0.0);
  double before = 0;
  for (const double t : {100.0, 1000.0}) {
    const double energy = energy_left(wet, ring, t), ratio = energy / energy_left(sticky, ring, t);
    EXPECT_GT(ratio, 1) << t;
    EXPECT_LT(ratio, 1.1) << t;
    if (before > 0) {
      EXPECT_NEAR(std::log10(energy / before), -2.0 / 3, 0.03);
    }
    before = energy;
  }
  EXPECT_THROW(theory::haff_time({}, 1.0), std::domain_error);
}

// By definition the two energies are equal there, and Haff's is the smaller one just after; without a meeting (eps = 0)
// the sticky gas is above all along.
TEST(Collisions, ClusteringIsWhereHaffMeetsTheStickyGas) {
  const theory::FreeCooling parameters{2, 3, 1};
  for (const double eps : {.4, .5, .9, .999}) {
    const double t = theory::clustering_time(parameters, eps);
    const auto ratio = [&](double time) {
      return theory::haff_energy_per_particle(parameters, eps, time) /
             theory::sticky_energy_per_particle(parameters, time);
    };
    EXPECT_NEAR(ratio(t), 1, 1e-12) << eps;
    EXPECT_LT(ratio(1.1 * t), 1) << eps;
  }
  const double t = theory::clustering_time(parameters, 0);
  EXPECT_LT(theory::haff_energy_per_particle(parameters, 0, t), theory::sticky_energy_per_particle(parameters, t));
}

// Equal temperatures: the elastic gas, (N - 1) n s/sqrt(pi), and two walls, each met n s/sqrt(2 pi) times per time.
TEST(Collisions, HeatedWallsOfOneTemperatureAreEquilibrium) {
  const double s = 1.7, n = 3, length = 50;
  EXPECT_NEAR(theory::heated_collision_rate(n * length, length, s, s),
              n * (n * length - 1) * s / std::sqrt(std::acos(-1)) + 2 * n * s / std::sqrt(2 * std::acos(-1)), 1e-11);
}

}  // namespace cradle::test::classics_test
