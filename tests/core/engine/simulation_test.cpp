// The event loop at its limits. Proves: a time that is not finite, or in the past, is refused before anything changes;
// after exceptions from the caller's functions the run continues with the bits of an undisturbed one; no counter and no
// time depends on how often a run is sampled, even with simultaneous collisions.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/texts.hpp"

namespace simulation_test {

using namespace cradle;
using namespace cradle::test;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A chain takes the laws that it can follow, and no others.
static_assert(CollidesBy<GapChain<double>, ContactTime<double>> &&
              CollidesBy<PositionChain<double>, Inelastic<double>>);
static_assert(!CollidesBy<GapChain<double>, Wet<double>> && !CollidesBy<PositionChain<double>, Sticky<double>>);
static_assert(CollidesBy<ClusterChain<double>, Inelastic<double>>);
static_assert(!CollidesBy<ClusterChain<double>, ContactTime<double>>);
static_assert(StreamingChain<GapChain<double>> && !StreamingChain<PositionChain<double>>);

const Inelastic<double> law(0.9, 1e-3);
constexpr double end = 70;

template <class Run> void expect_identical(const Run& a, const Run& b, double t) {
  EXPECT_TRUE(identical(configuration_at(a, t), configuration_at(b, t)));
  EXPECT_TRUE(identical(a.counts(), b.counts()));
  EXPECT_EQ(a.energy_lost(), b.energy_lost());
  EXPECT_EQ(a.last_collision_time(), b.last_collision_time());
  EXPECT_EQ(a.account().simultaneous, b.account().simultaneous);
  EXPECT_EQ(a.account().order_lost, b.account().order_lost);
}

// ---- refused input

TEST(Simulation, ATimeThatIsNotFiniteIsRefused) {
  auto run = gap_run(rshock<double>(100), law), twin = gap_run(rshock<double>(100), law);
  for (const double t : {nan, infinity, -infinity}) EXPECT_THROW(run.advance(t), std::invalid_argument) << t;
  EXPECT_EQ(run.counts().collisions, 0U);
  run.advance(40);
  for (const double t : {nan, infinity, -infinity}) EXPECT_THROW(run.advance(t), std::invalid_argument) << t;
  run.advance(end);
  twin.advance(40);
  twin.advance(end);
  expect_identical(run, twin, end);
}

TEST(Simulation, ATimeBeforeTheLastCollisionIsRefused) {
  auto run = gap_run(rshock<double>(100), law);
  EXPECT_THROW(run.advance(-1), std::invalid_argument) << "before the start";
  run.advance(40);
  const auto collisions = run.counts().collisions;
  EXPECT_THROW(run.advance(20), std::invalid_argument);
  EXPECT_EQ(run.advance(run.last_collision_time()), Status::reached);
  EXPECT_EQ(run.advance(40), Status::reached);
  EXPECT_EQ(run.counts().collisions, collisions);
}

TEST(Simulation, TheMessageSaysWhatWasFoundAndWhatToDo) {
  auto run = gap_run(rshock<double>(100), law);
  EXPECT_EQ(message_of([&] { run.advance(nan); }), "the time to advance to is not finite (found nan): give a number");
}

TEST(Simulation, DataThatIsNotFiniteIsRefused) {
  const std::vector<double> at{0, 1, 3}, speeds{1, 0, -1};
  for (const double wrong : {nan, infinity, -infinity})
    for (const std::size_t particle : {0U, 1U, 2U}) {
      auto x = at, v = speeds;
      x[particle] = wrong;
      EXPECT_THROW(gap_run(list(x, speeds), law), std::invalid_argument) << wrong;
      EXPECT_THROW(position_run(list(x, speeds), law), std::invalid_argument) << wrong;
      v[particle] = wrong;
      EXPECT_THROW(gap_run(list(at, v), law), std::invalid_argument) << wrong;
      EXPECT_THROW(position_run(list(at, v), law), std::invalid_argument) << wrong;
      EXPECT_THROW(Simulation(Wet<double>(0.1), ClusterChain<double>(list(at, v), 0.)), std::invalid_argument) << wrong;
    }
}

TEST(Simulation, ExactArithmeticIsAlwaysFinite) {
  auto run = gap_run<Rational>(list<Rational>({0, 1, 3}, {1, 0, -1}), Inelastic<Rational>(Rational(1, 2), Rational(0)));
  EXPECT_EQ(run.advance(Rational(1)), Status::reached);
  EXPECT_EQ(run.last_collision_time(), Rational(1));
}

// ---- exceptions

struct Thrown : std::runtime_error {
  Thrown() : std::runtime_error("thrown by the caller") {}
};

// Continues after every exception.
template <class Run, class... Observer> int advance_through(Run& run, double until, Observer&&... observer) {
  for (int thrown = 0;; ++thrown) try {
      EXPECT_EQ(run.advance(until, observer...), Status::reached);
      return thrown;
    } catch (const Thrown&) {
    }
}

TEST(Exceptions, FromProgressLeaveTheRunAsItWouldBe) {
  for (const auto& scene : {rshock<double>(200), rmix<double>(60)}) {
    int calls = 0;
    auto run = gap_run<double>(scene, law, {CollapsePolicy::cutoff, 0, {}, [&](const double&, const Counts&) {
                                              if (++calls % 3 == 1) throw Thrown();
                                            }});
    auto twin = gap_run(scene, law);
    twin.advance(end);
    EXPECT_GT(advance_through(run, end), 0);
    expect_identical(run, twin, end);
  }
}

TEST(Exceptions, FromInterruptLeaveTheRunAsItWouldBe) {
  for (const auto& scene : {rshock<double>(200), rmix<double>(60)}) {
    int calls = 0;
    auto run = gap_run<double>(scene, law, {CollapsePolicy::cutoff, 0, [&]() -> bool {
                                              if (++calls % 2 == 1) throw Thrown();
                                              return false;
                                            }});
    auto twin = gap_run(scene, law);
    twin.advance(end);
    EXPECT_GT(advance_through(run, end), 0);
    expect_identical(run, twin, end);
  }
}

TEST(Exceptions, FromAnObserverLeaveTheCollisionToBeMade) {
  for (const auto& scene : {rshock<double>(200), lattice_rows(200)}) {
    auto run = gap_run(scene, law), twin = gap_run(scene, law);
    std::uint64_t calls = 0, made = 0;
    const int thrown = advance_through(run, end, [&](const Collision<double>&) {
      if (++calls % 7 == 0) throw Thrown();
      ++made;
    });
    EXPECT_GT(thrown, 100);
    EXPECT_EQ(made, run.counts().collisions) << "each is seen once";
    twin.advance(end);
    expect_identical(run, twin, end);
  }
}

TEST(Exceptions, AnObserverIsForgottenWhenItsAdvanceEnds) {
  auto run = gap_run(rshock<double>(200), law), twin = gap_run(rshock<double>(200), law);
  int seen = 0;
  EXPECT_THROW(run.advance(end,
                           [&](const Collision<double>&) {
                             if (++seen == 5) throw Thrown();
                           }),
               Thrown);
  while (run.step()) {
  }
  EXPECT_EQ(seen, 5) << "a reference to it must not be kept";
  twin.advance(end);
  expect_identical(run, twin, end);
}

TEST(Exceptions, OfACollapseTheReportIsNotLost) {
  auto run = gap_run<double>(list<double>({0, 1, 3}, {1, 0, -1}), Inelastic(0.05),
                             {CollapsePolicy::stop, 0, {}, [](const double&, const Counts&) { throw Thrown(); }});
  Status status = Status::reached;
  for (bool over = false; !over;) try {
      status = run.advance(1e6);
      over = true;
    } catch (const Thrown&) {
    }
  EXPECT_EQ(status, Status::collapsed);
  EXPECT_NEAR(run.collapse().time.value(), 12. / 7, 1e-15);
}

TEST(Simulation, AnExhaustedRunStaysExhausted) {
  auto run = gap_run<double>(list<double>({0, 1, 2}, {1, 0, -1}), Inelastic(0.05));
  for (int times = 0; times < 5; ++times) {
    EXPECT_EQ(run.advance(2), Status::exhausted);
    EXPECT_EQ(run.last_collision_time(), 1);
  }
}

// ---- independence of the sampling times

// Two rows on a lattice: collisions are simultaneous all the time. Asked at every time of a collision, and at even
// steps.
template <class Make> void expect_independent_of_cadence(Make make) {
  constexpr double until = 60;
  auto once = make();
  std::vector<double> times;
  once.advance(until, [&](const Collision<double>& c) { times.push_back(c.time.value()); });
  ASSERT_GT(once.counts().close_calls, 100U);
  auto at_collisions = make(), at_steps = make();
  for (const double t : times) ASSERT_EQ(at_collisions.advance(t), Status::reached);
  for (double t = 0; t < until; t += 0.25) ASSERT_EQ(at_steps.advance(t), Status::reached);
  at_collisions.advance(until);
  at_steps.advance(until);
  expect_identical(once, at_collisions, until);
  expect_identical(once, at_steps, until);
}
TEST(Cadence, NoCounterDependsOnIt) {
  for (const double restitution : {1., .98})
    expect_independent_of_cadence([=] { return gap_run(lattice_rows(200), Inelastic<double>(restitution, 1e-5)); });
}
TEST(Cadence, NoCounterDependsOnItInPositions) {
  expect_independent_of_cadence([] { return position_run(lattice_rows(200), Inelastic<double>(0.98, 1e-5)); });
}
TEST(Cadence, NoCounterDependsOnItWhereParticlesPassAndMerge) {
  expect_independent_of_cadence(
      [] { return Simulation(Wet<double>(0.001), ClusterChain<double>(lattice_rows(200), 0.)); });
}

TEST(Cadence, TheLastCollisionTimeIsThatOfTheLastCollision) {
  auto run = gap_run(rshock<double>(200), law);
  double seen = 0;
  EXPECT_EQ(run.last_collision_time(), 0);
  for (const double t : {10.3, 10.4, 31., 60.}) {
    ASSERT_EQ(run.advance(t, [&](const Collision<double>& c) { seen = c.time.value(); }), Status::reached);
    EXPECT_EQ(run.last_collision_time(), seen);
    EXPECT_GT(seen, t - 1);
  }
}

TEST(Cadence, TheFirstIntervalIsSinceTheStart) {
  const auto particles = list<double>({0, 1, 3, 10}, {1, 0, -1, 5});
  const auto first_interval = [](auto run) {
    EXPECT_EQ(run.last_collision_time(), 10);
    double interval = 0;
    run.advance(11, [&](const Collision<double>& c) { interval = c.interval; });
    return interval;
  };
  EXPECT_EQ(first_interval(gap_run<double>(particles, Inelastic(0.05), {}, 10)), 1);
  EXPECT_EQ(first_interval(position_run<double>(particles, Inelastic(0.05), {}, 10)), 1);
}

TEST(Cadence, StepsStopAtTheTimeRequestedLast) {
  auto run = gap_run(rshock<double>(400), Inelastic<double>(0.98, 1e-5)), twin = run;
  run.head_for(300);
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(run.step());
  run.head_for(299.99);
  while (run.step()) {
  }
  EXPECT_EQ(run.status(), Status::reached);
  EXPECT_LE(run.last_collision_time(), 299.99);
  twin.advance(299.99);
  expect_identical(run, twin, 299.99);
  EXPECT_FALSE(run.step()) << "there is none before that time";
}

}  // namespace simulation_test
