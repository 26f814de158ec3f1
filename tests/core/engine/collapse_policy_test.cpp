// What a run does about inelastic collapse, on three particles whose collapse time t_c is known in closed form
// (McNamara and Young, Phys. Fluids A 4, 496 (1992)). Proves: policy stop settles t_c to 15 digits from collisions that
// a plain clock can still distinguish, two thirds of them where the collapse is slow; without a policy, and in absolute
// positions, the run ends by itself, reports the reason, and counts what it could not resolve. Many particles end where
// a gap is below 2^-100 of the first. (Down to any requested gap: precision/precision_runs_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::collapse_policy_test {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

class CollapsePolicies : public testing::TestWithParam<ThreeCollapse> {
 protected:
  Inelastic<double> law() const { return Inelastic(GetParam().restitution()); }
  double collapse_time() const { return std::stod(GetParam().collapse_time); }
  auto stopping_run(double stop_gap) const {
    return gap_run(three_particles(), law(), {CollapsePolicy::stop, stop_gap, {}});
  }
};
INSTANTIATE_TEST_SUITE_P(ThreeParticles, CollapsePolicies, testing::ValuesIn(three_collapses));

// From a smallest gap of 1 at the start.
TEST(CollapsePolicies, AStopGapSaysByWhatFactorGapsShrink) {
  const GapChain<double> chain(three_particles(), 0.);
  EXPECT_EQ((Policy<double>{CollapsePolicy::stop, 0x1p-900}.followed(chain)), 0x1p900);
  EXPECT_EQ((Policy<double>{CollapsePolicy::stop, 2}.followed(chain)), 1);
  EXPECT_EQ((Policy<double>{CollapsePolicy::cutoff, 0x1p-900}.followed(chain)), 1);
}

TEST_P(CollapsePolicies, PlainClockStandsStillEarly) {
  double t = 0;
  std::uint64_t collisions = 0, moved_last = 0;
  auto run = stopping_run(1e-100);
  run.advance(2, [&](const Collision<double>& collision) {
    ++collisions;
    if (t + collision.interval > t) moved_last = collisions;
    t += collision.interval;
  });
  EXPECT_EQ(moved_last, GetParam().plain_clock_stops);
}

TEST_P(CollapsePolicies, StopSettlesTheCollapseTime) {
  auto run = stopping_run(0);
  ASSERT_EQ(run.advance(1e6), Status::collapsed);
  const CollapseReport<double>& report = run.collapse();
  ASSERT_TRUE(report.settled);
  // Settled by the second collision, after at most six roundings each of a gap, of speeds and of time, none of which
  // acts on t_c by more than a factor 3: t_c = 1 + g/z, g = u = 1 and z > 1 (collapse_ahead.hpp).
  EXPECT_NEAR(report.time.value(), collapse_time(), 2 * epsilon * collapse_time());
  EXPECT_LE(std::abs(report.time.value() - collapse_time()), report.uncertainty);
  EXPECT_LE(report.uncertainty, 27 * epsilon);
  EXPECT_LE(run.counts().collisions, GetParam().plain_clock_stops);
  // Intervals between collisions at the same gap span two collisions.
  const double plus_minus = 1 + GetParam().restitution(), a = plus_minus / 2;
  const double root = std::sqrt(a * a - 4 * GetParam().restitution()), factor = (a - root) / (a + root);
  EXPECT_NEAR(report.ratio, factor * factor, report.ratio_uncertainty + 4 * epsilon * factor * factor);
  EXPECT_LE(report.ratio_uncertainty, 1e3 * epsilon * factor * factor);
  EXPECT_EQ(report.last_collision, run.last_collision_time());
  EXPECT_LE(report.last_collision, report.time.value());
}

TEST_P(CollapsePolicies, WithoutAPolicyTheRunEndsWhereGapsUnderflow) {
  auto run = gap_run(three_particles(), law());
  ASSERT_EQ(run.advance(1e6), Status::exhausted);
  const double underflow = std::numeric_limits<double>::min() / epsilon;
  const auto& chain = run.chain();
  EXPECT_LT(std::min(chain.nearest_gap(chain.first()), chain.nearest_gap(chain.last())), underflow);
  EXPECT_NEAR(run.last_collision_time(), collapse_time(), 2 * epsilon * collapse_time());
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

TEST_P(CollapsePolicies, CutoffLetsTheParticlesPart) {
  // Below the cut-off the three particles are elastic and separate after at most three more collisions: no collapse.
  const Inelastic<double> law(GetParam().restitution(), 1e-12);
  auto run = gap_run(three_particles(), law, {CollapsePolicy::stop});
  ASSERT_EQ(run.advance(1e6), Status::reached);
  EXPECT_GT(run.counts().below_cutoff, 0U);
  EXPECT_LE(run.counts().below_cutoff, 3U);
}

TEST_P(CollapsePolicies, InterruptEndsTheRunAfterTheCurrentCollision) {
  std::uint64_t calls = 0;
  auto run = gap_run(three_particles(), law(), {CollapsePolicy::cutoff, 0, [&] { return ++calls == 5; }});
  ASSERT_EQ(run.advance(1e6), Status::interrupted);
  EXPECT_EQ(calls, 5U);
  EXPECT_GE(run.counts().collisions, 5U);
  const auto made = run.counts().collisions;
  // Continues where it stopped.
  ASSERT_EQ(run.advance(1e6), Status::exhausted);
  EXPECT_GT(run.counts().collisions, made);
}

// Positions near 1 resolve gaps of 1e-16 only: the run must end nonetheless, with an account of it, and no further from
// t_c than it was when positions began to lose the gaps. A collapse time that it gives is right to what it says.
TEST_P(CollapsePolicies, PositionsEndWithAnAccount) {
  auto stopped = position_run(three_particles(), law(), {CollapsePolicy::stop, 0, {}});
  ASSERT_EQ(stopped.advance(1e6), Status::collapsed);
  ASSERT_TRUE(stopped.collapse().settled);
  EXPECT_NEAR(stopped.collapse().time.value(), collapse_time(), stopped.collapse().uncertainty);
  EXPECT_LE(stopped.collapse().uncertainty, 1e6 * epsilon);
  auto run = position_run(three_particles(), law());
  ASSERT_EQ(run.advance(1e6), Status::exhausted);
  const Account<double>& account = run.chain().account();
  EXPECT_GT(account.unresolved, 0U);
  EXPECT_LT(account.first_unresolved.gap, 1e6 * epsilon * 2);
  EXPECT_GT(account.first_unresolved.time, 1);
  EXPECT_LE(account.first_unresolved.time, collapse_time() + 2 * epsilon);
  EXPECT_NEAR(run.last_collision_time(), collapse_time(), collapse_time() - account.first_unresolved.time);
  EXPECT_EQ(account.order_lost, 0U);
}

// A run in positions that starts at another time finds the same collapse later, to the rounding of absolute times.
TEST(CollapsePolicies, PositionsFindTheCollapseWheneverTheRunStarts) {
  const auto particles = list<double>({0, 1, 3, 10}, {1, 0, -1, 5});  // the three on the left collapse
  const auto collapse_from = [&](double start) {
    auto run = position_run<double>(particles, Inelastic<double>(0.05), {.collapse = CollapsePolicy::stop}, start);
    EXPECT_NE(run.advance(start + 100), Status::reached);
    EXPECT_EQ(run.account().order_lost, 0U);
    EXPECT_TRUE(run.collapse().settled);
    return run.collapse();
  };
  const auto first = collapse_from(0);
  for (const double start : {-100., -3.5, 10., 1000.}) {
    const auto later = collapse_from(start);
    EXPECT_NEAR(later.time.value() - start, first.time.value(), first.uncertainty + later.uncertainty) << start;
  }
}

// Three particles at one place at one time, soft enough to collapse: collisions follow each other without end while
// time stands still. The run must notice, whatever the policy.
TEST(CollapsePolicies, TripleCollisionWithoutEndIsNoticed) {
  const auto particles = list<double>({0, 1, 2}, {1, 0, -1});
  for (const CollapsePolicy policy : {CollapsePolicy::cutoff, CollapsePolicy::stop}) {
    auto run = gap_run<double>(particles, Inelastic(0.05), {policy, 0, {}});
    for (int times = 0; times < 5; ++times) {  // it stays exhausted
      EXPECT_EQ(run.advance(2), Status::exhausted);
      EXPECT_EQ(run.last_collision_time(), 1);
    }
    EXPECT_GT(run.chain().account().simultaneous, 0U);
    auto in_positions = position_run<double>(particles, Inelastic(0.05), {policy, 0, {}});
    EXPECT_EQ(in_positions.advance(2), Status::exhausted);
  }
}

// A light particle between two heavy ones: its closing speed tends to the heavy ones' speed over 1 - eps and never
// falls below the cut-off, while the gaps shrink by a constant factor a collision, 1e5 collisions long.
TEST(CollapsePolicies, CutoffDoesNotEndEveryCollapse) {
  auto run = mass_run<double>(three_particles({1e6, 1, 1e6}), Inelastic(0.8, 1e-4));
  EXPECT_EQ(run.advance(2), Status::exhausted);
  EXPECT_EQ(run.counts().below_cutoff, 0U);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

// Many particles collapse in no steady pattern, of which nothing is proved: the run says so, and ends long before the
// range of double; up to 16 follow them to it.
TEST(CollapsePolicies, WhatIsNotProvedEndsWithTheRange) {
  auto run = gap_run(rshock<double>(16), Inelastic<double>(0.5), {CollapsePolicy::stop, 0, {}});
  ASSERT_EQ(run.advance(1e6), Status::exhausted);
  EXPECT_FALSE(run.collapse().settled);
  EXPECT_LT(run.collapse().gap, std::numeric_limits<double>::min());
  EXPECT_GT(run.collapse().gap, 0);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

// Particles squeezed between dense clusters shrink their intervals by 2^40 and more, then part: near the elastic limit
// the run in double and the run in more digits both continue (at t = 63.0 and 67.0 of this scene).
TEST(CollapsePolicies, SqueezedParticlesAreNotTakenForACollapse) {
  auto run = gap_run(rshock<double>(100), Inelastic(0.9), {CollapsePolicy::stop, 0, {}});
  EXPECT_EQ(run.advance(63.5), Status::reached);
}

// Rows of 200 have the particles for a collapse (N_c = 9 and 30), which without this end continues for 1e4 and 8e7 more
// collisions, to the end of the range. It is no proof: `settled` is false. The same, whatever the chain holds, and up
// to there the same as with a gap that is given.
TEST(ManyParticles, EndWithoutAProof) {
  for (const double restitution : {.5, .8}) {
    const Scene<double> rows = uniform_rows(200, .3, 1);
    auto run = gap_run(rows, Inelastic<double>(restitution), {CollapsePolicy::stop, 0, {}});
    ASSERT_EQ(run.advance(1e4), Status::collapsed);
    EXPECT_FALSE(run.collapse().settled);
    const double end = rows->gap(run.collapse().particle) * 0x1p-100;
    EXPECT_GT(run.collapse().gap, 0);
    EXPECT_LT(run.collapse().gap, end);
    auto held = gap_run(rows, Inelastic<double>(restitution), {CollapsePolicy::stop, 0, {}}, 0., {true});
    EXPECT_EQ(held.advance(1e4), Status::collapsed);
    EXPECT_EQ(held.counts().collisions, run.counts().collisions);
    EXPECT_EQ(held.last_collision_time(), run.last_collision_time());
    // A gap that is given is followed.
    auto followed = gap_run(rows, Inelastic<double>(restitution), {CollapsePolicy::stop, end / 1024, {}});
    EXPECT_EQ(followed.advance(1e4), Status::collapsed);
    EXPECT_LT(followed.collapse().gap, end / 1024);
    EXPECT_GT(followed.counts().collisions, run.counts().collisions);
  }
}

// Among 40 particles three collapse as if they were alone: proved, with the time of the three.
TEST(ManyParticles, AProvedCollapseIsFollowedAsBefore) {
  std::vector<double> x{0, 1, 3}, v{1, 0, -1};
  for (int k = 0; k < 37; ++k) x.push_back(1000 + k), v.push_back(0);
  auto run = gap_run(list<double>(x, v), Inelastic<double>(.05), {CollapsePolicy::stop, 0, {}});
  ASSERT_EQ(run.advance(1e6), Status::collapsed);
  EXPECT_TRUE(run.collapse().settled);
  EXPECT_NEAR(run.collapse().time.value(), 12. / 7, run.collapse().uncertainty);
}

// As the manual says: elastic if the collision before is *less* than that time ago. The second collision, of the middle
// particle with the right one, comes just 1 after the first.
TEST(ContactTimePolicy, AnIntervalOfJustThatTimeDissipates) {
  const auto particles = list<double>({0, 1, 1.75}, {1, 0, 0});
  for (const double contact_time : {1., 1 + 0x1p-52}) {
    const ContactTime<double> limited(Inelastic(0.5), contact_time);
    Simulation gaps(limited, GapChain<double>(particles, 0.));
    Simulation positions(limited, PositionChain<double>(particles, 0.));
    const double lost = 0.75 * (1 + (contact_time > 1 ? 0 : 0.75 * 0.75)) / 4;  // (1 - eps^2) w^2/4
    EXPECT_EQ(gaps.advance(2.), Status::reached);
    EXPECT_EQ(positions.advance(2.), Status::reached);
    EXPECT_EQ(gaps.energy_lost(), lost);
    EXPECT_EQ(positions.energy_lost(), lost);
  }
}

}  // namespace cradle::test::collapse_policy_test
