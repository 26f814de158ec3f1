// The elastic gas (eps = 1), in every scalar type: equal particles exchange velocities, so tracers pass through each
// other freely and everything is known at any time: positions are sort(x_i + v_i t), velocities go with them, the
// collisions made are the inversions of x_i + v_i t. Proves: counts and velocities are exact (velocities of these
// fixtures are sums of exact numbers), positions right to rounding; lattices, and all particles at one point. (In
// rational arithmetic: exact_gas_test.cpp.)
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::elastic_test {

PRECISION_SUITE(Elastic, EveryPrecision);

// Places and velocities of tracers at a time, sorted by place. Those at the same place have just met: the slower one is
// on the left from here on.
template <class T> using Tracers = std::vector<std::pair<T, T>>;
template <class T> Tracers<T> free_flight(const Particles<T>& particles, const T& t, std::uint64_t& inversions) {
  Tracers<T> tracers;
  for (ParticleIndex b = 0; b < particles.count(); ++b)
    tracers.emplace_back(particles.position(b) + particles.velocity(b) * t, particles.velocity(b));
  inversions = 0;
  for (std::size_t j = 0; j < tracers.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) inversions += !(tracers[i].first < tracers[j].first);
  std::sort(tracers.begin(), tracers.end());
  return tracers;
}

// A collision is timed to half an epsilon of the time since the origin moved last, at most t, and moves by it what is
// closing at 2 at most; places are rounded likewise. With up to 200 collisions a particle and four such roundings each:
// 400 t epsilon, of which twice as much is allowed; operations in double-double are off by eight times as much.
template <class Run, class T>
void expect_free_flight(Run run, const Particles<T>& particles, const std::vector<double>& times) {
  for (const double time : times) {
    SCOPED_TRACE(time);
    const T t(time),
        tolerance = T(RoundsToNearest<T> ? 800 : 6400) * T(std::max(time, 200.)) * std::numeric_limits<T>::epsilon();
    std::uint64_t inversions = 0;
    const Tracers<T> free = free_flight(particles, t, inversions);
    ASSERT_EQ(run.advance(t), Status::reached);
    ASSERT_EQ(run.counts().collisions, inversions);
    EXPECT_TRUE(run.energy_lost() == T(0));
    const auto c = configuration_at(run, t);
    for (std::size_t j = 0; j < c.x.size(); ++j) {
      const auto& [x, v] = free[static_cast<std::size_t>(c.index[j])];
      ASSERT_LE(to_double(magnitude(T(c.x[j] - x))), to_double(tolerance)) << "particle " << c.index[j];
      ASSERT_TRUE(c.v[j] == v) << "particle " << c.index[j];
    }
  }
  EXPECT_EQ(run.account().order_lost, 0U);
  EXPECT_EQ(run.account().simultaneous, 0U) << "gaps between those that close are open";
}

PRECISION_TEST(Elastic, MixedVelocitiesSortThemselves) {
  const auto particles = rmix<T>(200);
  const Inelastic<T> law(T(1));
  expect_free_flight(gap_run(particles, law), *particles, {1, 5, 20, 100, 1000, 1e5});
  expect_free_flight(mass_run(particles, law), *particles, {1, 5, 20, 100, 1000, 1e5});
  expect_free_flight(position_run(particles, law), *particles, {1, 5, 20, 100, 1000});
}

PRECISION_TEST(Elastic, PerturbedRowsPassThroughEachOther) {
  const auto particles = rshock<T>(300);
  const Inelastic<T> law(T(1));
  expect_free_flight(gap_run(particles, law), *particles, {.5, 1, 7.25, 50, 140, 300});
  expect_free_flight(position_run(particles, law), *particles, {.5, 1, 7.25, 50, 140, 300});
}

// The same counts with a restitution next to 1, which loses (1 - eps)(1 + eps) w^2/4 a collision, w < 2.
PRECISION_TEST(Elastic, ARestitutionNextToOneMakesTheSameCollisions) {
  constexpr double u = 0x1p-53;
  const auto particles = rmix<T>(200);
  auto run = gap_run(particles, Inelastic<T>(T(1. - u)));
  for (const int t : {5, 20}) {
    std::uint64_t inversions = 0;
    free_flight(*particles, T(t), inversions);
    ASSERT_EQ(run.advance(T(t)), Status::reached);
    EXPECT_EQ(run.counts().collisions, inversions) << t;
  }
  EXPECT_TRUE(run.energy_lost() > T(0));
  EXPECT_LE(to_double(run.energy_lost()), static_cast<double>(run.counts().collisions) * 2 * u);
  EXPECT_EQ(run.account().order_lost, 0U);
}

// x_i = i, v_i = -i: all are at 0 at t = 1, in exact numbers. The tie rule makes some order of the n(n - 1)/2
// collisions, and velocities come out sorted, whichever.
template <class Run> void expect_sorted(Run run, int n) {
  using T = typename Run::Scalar;
  ASSERT_EQ(run.advance(T(2)), Status::reached);
  EXPECT_EQ(run.counts().collisions, static_cast<std::uint64_t>(n * (n - 1) / 2));
  EXPECT_GT(run.account().simultaneous, 0U);
  EXPECT_EQ(run.account().order_lost, 0U);
  const auto c = configuration_at(run, T(2));
  for (int b = 0; b < n; ++b) {
    const auto j = static_cast<std::size_t>(b);
    ASSERT_TRUE(c.v[j] == T(b + 1 - n) && c.x[j] == c.v[j]) << b;
  }
}
PRECISION_TEST(Elastic, AllParticlesMeetAtOnePoint) {
  for (const int n : {3, 4, 10, 61}) {
    std::vector<T> x, v;
    for (int i = 0; i < n; ++i) x.push_back(T(i)), v.push_back(T(-i));
    expect_sorted(gap_run(list(x, v), Inelastic<T>(T(1))), n);
    expect_sorted(position_run(list(x, v), Inelastic<T>(T(1))), n);
  }
}

// Rows on a lattice: at every multiple of l/(2 u0) one more layer meets, and the collisions are triangular numbers.
PRECISION_TEST(Elastic, LatticesMeetInLayers) {
  const Scene<T> lattice = lattice_rows<T>(60);
  const Inelastic<T> law(T(1));
  std::vector<double> times{100};  // when every particle of one row has met every one of the other
  for (int halves = 60; halves > 0; --halves) times.insert(times.begin(), 0.5 * halves);
  expect_free_flight(gap_run(lattice, law), *lattice, times);
  expect_free_flight(gap_run(lattice, law, {}, T(0), {.hold_all = true}), *lattice, times);
  expect_free_flight(position_run(lattice, law), *lattice, times);
}

}  // namespace cradle::test::elastic_test
