#pragma once
// A segment of a chain of clusters uses steps (steps.hpp) for wet particles that pass through each other. It makes
// itself the collisions in which particles merge and those at cuts, at fronts and at the seam. If steps fail, it takes
// its copy anew and goes through its event loop.

#include <array>

#include "cradle/core/laws/one_of.hpp"
#include "cradle/core/parallel/cluster_segment.hpp"
#include "cradle/core/parallel/steps/stepped.hpp"

namespace cradle {

// Uses private members of the segment's part.
template <class Law>
requires(!Law::bounces_only && requires(const Law& law) {
  law_as<Wet<double>>(law);
}) struct Stepped<Law, ClusterSegment<double>> final : private AroundSteps<ClusterSegment<double>> {
  using Part = ClusterSegment<double>;

 public:
  static constexpr bool possible = true, on_rings = false;

  // Makes all collisions up to the local time `stop`, fewer than `most`, on what the part has taken. False if it
  // cannot.
  bool run(const Steps& steps, Part& part, const Law& law, double stop, std::uint64_t most, Report& report) {
    const Wet<double>* wet = law_as<Wet<double>>(law);
    if (wet == nullptr || report.observe) return false;
    if (report.pace.rest > 0) return --report.pace.rest, false;
    part_ = &part, law_ = wet, report_ = &report;
    const auto& gaps = part.line_.gaps;
    StepTask task;
    task.law = StepLaw::wet;
    task.twice_loss = wet->twice_loss(), task.below = wet->below(), task.above = wet->above(), task.lost = wet->loss();
    task.floor = gaps.floor();
    task.rounder = gaps.ledger().rounder(), task.per_fine = gaps.ledger().per_fine();
    task.stop = stop, task.most = most;
    return make(steps, task, stop, [&] {
      const std::size_t held = part.last_ + 1 - Part::first_;
      line_.take(&part.line_.gaps[Part::first_], Part::first_, &gaps.lag(Part::first_), held);
      line_.mark(0, line_.index(part.inner_first_), StepLine::edge);
      line_.mark(line_.index(part.inner_last_) - 1, static_cast<std::ptrdiff_t>(held), StepLine::edge);
      mark_edges();
      return true;
    });
  }

 private:
  // How many links decisions in steps follow on either side (decisions.inl): if one of these links skips a vacant cell,
  // the nearest such cell is as near.
  static constexpr std::ptrdiff_t near = 3;

  // The gaps at cuts, fronts and the seam, wherever they are now.
  void mark_edges() {
    for (const Slot at : {part_->inner_first_, part_->inner_last_, part_->seam_})
      for (const Slot s : {at, at < Part::first_ ? at : part_->left(at)})
        if (is_held(s)) line_.special[s - Part::first_] = StepLine::edge;
  }

  // Makes one collision as the event loop does. False if it comes too early, or requests what only the plain loop can
  // do. Lags stay as they are, and are dropped when all is done.
  bool collide(std::size_t i) override {
    auto& cells = part_->line_;
    const Slot s = Part::first_ + i, n = cells.right(s);
    const std::array<Slot, 3> touched{cells.left(s), s, n};
    const double time = line_.due[i];
    std::array<double, 3> lags{};
    for (std::size_t k = 0; k < 3; ++k) {
      lags[k] = cells.gaps.lag(touched[k]);
      if (is_held(touched[k]) && !(cells.gaps[touched[k]].time < time)) return false;
    }
    const auto [collision, own] = part_->collide(*law_, s, time, *report_);
    const Outcome<double>& outcome = collision.outcome;
    if (report_->nothing_left || includes(collision.notice, for_plain_loop)) return false;
    if (own) part_->lose(s, outcome.energy_lost);
    for (std::size_t k = 0; k < 3; ++k) {
      cells.gaps.set_lag(touched[k], lags[k]);
      if (is_held(touched[k])) line_.due[line_.index(touched[k])] = cells.gaps[touched[k]].due;
    }
    const bool merges = outcome.event == Event::merge;
    if (merges) line_.mark(line_.index(n) - near, line_.index(n) + near, StepLine::near_vacant);
    mark_edges();
    if (!own) return true;
    ++made_.counts.collisions;
    made_.counts.merges += merges;
    made_.last = std::max(made_.last, time);
    return true;
  }

  void outcomes(const std::uint32_t*, std::size_t) override {}  // Wet is a law of vectors

  void restore() override {
    AroundSteps::restore();
    report_->nothing_left = false;
  }

  const Wet<double>* law_ = nullptr;
};

}  // namespace cradle
