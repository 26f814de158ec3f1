// Scenes at the limits of the number range. Proves: gaps over 300 decades and masses of 1:1e12 in one chain make the
// same collisions in double as in double-double; with restitutions at and next to 0 and 1, and with collisions at equal
// times, a run ends as it should, without a hang and without a lost order; the velocity cut-off takes effect exactly
// below its value; a light particle between a wall that takes energy and a heavy particle, elastic at low speeds, comes
// to an end in every type, also in types with unlimited exponents.
#include "cradle/core/initial/walled.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::extremes_test {

// The same doubles in every scalar type.
template <class T> Scene<T> in(const Particles<double>& particles) {
  std::vector<double> x, v, m;
  for (ParticleIndex b = 0; b < particles.count(); ++b)
    x.push_back(particles.position(b)), v.push_back(particles.velocity(b)), m.push_back(particles.mass(b));
  return list<T>(numbers<T>(x), numbers<T>(v), numbers<T>(m));
}

void expect_collisions_of_double(double restitution, double cutoff, const Scene<double>& particles, double end,
                                 std::uint64_t least_collisions) {
  using T = double_double;
  auto narrow = mass_run(particles, Inelastic<double>(restitution, cutoff));
  auto wide = mass_run(in<T>(*particles), Inelastic<T>(T(restitution), T(cutoff)));
  EXPECT_EQ(sequence_to(narrow, end), sequence_to(wide, T(end)));
  EXPECT_EQ(narrow.counts().collisions, wide.counts().collisions);
  EXPECT_EQ(narrow.account().order_lost + wide.account().order_lost, 0U);
  EXPECT_GE(narrow.counts().collisions, least_collisions);
}

// Places 1e-300, 1e-290, ... 1, velocities falling from left to right by unequal steps.
TEST(Extremes, GapsOverThreeHundredDecades) {
  std::vector<double> x, v;
  for (int k = 0; k <= 30; ++k) {
    x.push_back(std::pow(10., -300 + 10 * k));
    v.push_back(-k - 0.01 * static_cast<double>(bits_of(k, 3, 31)));
  }
  const Scene<double> particles = list(x, v);
  expect_collisions_of_double(1, 0, particles, 10, 31 * 30 / 2);
  expect_collisions_of_double(0.75, 1e-3, particles, 10, 100);
  // Elastic: all have passed each other and part at once the velocities are sorted.
  auto run = gap_run(particles, Inelastic<double>(1, 0));
  ASSERT_EQ(run.advance(10), Status::reached);
  const auto c = configuration_at(run, 10.);
  EXPECT_TRUE(std::all_of(c.closing_speed.begin(), c.closing_speed.end(), [](double w) { return w < 0; }));
  EXPECT_TRUE(std::all_of(c.gap.begin(), c.gap.end(), [](double g) { return g > 0; }));
}

TEST(Extremes, MassesOfOneToATrillion) {
  for (const double ratio : {1e12, 1e-12}) {
    const auto alternating = [=](ParticleIndex b) { return b % 2 == 0 ? 1 : ratio; };
    expect_collisions_of_double(0.9, 1e-4, as_list(*rmix<double>(40), alternating), 1.25, 5);
  }
}

PRECISION_SUITE(EveryExtreme, EveryPrecision);

template <class T> Scene<T> three(int third_place) {
  return list<T>({T(0), T(1), T(third_place)}, {T(1), T(0), T(-1)});
}

// Next to 0, far below epsilon, the second collision finds a gap that no time resolves, at 0 none: with a cut-off the
// particles part, without one the run reports that it is exhausted.
PRECISION_TEST(EveryExtreme, RestitutionNextToZero) {
  for (const T& restitution : {T(0), from_text<T>(TypeParam::digits > 0 ? "1e-100000000" : "1e-300")}) {
    auto parting = gap_run(three<T>(3), Inelastic<T>(restitution, from_text<T>("1e-5")));
    // Double-double ends at 2^-969: there a gap of 1e-300 ends the run, and the status reports it.
    const bool underflows = restitution > T(0) && restitution < std::numeric_limits<T>::min();
    EXPECT_EQ(parting.advance(T(1000)), underflows ? Status::exhausted : Status::reached);
    EXPECT_TRUE(underflows || parting.counts().below_cutoff > 0);
    EXPECT_EQ(parting.chain().account().order_lost, 0U);
    auto collapsing = gap_run(three<T>(3), Inelastic<T>(restitution, T(0)));
    EXPECT_EQ(collapsing.advance(T(1000)), Status::exhausted);
    EXPECT_EQ(collapsing.chain().account().order_lost, 0U);
    auto stopping = gap_run(three<T>(3), Inelastic<T>(restitution, T(0)), stop_below(T(0)));
    // Below 7 - 4 sqrt 3 the collapse is proved; at 0 the particles stay together, and nothing is left to prove.
    EXPECT_EQ(stopping.advance(T(1000)), restitution > T(0) ? Status::collapsed : Status::exhausted);
  }
}

// Three particles meet at one place at t = 1. By the tie rule the left gap goes first.
PRECISION_TEST(EveryExtreme, ThreeParticlesMeet) {
  auto run = gap_run(three<T>(2), Inelastic<T>(T(1), T(0)));
  std::vector<ParticleIndex> order;
  ASSERT_EQ(run.advance(T(2), [&](const Collision<T>& c) { order.push_back(c.left); }), Status::reached);
  EXPECT_EQ(order, (std::vector<ParticleIndex>{0, 1, 0}));
  for (const char* restitution : {"0", ".05", ".5", ".9"}) {
    auto inelastic = gap_run(three<T>(2), Inelastic<T>(from_text<T>(restitution), from_text<T>("1e-4")));
    EXPECT_EQ(inelastic.advance(T(1000)), Status::reached) << restitution;
    EXPECT_EQ(inelastic.chain().account().order_lost, 0U) << restitution;
  }
}

// The law is elastic for closing speeds below the cut-off, inelastic at it.
PRECISION_TEST(EveryExtreme, CutoffFromBothSides) {
  const T cutoff = from_text<T>("1e-5"), step = cutoff * std::numeric_limits<T>::epsilon() * T(2);
  for (const char* restitution : {".3", ".9"}) {
    const T eps = from_text<T>(restitution);
    const Inelastic<T> law(eps, cutoff);
    const T below = cutoff - step, above = cutoff + step;
    ASSERT_TRUE(below < cutoff && cutoff < above);
    for (const auto& [w, elastic] : {std::pair(below, true), std::pair(cutoff, false), std::pair(above, false)}) {
      auto run = gap_run(list<T>({T(0), T(1)}, {w, T(0)}), law);
      ASSERT_EQ(run.advance(T(1000000)), Status::reached);
      EXPECT_EQ(run.counts().collisions, 1U);
      EXPECT_EQ(run.counts().below_cutoff, elastic ? 1U : 0U);
      // Two unit masses: mu w^2 (1 - eps)(1 + eps)/2, in some ten operations.
      const T lost = elastic ? T(0) : T((T(1) - eps) * (T(1) + eps) * w * w / T(4));
      EXPECT_TRUE(magnitude(T(run.energy_lost() - lost)) <= lost * std::numeric_limits<T>::epsilon() * T(10));
      const T after = run.chain().closing(run.chain().first()), expected = elastic ? T(-w) : T(-eps * w);
      EXPECT_TRUE(magnitude(T(after - expected)) <= w * std::numeric_limits<T>::epsilon() * T(4));
    }
  }
}

PRECISION_SUITE(SlowStandstill, WidePrecision);

PRECISION_TEST(SlowStandstill, EndsARunThatNoLongerAdvances) {
  Wall<T> wall{T(0)};
  wall.restitution = T(1) / T(2);
  const Scene<T> pair = list<T>({T(1), T(2)}, {T(0), T(-1)}, {T(1), T(1000)});
  const auto walled = std::make_shared<Walled<T>>(pair, wall, std::nullopt);
  const SpeedDependent<T> law(T(9) / T(10), T(1) / T(100), T(2));
  Simulation run(law, GapChain<T, IndividualMasses<T>>(walled, T(0)), Policy<T>{});
  EXPECT_EQ(run.advance(T(1000)), Status::exhausted);
  EXPECT_LE(run.counts().collisions, 1200000U);
}

}  // namespace cradle::test::extremes_test
