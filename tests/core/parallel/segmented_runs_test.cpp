// Runs that use segments for parts of the time. Proves: a run has the bits of the plain loop for anything that comes
// between its time slabs: plain advances, observers, single steps, interrupts, exceptions of the caller and of the
// threads; and it does not use segments if they are not faster. Every build runs part of this under ThreadSanitizer.
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/segmented.hpp"

namespace cradle::test::segmented_runs_test {

const Inelastic<double> law(0.999, 1e-5);
const Segmentation quick{.gaps = 100, .ghosts = 32, .collisions = 1, .anywhere = true};
using GapSegments = Segments<Inelastic<double>, GapChain<double>>;

TEST(Segments, ComeAndGoBetweenAdvances) {
  auto plain = gap_run(rshock<double>(1400), law), mixed = gap_run(rshock<double>(1400), law);
  GapSegments segments(threads(2), quick), others({}, {.gaps = 7, .ghosts = 20, .collisions = 2, .anywhere = true});
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
      made -= mixed.counts().collisions;
      mixed.advance(t, [&](const Collision<double>&) { ++seen; });
      made += mixed.counts().collisions;
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
  EXPECT_GT(segments.statistics().slabs, 5U);
  EXPECT_GT(others.statistics().slabs, 3U);
  EXPECT_GT(seen, 1000U);
  EXPECT_EQ(seen, made);
}

TEST(Segments, PollTheCallerAndContinueAfterAnythingThatIsThrown) {
  struct Thrown {};
  int calls = 0, stopped = 0;
  Policy<double> policy;
  policy.interrupt = [&] { return ++calls % 3 == 0; };
  policy.progress = [&](const double&, const Counts&) {
    if (calls % 5 == 4) throw Thrown();
  };
  auto plain = gap_run(rshock<double>(1400), law), polled = gap_run(rshock<double>(1400), law, policy);
  GapSegments segments({}, quick);
  for (bool over = false; !over;) try {
      over = polled.advance(560, segments) == Status::reached;
      if (!over) ++stopped;
    } catch (const Thrown&) {
      ++calls;
    }
  plain.advance(560);
  expect_same_state(plain, polled, 560.);
  EXPECT_GT(stopped, 20);
  EXPECT_GT(segments.statistics().slabs, 20U);
}

// Small zones, collapses to be found, walls on which particles may rest and short ways are not for segments, however
// many threads there are.
TEST(Segments, DoNotStartWhereTheyWouldNotPay) {
  GapSegments segments(threads(2));
  auto few = gap_run(rshock<double>(400), law);
  few.advance(300, segments);
  auto stops = gap_run<double>(rshock<double>(4000), law, {CollapsePolicy::stop});
  stops.advance(1200, segments);
  EXPECT_GT(stops.collided_particles(), 1000);
  auto rests = gap_run(between(-0.001, rshock<double>(4000), wall(-2001, nullptr, 0.5, 0, 0.01)), law);
  rests.advance(1200, segments);
  EXPECT_GT(rests.collided_particles(), 1000);
  EXPECT_EQ(segments.statistics().slabs + segments.statistics().given_up, 0U);
  auto many = gap_run(rshock<double>(4000), law);
  many.advance(1200, segments);
  EXPECT_GT(segments.statistics().slabs, 10U);
  EXPECT_LT(segments.statistics().given_up, segments.statistics().slabs / 10);
}

// Particles that merge, on two threads.
TEST(Segments, OfARingOfClusters) {
  const SegmentsAs as{{.gaps = 60, .ghosts = 4, .collisions = 2, .anywhere = true}, 2};
  const auto made = expect_same_in_segments<ClusterChain<double>>(gas<double>(700, 700.), Wet<double>(0.02), {as},
                                                                  std::vector{2., 10., 60.});
  EXPECT_GT(made.slabs, 5U);
  EXPECT_GT(made.again, 10U);
}

// Segments may be kept where a run begins again: how they are made does not show.
TEST(Segments, OfTheRunBefore) {
  const Inelastic<double> soft(0.9, 1e-2);
  GapSegments segments({}, quick);
  for (const auto& [before, after] : {std::pair{gaussian_ring(1000, 1000, 1), gaussian_ring(1000, 1000, 2)},
                                      {uniform_rows(3000, 0.2, 1), uniform_rows(3000, 0.2, 2)}}) {
    auto again = gap_run(before, soft), anew = gap_run(after, soft);
    again.advance(30, segments);
    again.begin_again(after);
    again.advance(30, segments), anew.advance(30);
    EXPECT_TRUE(SavedState::of(again) == SavedState::of(anew));
  }
  EXPECT_GT(segments.statistics().slabs, 4U);
}

// A run that was interrupted between two time slabs has no queue; whoever steps on gets one.
TEST(Segments, SingleStepsAfterAnInterrupt) {
  int calls = 0;
  const Policy<double> policy{.interrupt = [&] { return ++calls == 20; }};
  auto plain = gap_run(rshock<double>(1400), law), stepped = gap_run(rshock<double>(1400), law, policy);
  GapSegments segments({}, quick);
  EXPECT_EQ(stepped.advance(560, segments), Status::interrupted);
  EXPECT_GT(segments.statistics().slabs, 0U);
  while (stepped.step()) continue;
  EXPECT_EQ(stepped.status(), Status::reached);
  plain.advance(560);
  expect_same_state(plain, stepped, 560.);
}

// Each collision is observed once, whatever the observer throws.
TEST(Segments, ObserversThatThrowLeaveTheCollisionToBeMade) {
  struct Thrown {};
  auto plain = gap_run(rshock<double>(1400), law), run = gap_run(rshock<double>(1400), law);
  Observed<double> in_plain, in_segments;
  plain.advance(540, in_plain.by(plain));
  GapSegments segments(threads(2), quick);
  std::uint64_t calls = 0, thrown = 0;
  const auto observer = [&, see = in_segments.by(run)](const Collision<double>& c) {
    if (++calls % 7001 == 0) throw Thrown();
    see(c);
  };
  for (bool over = false; !over;) try {
      over = run.advance(540, segments, observer) == Status::reached;
    } catch (const Thrown&) {
      ++thrown;
      EXPECT_EQ(run.counts().collisions, in_segments.collisions());
    }
  EXPECT_TRUE(in_segments == in_plain);
  expect_same_state(plain, run, 540.);
  EXPECT_GT(thrown, 5U);
  EXPECT_GT(segments.statistics().slabs, 10U);
}

TEST(Segments, WhatAThreadThrowsIsThrownOn) {
  GapSegments segments({2,
                        [](std::size_t jobs, const Workers::Work& work) {
                          for_each(ThreadExecutor(2), jobs, [&](std::size_t job, std::size_t worker) {
                            if (job == 1) throw std::bad_alloc();
                            work(job, worker);
                          });
                        }},
                       quick);
  auto plain = gap_run(rshock<double>(1400), law), run = gap_run(rshock<double>(1400), law);
  EXPECT_THROW(run.advance(560, segments), std::bad_alloc);
  GapSegments others({}, quick);
  run.advance(560, others);
  plain.advance(560);
  expect_same_state(plain, run, 560.);
}

}  // namespace cradle::test::segmented_runs_test
