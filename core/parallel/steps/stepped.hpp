#pragma once
// A segment of a chain in gaps uses steps (steps.hpp) as follows: they work on the segment's copy, and leave collisions
// at cuts, fronts and walls to it, and those beside the seam of a whole ring. If steps fail, the segment takes its copy
// anew and goes through its event loop.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "cradle/core/chains/masses.hpp"
#include "cradle/core/engine/status.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/laws/one_of.hpp"
#include "cradle/core/parallel/gap_segment.hpp"
#include "cradle/core/parallel/steps/step_numbers.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/core/queue/ledger.hpp"

namespace cradle {

// Uses private members of the segment's part.
template <class Law, class T, class Masses>
requires(StepNumbers<T>::template by_law<Law> && !Watched<Masses>) struct Stepped<Law, GapSegment<T, Masses>> final
    : private StepScalars {
  using Numbers = StepNumbers<T>;

 public:
  static constexpr bool possible = true, on_rings = !Numbers::pairs;
  using Part = GapSegment<T, Masses>;
  using Report = typename Part::Report;

  // Makes all collisions up to the local time `stop`, fewer than `most`, on what the part has taken.
  bool run(const Steps& steps, Part& part, const Law& law, const T& stop, std::uint64_t most, Report& report) {
    if (Numbers::pairs && (report.observe || part.curved())) return false;  // the event loop logs and knows curves
    if (report.pace.rest > 0) return --report.pace.rest, false;
    part_ = &part, law_ = &law, report_ = &report;
    const StepTask task = task_of(stop, most);
    if (!(task.rounder > 0)) return false;  // a plain sum
    made_ = {};
    StepResult inner;
    StepPace& pace = report.pace;
    const bool done = fill() && steps.run(line_, task, *this, pace, inner) && Numbers::all_made(line_, stop);
    pace.made(done);
    if (!done) return false;
    report.counts = made_.counts;
    report.counts.collisions += inner.collisions;
    report.counts.below_cutoff += inner.below_cutoff;
    const T last = Numbers::of(inner.last, inner.low_last);
    report.last_collision = made_.last < last ? last : made_.last;
    if (report.counts.collisions >= most) return false;
    for (std::size_t i = 0; Numbers::pairs && i < line_.gaps(); ++i) Numbers::give(line_, i, part.line_, slot(i));
    if constexpr (Ledger<T>::in_any_order) {
      Ledger<T> ledger = part.line_.gaps.ledger();
      ledger.add_sums(inner.lost, static_cast<std::int64_t>(inner.rest));
      part.line_.gaps.set_ledger(ledger);
    }
    part.line_.gaps.drop_lags(Part::first(), line_.gaps());
    return true;
  }

 private:
  static constexpr bool equal = std::same_as<Masses, IdenticalMasses<T>>;

  struct Totals {
    Counts counts;
    T last = Numbers::of(-StepLine::never, 0);
  };

  static Slot slot(std::size_t i) { return Part::first() + i; }

  StepTask task_of(const T& stop, std::uint64_t most) const {
    const auto& gaps = part_->line_.gaps;
    StepTask task;
    task.pairs = Numbers::pairs;
    T lost(0);
    if (!report_->observe) {  // else `outcomes` is to log every collision
      if (const auto* law = law_as<Inelastic<T>>(*law_)) {
        task.law = law->soft() ? StepLaw::soft : StepLaw::hard;
        Numbers::put(law->restitution(), task.restitution, task.low.restitution);
        Numbers::put(law->half_sum(), task.half_sum, task.low.half_sum);
        Numbers::put(law->cutoff(), task.cutoff, task.low.cutoff);
        lost = law->lost_share();
      } else if (const auto* of_speed = law_as<SpeedDependent<double>>(*law_)) {
        task.law = StepLaw::of_speed;
        task.cutoff = of_speed->delta();
        lost = T(1);
        const auto &power = of_speed->power(), &rise = of_speed->rise();
        StepRestitution& to = task.of_speed;
        to.missing = of_speed->missing(), to.exponent = power.exponent(), to.whole = power.whole();
        to.ln2 = power.ln2(), to.odd = power.odd().data(), to.odds = power.odd().size();
        to.all = rise.all(), to.reciprocals = rise.reciprocals().data(), to.count = rise.reciprocals().size();
      }
      if constexpr (equal) lost = lost * part_->line_.masses.reduced_mass;
      Numbers::put(lost, task.lost, task.low.lost);
      task.unequal = !equal;
    }
    task.floor = to_double(gaps.floor());
    task.rounder = StepLine::never;  // where there is no ledger
    if constexpr (Ledger<T>::in_any_order)
      task.rounder = gaps.ledger().rounder(), task.per_fine = gaps.ledger().per_fine();
    task.stop = Numbers::last(stop);
    task.most = most;
    return task;
  }

  bool fill() {
    const bool all = Numbers::take_all(line_, part_->line_, Part::first(), part_->last() + 1 - Part::first());
    if constexpr (!equal)
      for (std::size_t i = 0; i < line_.gaps(); ++i) {
        const TwoMasses<T> masses = part_->line_.masses.of_pair(slot(i));
        const bool left_lighter = masses.left < masses.right;
        const T fraction = (left_lighter ? masses.left : masses.right) / (masses.left + masses.right);
        Numbers::enter(left_lighter ? T(-fraction) : fraction, line_.fraction, line_.low.fraction, i);
        Numbers::enter(masses.reduced(), line_.reduced, line_.low.reduced, i);
      }
    line_.ring = part_->is_ring();
    set_inner();
    return all;
  }
  void set_inner() {
    line_.inner_first = static_cast<std::uint32_t>(part_->inner_first_ - Part::first());
    line_.inner = static_cast<std::uint32_t>(part_->inner_);
  }

  // The event loop's collision, on the cells, where all that is not plain is refused. Lags stay as they are, and are
  // dropped when all is done.
  bool collide(std::size_t i) override {
    auto& cells = part_->line_;
    const Slot s = slot(i), left = i == 0 && !line_.ring ? s - 1 : slot(line_.left_of(i)),
               right = slot(line_.right_of(i));
    const T time = Numbers::due(line_, i);
    const std::array<Slot, 3> touched{left, s, right};
    const std::array<T, 3> lags{cells.gaps.lag(left), cells.gaps.lag(s), cells.gaps.lag(right)};
    for (const Slot each : touched) {
      if (!is_held(each)) continue;
      Numbers::give(line_, each - Part::first(), cells, each);
      if (!(cells.gaps[each].time < time)) return false;
    }
    const Outcome<T> outcome = part_->outcome_at_edge(*law_, s, time);
    const auto edge = part_->at_edge(s, time, outcome, *report_);
    set_inner();
    if (edge.notice != Notice::none) return false;
    if (edge.own) log(s, time, outcome.below_cutoff);
    const Notice notice = part_->strike_at_edge(left, s, right, time, outcome, Notice::none).notice;
    if (includes(notice, for_plain_loop)) return false;
    if (edge.own || !Ledger<T>::in_any_order) part_->lose(s, outcome.energy_lost);
    for (std::size_t k = 0; k < 3; ++k) {
      cells.gaps.set_lag(touched[k], lags[k]);
      if (is_held(touched[k]) && !Numbers::take(line_, touched[k] - Part::first(), cells, touched[k])) return false;
    }
    if (!edge.own) return true;
    ++made_.counts.collisions;
    made_.counts.below_cutoff += outcome.below_cutoff;
    if (made_.last < time) made_.last = time;
    return true;
  }
  bool is_held(Slot s) const { return s - Part::first() < line_.gaps(); }  // not beyond an end

  // Logs a collision before it is made, if it is observed.
  void log(Slot s, const T& time, bool below_cutoff) {
    if (!report_->observe) return;
    auto observed = part_->observed(s, time);
    observed.below_cutoff = below_cutoff;
    report_->observed.push_back(observed);
  }

  void outcomes(const std::uint32_t* gaps, std::size_t count) override {
    if constexpr (!Numbers::pairs)
      for (std::size_t k = 0; k < count; ++k) {
        const Slot s = slot(gaps[k]);
        const Outcome<T> outcome = (*law_)(line_.cells[gaps[k]].closing, part_->line_.masses.of_pair(s));
        line_.after[k] = outcome.closing, line_.to_left[k] = outcome.to_left, line_.to_right[k] = outcome.to_right;
        part_->lose(s, outcome.energy_lost);
        made_.counts.below_cutoff += outcome.below_cutoff;
        log(s, line_.cells[gaps[k]].due, outcome.below_cutoff);
      }
  }

  void keep() override {
    kept_.made = made_, kept_.ledger = part_->line_.gaps.ledger(), kept_.edges = part_->edges();
    kept_.left = report_->left.size(), kept_.right = report_->right.size(), kept_.observed = report_->observed.size();
    kept_.at_left = report_->to_left.at_end.size(), kept_.at_right = report_->to_right.at_end.size();
  }
  void restore() override {
    made_ = kept_.made;
    part_->line_.gaps.set_ledger(kept_.ledger);
    part_->set_edges(kept_.edges);
    report_->left.resize(kept_.left, {false, T(0), T(0)}), report_->right.resize(kept_.right, {false, T(0), T(0)});
    report_->to_left.at_end.resize(kept_.at_left), report_->to_right.at_end.resize(kept_.at_right);
    report_->observed.resize(kept_.observed);
    set_inner();
  }

  struct Kept {
    Totals made;
    Ledger<T> ledger;
    typename Part::Edges edges;
    std::size_t left, right, at_left, at_right, observed;  // lengths of logs
  };

  StepLine line_;
  Part* part_ = nullptr;
  const Law* law_ = nullptr;
  Report* report_ = nullptr;
  Totals made_;  // at edges; by other laws all that is below the cut-off
  Kept kept_;
};

}  // namespace cradle
