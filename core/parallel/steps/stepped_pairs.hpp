#pragma once
// How a segment in double-double uses steps (steps.hpp): as one in double does (stepped.hpp), but for numbers that are
// sums of two doubles. Collisions at cuts, fronts and walls are the part's own, made on its own cells.

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cradle/core/chains/masses.hpp"
#include "cradle/core/engine/status.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/parallel/gap_segment.hpp"
#include "cradle/core/parallel/steps/steps.hpp"

namespace cradle {

// A type with the operations of pairs.inl that holds two doubles, the greater one first.
template <class T>
concept DoubleDouble = std::is_trivially_copyable_v<T> && sizeof(T) == 2 * sizeof(double) && requires {
  requires T::is_double_double;
};

// Uses private members of the segment's part.
template <DoubleDouble T, class Masses>
requires(!Watched<Masses>) struct Stepped<Inelastic<T>, GapSegment<T, Masses>> final : private StepScalars {
 public:
  static constexpr bool possible = true, on_rings = false;
  using Part = GapSegment<T, Masses>;
  using Law = Inelastic<T>;
  using Report = typename Part::Report;

  // Makes all collisions up to the local time `stop`, fewer than `most`, on what the part has taken.
  bool run(const Steps& steps, Part& part, const Law& law, const T& stop, std::uint64_t most, Report& report) {
    if (report.observe) return false;  // the event loop logs what is observed
    if (report.pace.rest > 0) return --report.pace.rest, false;
    part_ = &part, law_ = &law, report_ = &report;
    made_ = {};
    StepResult inner;
    StepPace& pace = report.pace;
    bool done = fill() && steps.run(line_, task_of(stop, most), *this, pace, inner);
    if (done) line_.bound_tiles();
    done = done && line_.least_due() > to_double(stop);  // no key is that of `stop`
    pace.made(done);
    if (!done) return false;
    report.counts = made_.counts;
    report.counts.collisions += inner.collisions;
    report.counts.below_cutoff += inner.below_cutoff;
    const T last = of(inner.last, inner.low_last);
    report.last_collision = made_.last < last ? last : made_.last;
    if (report.counts.collisions >= most) return false;
    for (std::size_t i = 0; i < line_.gaps(); ++i) give(i);
    part.line_.gaps.drop_lags(Part::first(), line_.gaps());
    return true;
  }

 private:
  static constexpr bool equal = std::same_as<Masses, IdenticalMasses<T>>;
  struct Two {
    double high, low;
  };
  struct Made {
    Counts counts;
    T last{of(-StepLine::never, 0)};
  };

  static T of(double high, double low) { return std::bit_cast<T>(Two{high, low}); }
  static void put(const T& x, double& high, double& low) {
    const Two two = std::bit_cast<Two>(x);
    high = two.high, low = two.low;
  }

  StepTask task_of(const T& stop, std::uint64_t most) const {
    StepTask task;
    task.pairs = true;
    task.law = law_->soft() ? StepLaw::soft : StepLaw::hard;
    put(law_->restitution(), task.restitution, task.low.restitution);
    put(law_->half_sum(), task.half_sum, task.low.half_sum);
    put(law_->cutoff(), task.cutoff, task.low.cutoff);
    put(law_->lost_share(), task.lost, task.low.lost);
    if constexpr (equal) put(law_->lost_share() * part_->line_.masses.reduced_mass, task.lost, task.low.lost);
    task.unequal = !equal;
    task.floor = to_double(part_->line_.gaps.floor());
    task.rounder = StepLine::never;  // there is no ledger
    task.stop = std::nextafter(to_double(stop), -StepLine::never);
    task.most = most;
    return task;
  }

  // False where a gap is due before the origin, or at no number.
  bool fill() {
    bool all = true;
    line_.take_pairs(part_->last() + 1 - Part::first());
    for (std::size_t i = 0; i < line_.gaps(); ++i) {
      const Slot s = Part::first() + i;
      all &= take(i);
      const T& lag = part_->line_.gaps.lag(s);
      put(lag, line_.high.lag[i], line_.low.lag[i]);
      if constexpr (!equal) {
        const TwoMasses<T> masses = part_->line_.masses.of_pair(s);
        const bool left_lighter = masses.left < masses.right;
        const T fraction = (left_lighter ? masses.left : masses.right) / (masses.left + masses.right);
        put(left_lighter ? T(-fraction) : fraction, line_.fraction[i], line_.low.fraction[i]);
        put(masses.reduced(), line_.reduced[i], line_.low.reduced[i]);
      }
    }
    line_.bound_tiles();
    set_inner();
    return all;
  }
  void set_inner() {
    line_.inner_first = static_cast<std::uint32_t>(part_->inner_first_ - Part::first());
    line_.inner = static_cast<std::uint32_t>(part_->inner_);
  }

  // A gap from the part's cell, and back. Lags are only read: a collision that is undone leaves them as they were.
  bool take(std::size_t i) {
    const Slot s = Part::first() + i;
    const auto& cell = part_->line_.gaps[s];
    put(cell.gap, line_.high.gap[i], line_.low.gap[i]);
    put(cell.closing, line_.high.closing[i], line_.low.closing[i]);
    put(cell.time, line_.high.time[i], line_.low.time[i]);
    put(cell.lost, line_.high.lost[i], line_.low.lost[i]);
    put(is_positive(cell.closing) ? part_->line_.due(s) : of(StepLine::never, 0), line_.due[i], line_.low.due[i]);
    return line_.due[i] >= 0;
  }
  void give(std::size_t i) {
    const Slot s = Part::first() + i;
    auto& cell = part_->line_.gaps[s];
    cell.gap = of(line_.high.gap[i], line_.low.gap[i]);
    cell.closing = of(line_.high.closing[i], line_.low.closing[i]);
    cell.time = of(line_.high.time[i], line_.low.time[i]);
    cell.lost = of(line_.high.lost[i], line_.low.lost[i]);
    part_->line_.gaps.set_lag(s, of(line_.high.lag[i], line_.low.lag[i]));
  }

  // The part's own collision, where all that is not plain is refused.
  bool collide(std::size_t i) override {
    const std::size_t from = i > 0 ? i - 1 : 0, to = std::min(i + 2, line_.gaps());
    const Slot s = Part::first() + i;
    const T time = of(line_.due[i], line_.low.due[i]);
    for (std::size_t k = from; k < to; ++k) {
      give(k);
      if (!is_positive(part_->line_.gaps.flown(Part::first() + k, time))) return false;
    }
    const auto [collision, own] = part_->collide(*law_, s, time, *report_);
    set_inner();
    if (includes(collision.notice, Notice::origin_must_move) || includes(collision.notice, Notice::gap_below_floor) ||
        includes(collision.notice, Notice::needs_slots))
      return false;
    part_->lose(s, collision.outcome.energy_lost);
    for (std::size_t k = from; k < to; ++k)
      if (!take(k)) return false;
    if (!own) return true;
    ++made_.counts.collisions;
    made_.counts.below_cutoff += collision.outcome.below_cutoff;
    if (made_.last < time) made_.last = time;
    return true;
  }
  void outcomes(const std::uint32_t*, std::size_t) override {}

  void keep() override {
    kept_ = {made_,
             part_->edges(),
             report_->left.size(),
             report_->right.size(),
             report_->to_left.at_end.size(),
             report_->to_right.at_end.size()};
  }
  void restore() override {
    made_ = kept_.made;
    part_->set_edges(kept_.edges);
    report_->left.resize(kept_.left, {false, T(0), T(0)}), report_->right.resize(kept_.right, {false, T(0), T(0)});
    report_->to_left.at_end.resize(kept_.at_left), report_->to_right.at_end.resize(kept_.at_right);
    set_inner();
  }

  struct Kept {
    Made made;
    typename Part::Edges edges;
    std::size_t left, right, at_left, at_right;  // lengths of logs
  };

  StepLine line_;
  Part* part_ = nullptr;
  const Law* law_ = nullptr;
  Report* report_ = nullptr;
  Made made_;  // at edges
  Kept kept_;
};

}  // namespace cradle
