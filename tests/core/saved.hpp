#pragma once
// Runs and observers that continue from a saved state.

#include <gtest/gtest.h>

#include <initializer_list>
#include <stdexcept>

#include "cradle/core/base/state.hpp"

namespace cradle::test {

// Saves a run every `step` and continues it with a new run from make(): the bits must be those of the uninterrupted
// run.
template <class Make, class Check>
void expect_same_from_anywhere(const Make& make, double step, double end, const Check& check) {
  for (double cut = 0; cut < end; cut += step) {
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

// The same of an observer, as it is before the first of so many samples; `add(observer, k)` adds number k. The state of
// the complete one must be refused by all of `others`, which have other sizes.
template <class Observer, class Add>
void expect_continues(Observer whole, std::size_t samples, std::size_t cut, const Add& add,
                      std::initializer_list<Observer> others) {
  Observer later = whole;
  for (std::size_t k = 0; k < samples; ++k) {
    if (k == cut) {
      SavedState state = SavedState::of(whole);
      load(state, later);
    }
    add(whole, k);
    if (k >= cut) add(later, k);
  }
  EXPECT_TRUE(SavedState::of(later) == SavedState::of(whole));
  for (Observer other : others) {
    SavedState state = SavedState::of(whole);
    EXPECT_THROW(load(state, other), std::invalid_argument);
  }
}

}  // namespace cradle::test
