#pragma once
// How a segment of a chain in gaps uses steps (steps.hpp): steps work on the segment's copy, and leave collisions at
// cuts, fronts and walls to it, and those beside the seam of a whole ring. If steps fail, the segment takes its copy
// anew and goes through its event loop.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "cradle/core/chains/masses.hpp"
#include "cradle/core/engine/status.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/laws/one_of.hpp"
#include "cradle/core/parallel/gap_segment.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/core/queue/ledger.hpp"

namespace cradle {

// Uses private members of the segment's part. Law: any that bounces.
template <class Law, class Masses>
requires(Law::bounces_only && !Watched<Masses>) struct Stepped<Law, GapSegment<double, Masses>> final
    : private StepScalars {
 public:
  static constexpr bool possible = true, on_rings = true;
  using Part = GapSegment<double, Masses>;
  using Report = typename Part::Report;

  // Makes all collisions up to the local time `stop`, fewer than `most`, on what the part has taken.
  bool run(const Steps& steps, Part& part, const Law& law, double stop, std::uint64_t most, Report& report) {
    if (report.pace.rest > 0) return --report.pace.rest, false;
    part_ = &part, law_ = &law, report_ = &report;
    const StepTask task = task_of(stop, most);
    if (!(task.rounder > 0)) return false;  // a plain sum
    fill();
    made_ = {};
    ledger_ = part.line_.gaps.ledger();
    StepResult inner;
    StepPace& pace = report.pace;
    const bool done = steps.run(line_, task, *this, pace, inner);
    pace.made(done);
    if (!done) return false;
    report.counts = made_.counts;
    report.counts.collisions += inner.collisions;
    report.counts.below_cutoff += inner.below_cutoff;
    report.last_collision = std::max(made_.last, inner.last);
    if (report.counts.collisions >= most) return false;
    ledger_.add_sums(inner.lost, static_cast<std::int64_t>(inner.rest));
    part.line_.gaps.set_ledger(ledger_);
    part.line_.gaps.drop_lags(Part::first(), line_.gaps());
    return true;
  }

 private:
  static constexpr bool equal = std::same_as<Masses, IdenticalMasses<double>>;

  struct Made {
    Counts counts;
    double last = -StepLine::never;
  };

  StepTask task_of(double stop, std::uint64_t most) const {
    const auto& gaps = part_->line_.gaps;
    StepTask task;
    if (!report_->observe) {  // else `outcomes` is to log every collision
      if (const auto* law = law_as<Inelastic<double>>(*law_)) {
        task.law = law->soft() ? StepLaw::soft : StepLaw::hard;
        task.restitution = law->restitution();
        task.half_sum = law->half_sum();
        task.cutoff = law->cutoff();
        task.lost = law->lost_share();
      } else if (const auto* of_speed = law_as<SpeedDependent<double>>(*law_)) {
        task.law = StepLaw::of_speed;
        task.cutoff = of_speed->delta();
        task.lost = 1;
        const auto &power = of_speed->power(), &rise = of_speed->rise();
        task.of_speed = {of_speed->missing(),
                         power.exponent(),
                         power.ln2(),
                         rise.all(),
                         power.whole(),
                         power.odd().data(),
                         rise.reciprocals().data(),
                         power.odd().size(),
                         rise.reciprocals().size()};
      }
      if constexpr (equal) task.lost *= part_->line_.masses.reduced_mass;
      task.unequal = !equal;
    }
    task.floor = gaps.floor();
    task.rounder = gaps.ledger().rounder();
    task.per_fine = gaps.ledger().per_fine();
    task.stop = stop;
    task.most = most;
    return task;
  }

  void fill() {
    auto& gaps = part_->line_.gaps;
    constexpr Slot first = Part::first();
    line_.take(&gaps[first], &gaps.lag(first), part_->last() + 1 - first);
    if constexpr (!equal)
      for (std::size_t i = 0; i < line_.gaps(); ++i) {
        const TwoMasses<double> masses = part_->line_.masses.of_pair(first + i);
        const bool left_lighter = masses.left < masses.right;
        const double fraction = (left_lighter ? masses.left : masses.right) / (masses.left + masses.right);
        line_.fraction[i] = left_lighter ? -fraction : fraction;
        line_.reduced[i] = masses.reduced();
      }
    line_.ring = part_->is_ring();
    set_inner();
  }
  void set_inner() {
    line_.inner_first = static_cast<std::uint32_t>(part_->inner_first_ - Part::first());
    line_.inner = static_cast<std::uint32_t>(part_->inner_);
  }

  // ---- the plain loop's collision (GapLine::strike), where all that is not plain is refused
  bool collide(std::size_t i) override {
    Gap<double>& cell = line_.cells[i];
    const double time = cell.due, closing = cell.closing, since = flown(i, time);
    if (since <= time * 0x1p-40 || is_negative(since)) return false;
    const Slot s = Part::first() + i;
    const Outcome<double> outcome = part_->outcome_at_edge(*law_, s, closing);
    const auto edge = part_->at_edge(s, time, closing, outcome, *report_);
    set_inner();
    if (edge.notice != Notice::none) return false;
    if (edge.own) log(i, outcome.below_cutoff);
    cell.gap = 0;
    cell.closing = outcome.closing;
    cell.time = time;
    cell.due = line_.due[i] = StepLine::never;
    const std::size_t left = line_.left_of(i), right = line_.right_of(i);
    if (left != i && !kick(left, outcome.to_left, time)) return false;
    if (right < line_.gaps() && !kick(right, outcome.to_right, time)) return false;
    if (!edge.own) return true;
    ledger_.add(outcome.energy_lost);
    ++made_.counts.collisions;
    made_.counts.below_cutoff += outcome.below_cutoff;
    made_.last = std::max(made_.last, time);
    return true;
  }
  bool kick(std::size_t i, double gain, double time) {
    Gap<double>& cell = line_.cells[i];
    const double since = flown(i, time);
    if (!(since > 0)) return false;
    cell.gap -= cell.closing * since;
    cell.time = time;
    cell.closing += gain;
    if (cell.gap < part_->line_.gaps.floor()) return false;
    cell.due = line_.due[i] = cell.closing > 0 ? time + cell.gap / cell.closing : StepLine::never;
    return true;
  }
  double flown(std::size_t i, double time) const {
    const double then = line_.cells[i].time, since = time - then;
    return is_negative(then) ? since - line_.lag[i] : since;
  }

  // Logs a collision before it is made, if it is observed.
  void log(std::size_t i, bool below_cutoff) {
    if (!report_->observe) return;
    auto observed = part_->observed(Part::first() + i, line_.cells[i].due);
    observed.below_cutoff = below_cutoff;
    report_->observed.push_back(observed);
  }

  void outcomes(const std::uint32_t* gaps, std::size_t count) override {
    for (std::size_t k = 0; k < count; ++k) {
      const Outcome<double> outcome =
          (*law_)(line_.cells[gaps[k]].closing, part_->line_.masses.of_pair(Part::first() + gaps[k]));
      line_.after[k] = outcome.closing, line_.to_left[k] = outcome.to_left, line_.to_right[k] = outcome.to_right;
      ledger_.add(outcome.energy_lost);
      made_.counts.below_cutoff += outcome.below_cutoff;
      log(gaps[k], outcome.below_cutoff);
    }
  }

  void keep() override {
    kept_ = {made_,
             ledger_,
             part_->edges(),
             report_->left.size(),
             report_->right.size(),
             report_->to_left.at_end.size(),
             report_->to_right.at_end.size(),
             report_->observed.size()};
  }
  void restore() override {
    made_ = kept_.made, ledger_ = kept_.ledger;
    part_->set_edges(kept_.edges);
    report_->left.resize(kept_.left), report_->right.resize(kept_.right);
    report_->to_left.at_end.resize(kept_.at_left), report_->to_right.at_end.resize(kept_.at_right);
    report_->observed.resize(kept_.observed);
    set_inner();
  }

  struct Kept {
    Made made;
    Ledger<double> ledger;
    typename Part::Edges edges;
    std::size_t left, right, at_left, at_right, observed;  // lengths of logs
  };

  StepLine line_;
  Part* part_ = nullptr;
  const Law* law_ = nullptr;
  Report* report_ = nullptr;
  Made made_;  // at edges; by other laws all that is below the cut-off
  Ledger<double> ledger_;
  Kept kept_;
};

}  // namespace cradle
