#pragma once
// One segment of a run (segments.hpp): the event loop over a copy of what the segment owns and of some ghosts on either
// side, through a time slab, as if there were nothing beyond. The chain's own header says what is copied, what cuts log
// and what goes back: gap_segment.hpp, cluster_segment.hpp.
//
// Ties are not looked for in the whole queue. If the keys of two collisions may belong to the same time, the second one
// is at the queue's root next, or beside the first one. A segment checks both at every collision; if it finds such a
// pair, it begins its time slab again and compares exact times.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cradle/core/chains/chain.hpp"
#include "cradle/core/engine/status.hpp"
#include "cradle/core/engine/ties.hpp"
#include "cradle/core/parallel/observed.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/core/queue/ledger.hpp"

namespace cradle {

// Requests of a chain that only the plain loop can fulfil.
constexpr Notice for_plain_loop = Notice::origin_must_move | Notice::gap_below_floor | Notice::needs_slots;

// The gaps that a segment owns, by slots of the chain, around the seam of a ring if need be.
struct OwnedGaps {
  Slot first;
  std::size_t gaps;
};

// What a segment has made of a time slab. Parts add what they hand back to their chain.
template <Real T, class CutCollision, class Observed> struct SegmentReport {
  bool plain = false;         // whether the time slab is given up
  bool nothing_left = false;  // what the segment owned has merged with what others own
  Counts counts;
  T last_collision{0};  // if there was one
  bool in_steps = false;
  StepPace pace;
  Ledger<T> lost;
  std::vector<CutCollision> left, right;  // at the cuts on either side
  bool observe = false;                   // whether collisions of the segment's own are logged
  std::vector<Observed> observed;
};

// A collision in a segment, and whether it is at a gap of the segment's own.
template <Real T> struct OwnedResult {
  CollisionResult<T> collision;
  bool own;
};

// The part of a chain that a segment works on.
template <class Chain> struct PartOf;

// How it makes collisions in steps, where it can (steps/stepped.hpp).
template <class Law, class Part> struct Stepped {
  static constexpr bool possible = false, on_rings = false;  // on_rings: also of a whole ring, which has no cuts
};

template <class Law, class Chain> class Segment {
 public:
  using T = typename Chain::Scalar;
  using Part = typename PartOf<Chain>::Type;
  using Report = typename Part::Report;

  explicit Segment(const Chain& chain) : part_(chain), queue_(16, Chain::keys_are_exact) {}

  // Makes all collisions up to the local time `stop`, fewer than `most`, on a copy of a part of the chain, and puts
  // what is the segment's own into `after`, at the chain's slots. Several segments of one chain may do so at once.
  // `steps` may be null.
  void run(const Chain& chain, const Law& law, const OwnedGaps& own, std::size_t ghosts, const T& stop,
           std::uint64_t most, const Steps* steps, typename Chain::Line::Gaps& after, Report& report) {
    if constexpr (Stepped<Law, Part>::possible)
      if (steps != nullptr && take(chain, own, ghosts, report)) {
        if (part_.is_ring()) report.pace.rest = 0;  // after a failure `Segments` itself waits (patience_)
        report.in_steps = stepped_.run(*steps, part_, law, stop, most, report);
        if (report.in_steps) return part_.give(chain, own, after, report);
        report.plain = part_.is_ring();
        if (report.plain) return;
      }
    if (!begin(chain, own, ghosts, report)) return;
    // An observed run uses the loop with exact times and the log; others pay for neither.
    Finish made = report.observe ? make_collisions<true>(law, stop, most, report)
                                 : make_collisions<false>(law, stop, most, report);
    if (made == Finish::contested) {
      begin(chain, own, ghosts, report);
      made = make_collisions<true>(law, stop, most, report);
    }
    report.plain = made == Finish::for_plain;
    if (!report.plain && !report.nothing_left) part_.give(chain, own, after, report);
  }

 private:
  enum class Finish { all, contested, for_plain };

  // Takes what is to be computed; false if there is nothing. `begin` fills the queue too.
  bool take(const Chain& chain, const OwnedGaps& own, std::size_t ghosts, Report& report) {
    report.left.clear(), report.right.clear(), report.observed.clear();
    report.nothing_left = report.plain = report.in_steps = false;
    report.counts = {};
    return part_.take(chain, own, ghosts, report);
  }
  bool begin(const Chain& chain, const OwnedGaps& own, std::size_t ghosts, Report& report) {
    if (!take(chain, own, ghosts, report)) return false;
    const std::size_t slots = part_.last() + 3;
    if (queue_.slots() < slots || queue_.slots() > 4 * slots) queue_ = EventQueue(slots, Chain::keys_are_exact);
    queue_.clear();
    for (Slot s = part_.first(); s <= part_.last(); ++s) queue_.set(s, part_.queue_key(s));
    queue_.rebuild(part_.first(), part_.last());
    ties_.forget();
    return true;
  }
  // What has become of the collision logged last.
  static void log(const Outcome<T>& outcome, bool own, Report& report) {
    if (!own) return report.observed.pop_back();
    report.observed.back().below_cutoff = outcome.below_cutoff;
    report.observed.back().merges = outcome.event == Event::merge;
  }

  // The event loop of a segment.
  template <bool exact> Finish make_collisions(const Law& law, const T& stop, std::uint64_t most, Report& report) {
    const double latest = part_.queue_time(stop);
    const EventQueue::Key certainly_before = queue_.certainly_before(latest);
    const EventQueue::Key possibly_before = queue_.possibly_before(latest);
    EventQueue::Key passed = 0;  // keys up to this may be at the time of the collision before
    T time = T(0);
    Slot before = 0;  // slot of the collision before
    Counts counts;
    const auto end = [&](Finish made) {
      report.counts = counts;
      return made;
    };
    for (std::uint64_t made = 0; made < most; ++made) {
      const EventQueue::Key next = queue_.next();
      Slot s = queue_.slot(next);
      if (next >= certainly_before) [[unlikely]] {
        if (next > possibly_before) return end(Finish::all);
        const bool contested = queue_.contested();
        if (contested && !exact) return Finish::contested;
        if (contested) s = ties_.first(queue_, part_, made);
        if (!(part_.due(s) <= stop)) return end(Finish::all);
      }
      if constexpr (exact) {
        if (queue_.contested()) {
          if (part_.across_seam()) return Finish::for_plain;  // slots are not in the order of the line there
          s = ties_.first(queue_, part_, made);
        }
        const T now = part_.due(s);
        if (made > 0 && (now < time || (now == time && s < before))) return Finish::for_plain;
        time = now;
        before = s;
      } else {
        if (next <= passed || queue_.close(next, part_.left(s)) || queue_.close(next, part_.right(s)))
          return Finish::contested;
        passed = queue_.no_later_than(next);
        time = part_.due(s);
      }
      if (exact && report.observe) report.observed.push_back(part_.observed(s, time));
      const auto [collision, own] = part_.collide(law, s, time, report);
      queue_.replace(collision.left, collision.due_left, s, collision.due, collision.right, collision.due_right);
      const Outcome<T>& outcome = collision.outcome;
      if (includes(collision.notice, for_plain_loop)) [[unlikely]]
        return Finish::for_plain;
      if (own || !Ledger<T>::in_any_order) part_.lose(s, outcome.energy_lost);
      if (exact && report.observe) log(outcome, own, report);
      if (!own) [[unlikely]] {
        if (report.nothing_left) return end(Finish::all);
        continue;
      }
      ++counts.collisions;
      counts.below_cutoff += outcome.below_cutoff;
      counts.merges += outcome.event == Event::merge;
      report.last_collision = time;
    }
    return Finish::for_plain;
  }

  Part part_;
  EventQueue queue_;
  Ties<Part> ties_;
  Stepped<Law, Part> stepped_;
};

}  // namespace cradle
