#pragma once
// This file puts the numbers of a segment's gaps into a line (line.hpp), where they stand while steps work on them.
// Doubles stay in the segment's own cells, with a copy of the times of collision beside them. Numbers that are sums of
// two doubles (pairs.inl) are copied to arrays, and back when all is done or a collision is made on the cells.

#include <bit>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "cradle/core/laws/law.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

// A type with the operations of pairs.inl that holds two doubles, the greater one first.
template <class T>
concept DoubleDouble = std::is_trivially_copyable_v<T> && sizeof(T) == 2 * sizeof(double) && requires {
  requires T::is_double_double;
};

template <class T> struct StepNumbers;

template <> struct StepNumbers<double> {
  static constexpr bool pairs = false;
  template <class Law> static constexpr bool by_law = Law::bounces_only;

  static double of(double high, double) { return high; }
  static void put(double x, double& high, double&) { high = x; }
  static void enter(double x, double* high, double*, std::size_t i) { high[i] = x; }

  // The last time that steps may reach, so that they make no collision after `stop`.
  static double last(double stop) { return stop; }
  static bool all_made(StepLine&, double) { return true; }

  // Takes so many gaps from the slot `first` on; false where they are for the event loop.
  template <class Cells> static bool take_all(StepLine& line, Cells& cells, Slot first, std::size_t gaps) {
    line.take(&cells.gaps[first], &cells.gaps.lag(first), gaps);
    return true;
  }
  // A gap from its cell, and back. Lags are only read: a collision that is undone leaves them as they were.
  template <class Cells> static bool take(StepLine& line, std::size_t i, const Cells& cells, Slot s) {
    line.due[i] = cells.gaps[s].due;
    return true;
  }
  template <class Cells> static void give(const StepLine&, std::size_t, Cells&, Slot) {}
  static double due(const StepLine& line, std::size_t i) { return line.due[i]; }
};

template <DoubleDouble T> struct StepNumbers<T> {
  static constexpr bool pairs = true;
  template <class Law> static constexpr bool by_law = std::same_as<Law, Inelastic<T>>;

  static T of(double high, double low) { return std::bit_cast<T>(Two{high, low}); }
  static void put(const T& x, double& high, double& low) {
    const Two two = std::bit_cast<Two>(x);
    high = two.high, low = two.low;
  }
  static void enter(const T& x, double* high, double* low, std::size_t i) { put(x, high[i], low[i]); }

  static double last(const T& stop) { return std::nextafter(to_double(stop), -StepLine::never); }
  static bool all_made(StepLine& line, const T& stop) {  // no key is that of `stop`
    line.bound_tiles();
    return line.least_due() > to_double(stop);
  }

  // False where a gap is due before the origin, or at no number.
  template <class Cells> static bool take_all(StepLine& line, const Cells& cells, Slot first, std::size_t gaps) {
    bool all = true;
    line.take_pairs(gaps);
    for (std::size_t i = 0; i < gaps; ++i) {
      all &= take(line, i, cells, first + i);
      enter(cells.gaps.lag(first + i), line.high.lag, line.low.lag, i);
    }
    line.bound_tiles();
    return all;
  }
  template <class Cells> static bool take(StepLine& line, std::size_t i, const Cells& cells, Slot s) {
    const auto& cell = cells.gaps[s];
    enter(cell.gap, line.high.gap, line.low.gap, i);
    enter(cell.closing, line.high.closing, line.low.closing, i);
    enter(cell.time, line.high.time, line.low.time, i);
    enter(cell.lost, line.high.lost, line.low.lost, i);
    enter(is_positive(cell.closing) ? cells.due(s) : of(StepLine::never, 0), line.due, line.low.due, i);
    return line.due[i] >= 0;
  }
  template <class Cells> static void give(const StepLine& line, std::size_t i, Cells& cells, Slot s) {
    auto& cell = cells.gaps[s];
    cell.gap = of(line.high.gap[i], line.low.gap[i]);
    cell.closing = of(line.high.closing[i], line.low.closing[i]);
    cell.time = of(line.high.time[i], line.low.time[i]);
    cell.lost = of(line.high.lost[i], line.low.lost[i]);
  }
  static T due(const StepLine& line, std::size_t i) { return of(line.due[i], line.low.due[i]); }

 private:
  struct Two {
    double high, low;
  };
};

}  // namespace cradle
