// Results of other authors in small systems: a blast in a cold gas, dominoes, a splash, collapse on a ring, free
// cooling with a restitution that depends on the speed. Proves: particles follow the published solutions as closely as
// small systems do, and the exponents of a splash are those of Euler's equations. bench/results/classics.md has the
// solutions and larger systems; tests/tools/python/test_plot.py checks the functions that pictures draw them by.
#include <boost/numeric/odeint.hpp>
#include <gtest/gtest.h>

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

// ---- restitution that depends on the speed

// The energy is that of the sticky gas whatever the form of the restitution, even of one that is nearly elastic by
// then.
TEST(SpeedDependentCooling, HasTheEnergyOfTheStickyGas) {
  const auto particles = gaussian_ring(2000, 2000, 3, 0, 1);
  Simulation sharp(Inelastic<double>(0.5, 0.02), GapChain<double>(particles, 0.));
  Simulation smooth(SpeedDependent<double>(0.5, 0.02, 4.), GapChain<double>(particles, 0.));
  Simulation slow(SpeedDependent<double>(0.5, 0.5, 1.), GapChain<double>(particles, 0.));
  const auto left = [&](auto& run, double t) {
    EXPECT_EQ(run.advance(t), Status::reached);
    return (particles->kinetic_energy() - run.energy_lost()) / 2000;
  };
  for (const double t : {20., 100.}) {
    EXPECT_NEAR(left(sharp, t) / (0.2214 * std::pow(t, -2. / 3)), 1.2, 0.2);
    EXPECT_NEAR(left(smooth, t) / left(sharp, t), 1, 0.02);
    EXPECT_NEAR(left(slow, t) / left(sharp, t), 1, 0.05);
  }
}

}  // namespace cradle::test::classics_test
