#pragma once
// Runs that continue from a saved state.

#include <gtest/gtest.h>

#include "cradle/core/engine/state.hpp"

namespace cradle::test {

// Saves a run every `step` and continues it with a new run from make(): the bits must be those of the uninterrupted
// run.
template <class Make, class Check>
void expect_same_from_anywhere(const Make& make, double first, double step, double end, const Check& check) {
  for (double cut = first; cut < end; cut += step) {
    SCOPED_TRACE(cut);
    auto whole = make(), later = make();
    whole.advance(cut);
    SavedState state = SavedState::of(whole);
    const SavedState then = state;
    load(state, later);
    EXPECT_EQ(state.left(), 0U);
    EXPECT_TRUE(SavedState::of(later) == then);
    whole.advance(end);
    later.advance(end);
    EXPECT_TRUE(SavedState::of(later) == SavedState::of(whole));
    check(later, whole);
  }
}

}  // namespace cradle::test
