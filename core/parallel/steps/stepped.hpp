#pragma once
// A segment of a chain in gaps uses steps (steps.hpp) as follows: they work on the segment's copy. The segment itself
// makes the collisions at cuts, fronts and walls, and those beside the seam of a whole ring. If steps fail, it takes
// its copy anew and goes through its event loop.

#include <array>
#include <concepts>
#include <iterator>
#include <tuple>
#include <utility>

#include "cradle/core/parallel/gap_segment.hpp"
#include "cradle/core/parallel/steps/step_numbers.hpp"
#include "cradle/core/parallel/steps/steps.hpp"

namespace cradle {

// What a segment of either chain does around its steps. Uses private members of its part.
template <class Part> class AroundSteps : protected StepScalars {
 protected:
  using T = typename Part::Scalar;
  using Numbers = StepNumbers<T>;
  using Report = typename Part::Report;

  struct Totals {
    Counts counts;
    T last = Numbers::of(-StepLine::never, 0);
  };

  static Slot slot(std::size_t i) { return Part::first() + i; }
  bool is_held(Slot s) const { return s - Part::first() < line_.gaps(); }  // not beyond an end

  // Fills the line by `fill`, and makes on it the collisions of a task up to the local time `stop`. False if it cannot:
  // the segment must then take its copy anew.
  template <class Fill> bool make(const Steps& steps, const StepTask& task, const T& stop, const Fill& fill) {
    if (!(task.rounder > 0)) return false;  // the ledger is a plain sum, which depends on the order
    made_ = {};
    StepResult inner;
    const bool done = fill() && steps.run(line_, task, *this, report_->pace, inner) && Numbers::all_made(line_, stop);
    report_->pace.made(done);
    if (!done) return false;
    report_->counts = made_.counts;
    report_->counts.collisions += inner.collisions;
    report_->counts.below_cutoff += inner.below_cutoff;
    const T last = Numbers::of(inner.last, inner.low_last);
    report_->last_collision = made_.last < last ? last : made_.last;
    if (report_->counts.collisions >= task.most) return false;
    auto& cells = part_->line_;
    for (std::size_t i = 0; Numbers::pairs && i < line_.gaps(); ++i) Numbers::give(line_, i, cells, slot(i));
    if constexpr (Ledger<T>::in_any_order) {
      Ledger<T> ledger = cells.gaps.ledger();
      ledger.add_sums(inner.lost, static_cast<std::int64_t>(inner.rest));
      cells.gaps.set_ledger(ledger);
    }
    cells.gaps.drop_lags(Part::first(), line_.gaps());
    return true;
  }

  void keep() override {
    kept_.made = made_, kept_.ledger = part_->line_.gaps.ledger(), kept_.edges = part_->edges();
    kept_.logged = std::apply([](const auto&... log) { return std::array{std::ssize(log)...}; }, report_->logs());
  }
  void restore() override {
    made_ = kept_.made;
    part_->line_.gaps.set_ledger(kept_.ledger);
    part_->edges() = kept_.edges;
    part_->set_inner();
    const auto* length = kept_.logged.data();
    std::apply([&](auto&... log) { (log.erase(log.begin() + *length++, log.end()), ...); }, report_->logs());
  }

  StepLine line_;
  Part* part_ = nullptr;
  Report* report_ = nullptr;
  Totals made_;  // by the segment itself; where `outcomes` computes the law, also all that is below the cut-off

 private:
  template <class... X> static std::tuple<X...> copies(std::tuple<X&...>);
  struct Kept {
    Totals made;
    Ledger<T> ledger;
    decltype(copies(std::declval<Part&>().edges())) edges;
    std::array<std::ptrdiff_t, std::tuple_size_v<decltype(std::declval<Report&>().logs())>> logged;  // lengths of logs
  };
  Kept kept_;
};

// Uses private members of the segment's part.
template <class Law, class T, class Masses>
requires(StepNumbers<T>::template by_law<Law> && !Watched<Masses>) struct Stepped<Law, GapSegment<T, Masses>> final
    : private AroundSteps<GapSegment<T, Masses>> {
  using Part = GapSegment<T, Masses>;
  using Around = AroundSteps<Part>;
  using typename Around::Numbers, typename Around::Report;

 public:
  static constexpr bool possible = true, on_rings = !Numbers::pairs;

  // Makes all collisions up to the local time `stop`, fewer than `most`, on what the part has taken. False if it
  // cannot.
  bool run(const Steps& steps, Part& part, const Law& law, const T& stop, std::uint64_t most, Report& report) {
    if (Numbers::pairs && (report.observe || part.curved())) return false;  // the event loop logs and knows curves
    if (report.pace.rest > 0) return --report.pace.rest, false;
    part_ = &part, law_ = &law, report_ = &report;
    return Around::make(steps, task_of(stop, most), stop, [this] { return fill(); });
  }

 private:
  static constexpr bool equal = std::same_as<Masses, IdenticalMasses<T>>;

  using Around::is_held, Around::line_, Around::made_, Around::part_, Around::report_, Around::slot;

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
    line_.inner_count = static_cast<std::uint32_t>(part_->inner_count_);
  }

  // Makes one collision on the segment's cells as the event loop does. False if it comes too early, or requests what
  // only the event loop or the plain loop can do. Lags stay as they are, and are dropped when all is done.
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

  void restore() override {
    Around::restore();
    set_inner();
  }

  const Law* law_ = nullptr;
};

}  // namespace cradle
