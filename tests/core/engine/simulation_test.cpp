// The event loop at its limits. Proves: a time that is not finite, or in the past, is refused before anything changes;
// after exceptions from the caller's functions the run continues with the bits of an undisturbed one; times of
// collisions are since the start, and steps stop at the time requested last.
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::simulation_test {

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

static_assert(StreamingChain<GapChain<double>> && !StreamingChain<PositionChain<double>>);

const Inelastic<double> law(0.9, 1e-3);
constexpr double end = 70;

// The twin, which nothing has disturbed, has the bits of the run once it is advanced to the same time.
template <class Run> void expect_undisturbed(const Run& run, Run twin, double t) {
  twin.advance(t);
  expect_same_state(run, twin, t);
  EXPECT_EQ(run.counts().close_calls, twin.counts().close_calls);
}

// ---- refused input

TEST(Simulation, ATimeThatIsNotFiniteIsRefused) {
  auto run = gap_run(rshock<double>(100), law), twin = gap_run(rshock<double>(100), law);
  for (const double t : {nan, infinity, -infinity}) EXPECT_THROW(run.advance(t), std::invalid_argument) << t;
  EXPECT_EQ(message_of([&] { run.advance(nan); }), "the time to advance to is not finite (found nan): give a number");
  EXPECT_EQ(run.counts().collisions, 0U);
  run.advance(40);
  for (const double t : {nan, infinity, -infinity}) EXPECT_THROW(run.advance(t), std::invalid_argument) << t;
  run.advance(end);
  twin.advance(40);
  expect_undisturbed(run, twin, end);
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

TEST(Exceptions, FromProgressAndInterruptLeaveTheRunAsItWouldBe) {
  for (const auto& scene : {rshock<double>(200), rmix<double>(60)})
    for (const bool progress : {true, false}) {
      int calls = 0;
      const auto throw_often = [&] {
        if (++calls % 3 == 1) throw Thrown();
        return false;
      };
      Policy<double> policy;
      if (progress)
        policy.progress = [&](const double&, const Counts&) { throw_often(); };
      else
        policy.interrupt = throw_often;
      auto run = gap_run(scene, law, policy);
      EXPECT_GT(advance_through(run, end), 0);
      expect_undisturbed(run, gap_run(scene, law), end);
    }
}

TEST(Exceptions, FromAnObserverLeaveTheCollisionToBeMade) {
  for (const auto& scene : {rshock<double>(200), lattice_rows(200)}) {
    auto run = gap_run(scene, law);
    std::uint64_t calls = 0, made = 0;
    const int thrown = advance_through(run, end, [&](const Collision<double>&) {
      if (++calls % 7 == 0) throw Thrown();
      ++made;
    });
    EXPECT_GT(thrown, 100);
    EXPECT_EQ(made, run.counts().collisions) << "each is seen once";
    expect_undisturbed(run, gap_run(scene, law), end);
  }
}

TEST(Exceptions, AnObserverIsForgottenWhenItsAdvanceEnds) {
  auto run = gap_run(rshock<double>(200), law), twin = run;
  int seen = 0;
  const auto throw_at_fifth = [&](const Collision<double>&) {
    if (++seen == 5) throw Thrown();
  };
  EXPECT_THROW(run.advance(end, throw_at_fifth), Thrown);
  while (run.step()) continue;
  EXPECT_EQ(seen, 5) << "a reference to it must not be kept";
  expect_undisturbed(run, twin, end);
}

TEST(Exceptions, OfACollapseTheReportIsNotLost) {
  auto run = gap_run<double>(three_particles(), Inelastic(0.05),
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

// ---- sampling times

TEST(Cadence, TheFirstIntervalIsSinceTheStart) {
  const auto particles = list<double>({0, 1, 3, 10}, {1, 0, -1, 5});
  for (const double start : {-100., -3.5, 10., 1000.}) {
    const auto first_interval = [&](auto run) {
      EXPECT_EQ(run.last_collision_time(), start);
      double interval = 0;
      run.advance(start + 1, [&](const Collision<double>& c) { interval = c.interval; });
      return interval;
    };
    EXPECT_EQ(first_interval(gap_run<double>(particles, Inelastic(0.05), {}, start)), 1);
    EXPECT_NEAR(first_interval(position_run<double>(particles, Inelastic(0.05), {}, start)), 1,
                4e-16 * std::abs(start));
  }
}

TEST(Cadence, StepsStopAtTheTimeRequestedLast) {
  auto run = gap_run(rshock<double>(400), Inelastic<double>(0.98, 1e-5)), twin = run;
  run.head_for(300);
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(run.step());
  run.head_for(299.99);
  while (run.step()) continue;
  EXPECT_EQ(run.status(), Status::reached);
  EXPECT_LE(run.last_collision_time(), 299.99);
  expect_undisturbed(run, twin, 299.99);
  EXPECT_FALSE(run.step()) << "there is none before that time";
}

}  // namespace cradle::test::simulation_test
