#pragma once
// Runs of initial states whose particles are streamed in as fronts reach them.

#include "cradle/tests/core/segmented.hpp"

namespace cradle::test {

// A run that is streamed has the bits of one that holds all particles from the beginning, and of one that stops at
// every whole time. Returns the streamed run, at the last of the times.
template <class Make> auto expect_streamed_is_held(const Make& make, const std::vector<double>& times) {
  auto streamed = make(Options()), often = make(Options()), held = make(Options{.hold_all = true});
  for (const double t : times) {
    EXPECT_EQ(streamed.advance(t), Status::reached);
    EXPECT_EQ(held.advance(t), Status::reached);
    EXPECT_TRUE(identical(configuration_at(streamed, t), configuration_at(held, t)));
    EXPECT_EQ(streamed.energy_lost(), held.energy_lost());
  }
  for (double stop = 1; stop <= times.back(); ++stop) EXPECT_EQ(often.advance(stop), Status::reached);
  expect_same_state(streamed, often, times.back());
  return streamed;
}

}  // namespace cradle::test
