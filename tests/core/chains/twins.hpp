#pragma once
// Compares two ways of holding the same particles: the runs must have the same bits.

#include <gtest/gtest.h>

#include <vector>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test {

// Queues of different sizes may have different close calls.
enum class CloseCalls { the_same, any };

template <class First, class Second>
void expect_identical(First& first, Second& second, double t, CloseCalls close_calls = CloseCalls::any) {
  SCOPED_TRACE(t);
  ASSERT_EQ(first.advance(t), Status::reached);
  ASSERT_EQ(second.advance(t), Status::reached);
  ASSERT_TRUE(same_collisions(first.counts(), second.counts()));
  ASSERT_EQ(first.counts().origin_moves, second.counts().origin_moves);
  if (close_calls == CloseCalls::the_same) {
    ASSERT_EQ(first.counts().close_calls, second.counts().close_calls);
  }
  ASSERT_EQ(first.energy_lost(), second.energy_lost());
  ASSERT_EQ(first.collided_particles(), second.collided_particles());
  ASSERT_EQ(first.chain().local_time(t), second.chain().local_time(t));
  ASSERT_TRUE(identical(first.configuration(t), second.configuration(t)));
  if (first.collided_particles() == 0) return;
  ASSERT_EQ(first.front_left(t), second.front_left(t));
  ASSERT_EQ(first.front_right(t), second.front_right(t));
}

// Compares output at ten or ten thousand times up to `end` with output at the end only.
template <class Make> void expect_no_influence_of_cadence(const Make& make, double end) {
  auto once = make();
  for (const int outputs : {10, 10000}) {
    auto often = make();
    for (int k = 1; k <= outputs; ++k) {
      const double t = end * k / outputs;
      ASSERT_EQ(often.advance(t), Status::reached);
      if (k % 100 == 0) often.configuration(t);
    }
    expect_identical(once, often, end);
  }
}

// Makes output at the exact time of each collision, found by another run of the same particles.
template <class Once, class Often>
void expect_no_influence_of_output_at_collisions(Once once, Often&& often, double end, std::size_t least_collisions) {
  std::vector<double> times;
  once.advance(end, [&](const Collision<double>& c) { times.push_back(c.time.value()); });
  ASSERT_GE(times.size(), least_collisions);
  for (const double t : times) ASSERT_EQ(often.advance(t), Status::reached);
  expect_identical(once, often, end);
}

template <class Run> void expect_no_influence_of_an_observer(Run plain, Run observed, double end) {
  std::uint64_t seen = 0;
  observed.advance(end, [&](const Collision<double>& c) { seen += c.closing_speed > 0; });
  expect_identical(plain, observed, end, CloseCalls::the_same);
  EXPECT_EQ(seen, observed.counts().collisions);
}

}  // namespace cradle::test
