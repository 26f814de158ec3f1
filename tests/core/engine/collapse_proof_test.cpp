// When a run reports a collapse. The systems are three particles, four in the checkerboard pattern, and two and a wall;
// the greatest restitution that collapses is 7 - 4 sqrt 3 or 3 - 2 sqrt 2. Proves: above it no collapse is reported;
// below it the collapse of two gaps is reported, with t_c and the ratio by the closed form and bounds that hold for
// their errors, and none of particles that others reach in time (nor by a law with a cut-off, in
// collapse_policy_test.cpp). A run that no longer advances ends, in types with any range of exponents: the number of
// collisions at one time since the start is bounded. The bound ends a collapse that tends to that time, but not one
// that a cut-off ends below the clock's resolution. Particles of restitution 0 that meet at one time separate by a
// cut-off, after as many collisions as in exact rationals.
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/slow_loop.hpp"

namespace cradle::test::collapse_proof_test {

using Wide = Digits<60>;

const Policy<double> stop{CollapsePolicy::stop};

struct Family {
  const char* name;
  int particles;  // of the pattern; a wall is a mirror
  bool wall;
  friend void PrintTo(const Family& f, std::ostream* out) { *out << f.name; }
};
class Thresholds : public testing::TestWithParam<Family> {
 protected:
  static Wide limit() {
    const Wide two(2), three(3);
    return GetParam().particles == 3 ? Wide(Wide(7) - Wide(4) * sqrt(three)) : Wide(three - two * sqrt(two));
  }
  // In all of them the first collision is at t = 1, of gaps that close at 1, with the others then 1 wide and closing at
  // 1 in proportion to sin(pi k/n).
  static auto run(double restitution) {
    const Inelastic<double> law(restitution);
    if (GetParam().particles == 3) return mass_run(three_particles(), law, stop);
    if (!GetParam().wall) return mass_run(list<double>({0, 1, 3, 4}, {1.5, 0.5, -0.5, -1.5}), law, stop);
    return mass_run(between(0, list<double>({1, 2}, {-0.5, -1.5}), Wall<double>{0, 0, restitution}), law, stop);
  }
  static Wide coupling(const Wide& e) {
    const Wide four(4), two(2);
    return (1 + e) * (GetParam().particles == 3 ? Wide(1 / two) : Wide(sqrt(two) / 2));
  }
  static std::optional<Wide> collapse_time(const Wide& e) {
    const Wide p0 = GetParam().particles == 3 ? Wide(1) : Wide(sqrt(Wide(2)));
    return theory::collapse_time(e, coupling(e), Wide(1), p0, Wide(1), Wide(1 + coupling(e) * p0));
  }
};
INSTANTIATE_TEST_SUITE_P(Collapse, Thresholds,
                         testing::Values(Family{"three", 3, false}, Family{"four", 4, false}, Family{"wall", 4, true}));

TEST_P(Thresholds, NoneIsReportedThatIsNone) {
  for (int power = 3; power <= 9; ++power)
    for (const int side : {-1, 1}) {
      const double e = static_cast<double>(Wide(limit() + side * pow(Wide(10), -power)));
      const auto exact = collapse_time(Wide(e));
      ASSERT_EQ(exact.has_value(), side < 0);
      auto run = Thresholds::run(e);
      const Status status = run.advance(1e6);
      SCOPED_TRACE(testing::Message() << "eps " << e << ", side " << side << ", 1e-" << power);
      EXPECT_EQ(status == Status::collapsed, run.collapse().settled);
      if (side > 0) {
        EXPECT_NE(status, Status::collapsed);
        EXPECT_TRUE(power > 3 || status == Status::reached) << "all of them part";
      }
      if (side > 0 || (GetParam().particles == 4 && !GetParam().wall)) continue;  // three gaps have no proof
      ASSERT_EQ(status, Status::collapsed);
      const auto& found = run.collapse();
      const Wide off = abs(Wide(found.time.high) + Wide(found.time.low) - *exact);
      EXPECT_LE(off, Wide(found.uncertainty));
      EXPECT_LE(found.uncertainty, 1e-11);
      const auto rates = theory::collapse_rates(Wide(e), coupling(Wide(e)));
      const Wide factor = rates->minus / rates->plus;
      EXPECT_LE(abs(Wide(found.ratio) - factor * factor), Wide(found.ratio_uncertainty));
      EXPECT_LE(found.ratio_uncertainty, 1e-6);
    }
}

TEST(CollapseProof, TheFindingOfARestitutionJustAboveTheLimit) {
  for (const double e : {.0717968, .071797}) {
    auto run = gap_run(three_particles(), Inelastic<double>(e), stop);
    EXPECT_EQ(run.advance(1e6), Status::exhausted) << "it parts after thousands of collisions";
    EXPECT_FALSE(run.collapse().settled);
  }
}

// A fourth particle reaches the three before they collapse at t = 12/7, or does not.
TEST(CollapseProof, OthersMayNotComeInTime) {
  for (const double speed : {-30., -1.}) {
    auto run = gap_run(list<double>({0, 1, 3, 6}, {1, 0, -1, speed}), Inelastic<double>(0.05), stop);
    ASSERT_EQ(run.advance(1e6), Status::collapsed);
    const auto& found = run.collapse();
    if (speed == -1)
      EXPECT_NEAR(found.time.value(), 12. / 7, found.uncertainty);
    else
      EXPECT_GT(std::abs(found.time.value() - 12. / 7), 1e-3);
  }
}

// ---- runs that no longer advance

// Reviews at which offsets from a moving origin advance, and the time since the start does not.
std::uint64_t collisions_until_it_ends(std::uint64_t active, double followed = 1) {
  Standstill<double> standstill(0, false, followed);
  double local = 1;
  for (std::uint64_t collisions = 1; collisions < 3000000; ++collisions, local *= 1.00001)
    if (standstill.at(local, 1, collisions, active)) return collisions;
  return 0;
}

TEST(Standstill, CollisionsAtOneTimeHaveABound) {
  EXPECT_EQ(collisions_until_it_ends(2), 1U + (1U << 20) + 4096U * 4U + 1U);
  EXPECT_EQ(collisions_until_it_ends(3), 1U + (1U << 20) + 4096U * 9U + 1U);
  EXPECT_EQ(collisions_until_it_ends(1000), 0U) << "many particles may have billions";
  EXPECT_EQ(collisions_until_it_ends(2, 1e300), collisions_until_it_ends(2)) << "also on the way to a small gap";
  Standstill<Wide> far(Wide(0), false, ldexp(Wide(1), 40000));
  const std::uint64_t bound = 3 * ((1U << 20) + 4096U * 4U);
  EXPECT_FALSE(far.at(Wide(1), Wide(1), 0, 2));
  EXPECT_FALSE(far.at(Wide(2), Wide(1), bound, 2));
  EXPECT_TRUE(far.at(Wide(3), Wide(1), bound + 1, 2)) << "more on the way to a gap 2^40000 times smaller";
}

TEST(Standstill, IsOverWhereTheTimeSinceTheStartAdvances) {
  Standstill<double> standstill(0);
  constexpr std::uint64_t million = 1000000;
  EXPECT_FALSE(standstill.at(1, 1, million, 2));
  EXPECT_FALSE(standstill.at(2, 1, 2 * million, 2));
  standstill.epoch_ended(0, 1.5, 2 * million);
  EXPECT_FALSE(standstill.at(3, 1.5, 3 * million, 2));
  EXPECT_TRUE(standstill.at(4, 1.5, 3 * million + (1 << 20), 2));
}

// Epochs end where the type resolves no shorter ones. When the next review comes is then the same whether collisions
// are made in segments, which ask for it once more, or not.
TEST(Pacing, EpochsEndWhereTimesUnderflow) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  constexpr std::uint64_t active = 1024, many = std::uint64_t{1} << 40;
  Pacing<double> pacing(0, false);
  pacing.reviewed(1, least, 0, active, true);
  EXPECT_TRUE(pacing.in_epochs);
  EXPECT_EQ(pacing.epoch, 64 * least);
  pacing.epoch_ended(many, 0, active);
  EXPECT_TRUE(pacing.in_epochs);
  pacing.epoch_ended(2 * many, 0, active);
  EXPECT_FALSE(pacing.in_epochs);
  const std::uint64_t next = pacing.next_review;
  pacing.set_next_review(2 * many, active);
  EXPECT_EQ(pacing.next_review, next);
}

// Three particles whose speeds fall to 1e-280 at t = 12/7, 700 collisions long, and who then part.
TEST(Standstill, ACutOffBelowTheClocksResolutionIsReached) {
  auto run = gap_run(three_particles(), Inelastic<double>(0.05, 1e-110));
  EXPECT_EQ(run.advance(100), Status::reached);
  EXPECT_GT(run.counts().below_cutoff, 0U);
}

// Ten particles that meet at one time and stay in touch: 9 to 0.001 evened out by collisions from the left. In exact
// numbers they end; more of them than particles without a threshold may have.
template <class T> std::uint64_t collisions_where_all_meet(int particles) {
  std::vector<T> x, v;
  for (int particle = 0; particle < particles; ++particle) x.push_back(T(particle)), v.push_back(T(-particle));
  auto run = gap_run(list<T>(x, v), Inelastic<T>(T(0), T(1) / T(1000)));
  EXPECT_EQ(run.advance(T(2)), Status::reached);
  EXPECT_EQ(run.last_collision_time(), T(1));
  return run.counts().collisions;
}
TEST(Standstill, ParticlesInTouchPartByACutOff) {
  EXPECT_EQ(collisions_where_all_meet<double>(5), collisions_where_all_meet<Rational>(5));
  EXPECT_GT(collisions_where_all_meet<double>(10), 64U + 4U * 100U);
  auto without = gap_run(list<double>({0, 1, 2}, {0, -1, -2}), Inelastic<double>(0));
  EXPECT_EQ(without.advance(2), Status::exhausted) << "they never do";
}

// ---- the nearest gap

// The smaller gap beside a collision, which is used to detect collapse: in every chain it is the smaller of the gaps
// between the colliding particles and their neighbours, also after a merger, when the cell of the collision holds the
// gap on the right.

// Particles 1 and 2 meet at t = 1, at 2: the neighbours, at rest, are 7 and 3 away, and 1/4 beyond the right one is
// another.
Scene<double> five_particles() { return list<double>({-5, 1, 3, 5, 5.25}, {0, 1, -1, 0, 0}); }

template <class Law, class Chain> double beside_first_collision(Law law, Chain chain) {
  SlowLoop loop(law, chain);
  return loop.collide(loop.next().value()).nearest_gap;
}

TEST(NearestGap, AfterABounceOrAPass) {
  EXPECT_EQ(beside_first_collision(Inelastic<double>(0.5), GapChain<double>(five_particles(), 0.)), 3);
  EXPECT_EQ(beside_first_collision(Inelastic<double>(0.5), PositionChain<double>(five_particles(), 0.)), 3);
  EXPECT_EQ(beside_first_collision(Inelastic<double>(0.5), ClusterChain<double>(five_particles(), 0.)), 3);
  EXPECT_EQ(beside_first_collision(Wet<double>(0.125), ClusterChain<double>(five_particles(), 0.)), 3);
}

TEST(NearestGap, AfterAMerger) {
  EXPECT_EQ(beside_first_collision(Sticky<double>{}, ClusterChain<double>(five_particles(), 0.)), 3);
  // At an end of the line there is the one neighbour; with none, nothing is near.
  const auto three = list<double>({0, 1, 3}, {1, 0, 0}), two = list<double>({0, 1}, {1, 0});
  EXPECT_EQ(beside_first_collision(Sticky<double>{}, ClusterChain<double>(three, 0.)), 2);
  EXPECT_EQ(beside_first_collision(Sticky<double>{}, ClusterChain<double>(two, 0.)), far_away<double>());
}

}  // namespace cradle::test::collapse_proof_test
