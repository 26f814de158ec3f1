// One run in segments. Proves: whatever the cuts, ghosts, windows and threads, a run has the bits of the plain loop, at
// every time that it stops at; with laws, masses, lines, rows and rings, contacts at the same time, collapsed cores and
// windows that fail at every cut; and whatever comes between: plain advances, observers, interrupts, exceptions.
#include <gtest/gtest.h>

#include "cradle/tests/core/segmented.hpp"

namespace segments_test {

using namespace cradle;
using namespace cradle::test;

template <class T> std::vector<Inelastic<T>> laws() {
  const auto law = [](int restitution, int cutoff) {
    return Inelastic<T>(T(restitution) / T(1000), cutoff > 0 ? T(1) / T(cutoff) : T(0));
  };
  return {law(1000, 0), law(999, 100000), law(900, 8), law(300, 2)};
}

template <class T, class Masses> void expect_same(const Scene<T>& scene, const std::vector<T>& times) {
  WindowsMade all;
  for (const Inelastic<T>& law : laws<T>())
    for (const SegmentsAs& as : segmentations()) {
      SCOPED_TRACE("eps = " + std::to_string(to_double(law.restitution())) + ", " + std::to_string(as.how.gaps) +
                   " gaps, " + std::to_string(as.how.ghosts) + " ghosts, " + std::to_string(as.threads) + " threads");
      all += expect_same_in_segments<T, Masses>(scene, law, as, times);
    }
  EXPECT_GT(all.windows, 400U);
  EXPECT_GT(all.again, 5000U) << "cuts that fail are part of what is to be shown";
}

// ---- law x initial state x masses x type x segmentation: 360 runs, every one compared at several times

template <class T> class Cells : public ::testing::Test {};
using Types = ::testing::Types<double, long double, float>;
TYPED_TEST_SUITE(Cells, Types);

TYPED_TEST(Cells, RowsThatAreStreamed) {
  using T = TypeParam;
  expect_same<T, IdenticalMasses<T>>(rshock<T>(1400), {T(0), T(520), T(521), T(560)});
}
TYPED_TEST(Cells, GasOnALine) {
  using T = TypeParam;
  expect_same<T, IdenticalMasses<T>>(gas<T>(800), {T(1), T(100), T(160)});
}
TYPED_TEST(Cells, GasOnARing) {
  using T = TypeParam;
  expect_same<T, IdenticalMasses<T>>(gas<T>(700, T(700)), {T(10), T(50)});
}
TYPED_TEST(Cells, UnequalMassesOnALine) {
  using T = TypeParam;
  expect_same<T, IndividualMasses<T>>(gas<T>(700, T(0), true), {T(10), T(100)});
}
TYPED_TEST(Cells, UnequalMassesOnARing) {
  using T = TypeParam;
  expect_same<T, IndividualMasses<T>>(gas<T>(700, T(700), true), {T(10), T(40)});
}
// Contacts are simultaneous all over the line; the windows that hold such are for the plain loop, or for exact times.
TYPED_TEST(Cells, LatticesFullOfTies) {
  using T = TypeParam;
  const auto nowhere = [](BodyIndex) { return std::int64_t{0}; };
  expect_same<T, IdenticalMasses<T>>(std::make_shared<Rows<T>>(symmetric_rows<T>(1200, T(1) / T(2), T(1), nowhere)),
                                     {T(520), T(550), T(551)});
}

// ---- runs that change over

const Inelastic<double> law(.999, 1e-5);
const Segmentation quick{.gaps = 100, .ghosts = 32, .contacts = 1, .anywhere = true};
using GapSegments = Segments<double, Inelastic<double>, IdenticalMasses<double>>;

TEST(Segments, ComeAndGoBetweenAdvances) {
  auto plain = gap_run(rshock<double>(1400), law), mixed = gap_run(rshock<double>(1400), law);
  GapSegments segments(threads(2), quick), others({}, {.gaps = 7, .ghosts = 20, .contacts = 2, .anywhere = true});
  std::uint64_t seen = 0, made = 0;
  for (double t = 480; t < 560; t += 5) {
    switch (static_cast<int>(t / 5) % 5) {
    case 0:
      mixed.advance(t);
      break;
    case 1:
      mixed.advance(t, segments);
      break;
    case 2:
      made -= mixed.counts().contacts;
      mixed.advance(t, [&](const Contact<double>&) { ++seen; });
      made += mixed.counts().contacts;
      break;
    case 3:
      mixed.advance(t, others);
      break;
    default:
      mixed.head_for(t);
      while (mixed.step()) continue;
    }
    plain.advance(t);
    expect_same_state(plain, mixed, t);
  }
  EXPECT_GT(segments.statistics().windows, 5U);
  EXPECT_GT(others.statistics().windows, 5U);
  EXPECT_GT(seen, 1000U);
  EXPECT_EQ(seen, made);
}

TEST(Segments, AskTheCallerAndGoOnAfterAnythingThatIsThrown) {
  struct Thrown {};
  int asked = 0, stopped = 0;
  Policy<double> policy;
  policy.interrupt = [&] { return ++asked % 3 == 0; };
  policy.progress = [&](const double&, const Counts&) {
    if (asked % 5 == 4) throw Thrown();
  };
  auto plain = gap_run(rshock<double>(1400), law), asking = gap_run(rshock<double>(1400), law, policy);
  GapSegments segments({}, quick);
  for (bool over = false; !over;) try {
      over = asking.advance(560, segments) == Status::reached;
      if (!over) ++stopped;
    } catch (const Thrown&) {
      ++asked;
    }
  plain.advance(560);
  expect_same_state(plain, asking, 560.);
  EXPECT_GT(stopped, 20);
  EXPECT_GT(segments.statistics().windows, 20U);
}

// Small zones, collapses to be found and short ways are not for segments, however many threads there are.
TEST(Segments, DoNotStartWhereTheyWouldNotPay) {
  GapSegments segments(threads(2));
  auto few = gap_run(rshock<double>(400), law);
  few.advance(300, segments);
  auto stops = gap_run<double>(rshock<double>(4000), law, {CollapsePolicy::stop});
  stops.advance(1200, segments);
  EXPECT_GT(stops.collided_bodies(), 1000);
  EXPECT_EQ(segments.statistics().windows + segments.statistics().given_up, 0U);
  auto many = gap_run(rshock<double>(4000), law);
  many.advance(1200, segments);
  EXPECT_GT(segments.statistics().windows, 10U);
  EXPECT_LT(segments.statistics().given_up, segments.statistics().windows / 10);
}

// ---- the paper's shock through its collapse: every contact beyond t = 6500 in a core of a few dozen bodies

TEST(SlowSegments, Figure2ThroughItsCollapse) {
  const auto made = expect_same_in_segments<double, IdenticalMasses<double>>(
      rshock<double>(8000), law, {{.gaps = 1500, .ghosts = 48}, 2}, {6000., 6500., 6550.});
  EXPECT_GT(made.windows, 1000U);
}

}  // namespace segments_test
