// Theory of the sticky shock. Proves: its closed forms fulfil the balances they come from and the paper's weak solution
// (Fig. 1); rows of particles follow them as closely as particles can; a symmetric shock to the particle; the free
// cooling constants.
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/theory/free_cooling.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/core/theory/sticky_shock.hpp"
#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::sticky_shock_test {

using theory::StickyShock;

constexpr double u = std::numeric_limits<double>::epsilon() / 2;
const Wide tiny = pow(Wide(10), -45);  // some hundred roundings of 2^-168

const std::vector<StickyShock<double>> shocks{
    {1, 0.5, 1, -0.5},           {1, 0.5, 1, -0.5, 20, 0},  {2, 0.75, 0.5, -0.25},     {2, 0.75, 0.5, -0.25, 7, 0},
    {0.5, 1, 2, 0.25, 40, 0.25}, {0.25, 0, 4, -1, 3, -0.5}, {1, 0.5, 4, 0, 1000, 0.5}, {4, 0.125, 1, -1, 0.5, 0.125},
};

template <class T> StickyShock<T> in(const StickyShock<double>& s) {
  return {T(s.density_left), T(s.velocity_left), T(s.density_right), T(s.velocity_right), T(s.mass), T(s.velocity)};
}

void expect_zero(const Wide& difference, const Wide& scale) { EXPECT_WITHIN(difference, 0, tiny * scale); }

TEST(StickyShockTheory, KeepsMassMomentumMomentAndEnergy) {
  for (const auto& data : shocks)
    for (const char* text : {"0.001", "1", "37.5", "1e6"}) {
      const auto s = in<Wide>(data);
      const Wide t(text);
      const auto c = theory::sticky_centre(s, t);
      const Wide &l = s.density_left, &r = s.density_right, &u_l = s.velocity_left, &u_r = s.velocity_right;
      const Wide &x = c.position, scale = c.mass * (1 + t) * (1 + t);
      expect_zero(c.from_left - l * (u_l * t - x), scale);
      expect_zero(c.from_right - r * (x - u_r * t), scale);
      expect_zero(c.mass - (s.mass + c.from_left + c.from_right), scale);
      expect_zero(c.mass * c.velocity - (s.mass * s.velocity + u_l * c.from_left + u_r * c.from_right), scale);
      const Wide moment =
          s.mass * s.velocity * t + l * (u_l * u_l * t * t - x * x) / 2 + r * (x * x - u_r * u_r * t * t) / 2;
      expect_zero(c.mass * x - moment, scale);
      const Wide before = s.mass * s.velocity * s.velocity + c.from_left * u_l * u_l + c.from_right * u_r * u_r;
      expect_zero(c.energy_lost - (before - c.mass * c.velocity * c.velocity) / 2, scale);
    }
}

TEST(StickyShockTheory, TendsToItsLateForm) {
  for (const auto& data : shocks) {
    auto s = in<Wide>(data);
    const Wide t("1e30");
    const auto late = theory::sticky_centre(s, t);
    // The central mass is forgotten as m_0/(rho u t), all numbers but m_0 of order 1.
    const Wide forgotten = 100 * (1 + s.mass) / t;
    EXPECT_WITHIN(late.mass / t, theory::late_growth(s), forgotten);
    EXPECT_WITHIN(late.velocity, theory::late_velocity(s), forgotten);
    EXPECT_WITHIN(late.energy_lost / t, theory::late_power(s), forgotten);
    // The Riemann problem: E, Rykov and Sinai 1996, doi 10.1007/BF02101897.
    const Wide left = sqrt(s.density_left), right = sqrt(s.density_right);
    expect_zero(theory::late_growth(s) - left * right * (s.velocity_left - s.velocity_right), Wide(1));
    expect_zero(theory::late_velocity(s) * (left + right) - (left * s.velocity_left + right * s.velocity_right),
                Wide(1));
    s.mass = 0;
    const auto bare = theory::sticky_centre(s, Wide(3));
    expect_zero(bare.mass - 3 * theory::late_growth(s), bare.mass);
    expect_zero(bare.velocity - theory::late_velocity(s), Wide(1));
    expect_zero(bare.position - 3 * theory::late_velocity(s), Wide(1));
    expect_zero(bare.energy_lost - 3 * theory::late_power(s), Wide(1));
  }
}

// Fig. 1: m_0 + 2 t rho_0 u_0 at rest; section IV: m u_0^3/l of energy lost per time, whatever m_0.
TEST(StickyShockTheory, IsTheWeakSolutionOfFig1) {
  for (const double m0 : {0., 1., 20.})
    for (const double t : {0., 0.5, 10., 1e7}) {
      const auto c = theory::sticky_centre(StickyShock<double>{3, 0.25, 3, -0.25, m0, 0}, t);
      EXPECT_NEAR(c.mass, m0 + 1.5 * t, 4 * u * c.mass);
      EXPECT_EQ(c.position, 0);
      EXPECT_EQ(c.velocity, 0);
      EXPECT_NEAR(c.energy_lost, 3 * t / 64, 16 * u * c.energy_lost);
    }
  const theory::InelasticShock<double> shock{.restitution = .99, .particles = 4000};
  const auto c = theory::sticky_centre(StickyShock<double>{1, 0.5, 1, -.5}, 1000.);
  EXPECT_NEAR(theory::initial_energy(shock) - c.energy_lost, theory::sticky_energy(shock, 1000.), 1e-10);
}

TEST(StickyShockTheory, DoublesLoseAFewRoundings) {
  for (const auto& data : shocks)
    for (const double t : {1e-3, 1., 37.5, 1e6}) {
      const auto c = theory::sticky_centre(data, t);
      const auto exact = theory::sticky_centre(in<Wide>(data), Wide(t));
      EXPECT_NEAR(c.mass, static_cast<double>(exact.mass), 8 * u * c.mass);
      EXPECT_NEAR(c.from_left, static_cast<double>(exact.from_left), 24 * u * c.from_left);
      EXPECT_NEAR(c.from_right, static_cast<double>(exact.from_right), 24 * u * c.from_right);
      EXPECT_NEAR(c.velocity, static_cast<double>(exact.velocity), 24 * u);
      EXPECT_NEAR(c.position, static_cast<double>(exact.position), 24 * u * t);
    }
}

TEST(StickyShockTheory, RefusesWhatIsNoShock) {
  EXPECT_THROW(theory::sticky_centre(StickyShock<double>{1, 0, 1, 0}, 1.), std::domain_error);
  EXPECT_THROW(theory::sticky_centre(StickyShock<double>{1, 1, 0, 0}, 1.), std::domain_error);
  EXPECT_THROW(theory::sticky_centre(StickyShock<double>{1, 1, 1, 0, 1, 2}, 1.), std::domain_error);
  EXPECT_THROW(theory::sticky_centre(StickyShock<double>{1, 1, 1, 0, -1, 0}, 1.), std::domain_error);
}

// Particles in the middles of their cells: cumulative moments are those of the continuum at whole numbers of particles.
// There the graphs of the rows are polygons inscribed in parabolas of curvature `spacing`, whose tangent of a given
// slope touches within half a particle of the parabola's and lies spacing/8 above it at most. So the common tangent, of
// slope X, is off by max spacing/(8 M), and each side's count by half a particle and what that makes. Roundings are far
// below.
TEST(StickyShockTheory, RowsOfParticlesFollow) {
  for (const auto& s : shocks) {
    const double left = 1 / s.density_left, right = 1 / s.density_right, closing = s.velocity_left - s.velocity_right;
    const auto rows = std::make_shared<Rows<double>>(
        Row<double>{1000000, s.velocity_left, left}, Row<double>{1000000, s.velocity_right, right},
        s.mass > 0 ? std::optional<CentralParticle<double>>({s.mass, s.velocity}) : std::nullopt, still);
    for (const double t : {20., 333.3, 4567.8, 1e5}) {
      SCOPED_TRACE(testing::Message() << "shock " << &s - shocks.data() << ", t = " << t);
      StickyGas<double> gas(rows, 0);
      gas.advance(t);
      const auto expected = theory::sticky_centre(s, t);
      const auto found = gas.configuration(t);
      const std::size_t at = found.collided_from;
      ASSERT_EQ(found.collided_to, at + 1);
      ASSERT_EQ(at, 1U);  // a free particle beside it
      const double mass = found.m[at], shift = std::max(left, right) / (8 * mass), rounding = 1e-9;
      const double half_left = 0.5 + shift / left, half_right = 0.5 + shift / right;
      EXPECT_NEAR(mass, expected.mass, half_left + half_right + rounding);
      EXPECT_NEAR(static_cast<double>(999999 - found.from), expected.from_left, half_left + rounding);
      EXPECT_NEAR(found.x[at], expected.position, shift + rounding);
      const double slip = std::max(half_left, half_right) * closing / mass;
      EXPECT_NEAR(found.v[at], expected.velocity, slip + rounding);
      EXPECT_NEAR(gas.energy_lost(), expected.energy_lost,
                  (half_left + half_right) * closing * closing / 2 + mass * slip * slip / 2 + rounding * mass);
    }
  }
}

// Row particles k - 1/2 spacings off arrive at (k - 1/2) l/u_0: two floor(u_0 t/l + 1/2) have stuck, on the instant
// too.
TEST(StickyShockTheory, SymmetricRowsToTheParticle) {
  const auto rows = lattice_rows(40000);
  for (const double t : {0., 0.875, 1., 2.5, 3., 100., 20001., 20000.75, 39999.}) {
    StickyGas<double> gas(rows, 0);
    gas.advance(t);
    const auto stuck = 2 * static_cast<ParticleIndex>(std::floor(0.5 * t + 0.5));
    EXPECT_EQ(gas.counts().merges, static_cast<std::uint64_t>(std::max<ParticleIndex>(stuck - 1, 0))) << t;
    // Losses are quotients of whole numbers: one rounding each, of energies that add up to it.
    EXPECT_NEAR(gas.energy_lost(), static_cast<double>(stuck) / 8, u * static_cast<double>(stuck)) << t;
    if (stuck == 0) continue;
    const auto c = gas.configuration(t);
    EXPECT_EQ(c.m[c.collided_from], static_cast<double>(stuck)) << t;
    EXPECT_EQ(c.v[c.collided_from], 0) << t;
    EXPECT_EQ(c.x[c.collided_from], 0) << t;
  }
}

// The sum of independent velocities is a random walk; clusters are the edges of its convex minorant with x^2/(2t)
// added, of size (2 s t)^(2/3) by scaling. With v the variance of Chernoff's distribution, that of argmax (W(z) - z^2),
// there are 8 v edges per unit of z (Groeneboom 1989, doi 10.1007/BF00343738), and a cluster has the energy s^2/6 on
// the average.
TEST(StickyCooling, ConstantsAreMomentsOfChernoffsDistribution) {
  const Wide v("0.263559641299610185775404532");  // from its integral over Airy functions, to 27 digits
  const double clusters = static_cast<double>(Wide(8 * v / pow(Wide(2), Wide(2) / 3)));
  EXPECT_NEAR(theory::sticky_cooling_clusters, clusters, 4 * u);
  EXPECT_NEAR(theory::sticky_cooling_energy, clusters / 6, u);
}

}  // namespace cradle::test::sticky_shock_test
