#pragma once
// One segment of a run (segments.hpp): a copy of the gaps that it owns and of some ghosts on either side, with a queue
// of its own, that goes through a window of time as if there were nothing beyond.
//
// Ties are not looked for at every contact. Of two contacts whose keys may belong to the same time, either the second
// one is at the queue's root next, or it is beside the first one. If so, the segment begins its window again, and
// compares exact times.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cradle/core/gap_chain.hpp"
#include "cradle/core/law.hpp"
#include "cradle/core/ties.hpp"

namespace cradle {

// The gaps that a segment owns, from a slot of the chain on, around the seam of a ring if need be.
struct Own {
  Slot first;
  std::size_t gaps;
};

// A contact at a cut.
template <Real T> struct CutContact {
  bool behind;  // at the gap right of the cut
  T time, closing;
  friend bool operator==(const CutContact&, const CutContact&) = default;
};
template <Real T> using CutLog = std::vector<CutContact<T>>;

// What a segment has made of a window.
template <Real T> struct SegmentReport {
  bool plain = false;  // a window for the plain loop
  std::uint64_t contacts = 0, below_cutoff = 0;
  T last_contact{0};  // if there was one
  Ledger<T> lost;
  CutLog<T> left, right;           // at the cuts on either side
  FrontMove<T> to_left, to_right;  // at the ends of a line
};

template <Real T, class Law, class Masses> class Segment {
 public:
  using Scalar = T;
  using Chain = GapChain<T, Masses>;
  using Report = SegmentReport<T>;

  explicit Segment(const Chain& chain) : line_(chain.line(), 0), queue_(16, Chain::keys_are_exact) {}

  // Makes all contacts up to the local time `stop`, on a copy of the chain's gaps, and puts those that are the
  // segment's own into `after`, at the chain's slots. Several segments of one chain may do so at once.
  void run(const Chain& chain, const Law& law, const Own& own, std::size_t ghosts, const T& stop,
           typename Chain::Line::Gaps& after, Report& report) {
    Made made = Made::contested;
    for (const bool exact : {false, true}) {
      if (made != Made::contested) break;
      take(chain, own, ghosts, report);
      made = exact ? make_contacts<true>(law, stop, report) : make_contacts<false>(law, stop, report);
    }
    report.plain = made != Made::all || asks(noticed_, Notice::origin_must_move) ||
                   asks(noticed_, Notice::gap_below_floor) || asks(noticed_, Notice::needs_slots);
    if (report.plain) return;
    report.lost = line_.gaps.ledger();
    // At the end of a row the gap beside the front is held too.
    const Slot first = left_end_ ? std::max(first_, std::min(own_first_, reached_left_ - 1)) : own_first_;
    const Slot last = right_end_ ? std::min(last_, std::max(own_last_, reached_right_ + 1)) : own_last_;
    each_piece(first, last,
               [&](Slot here, Slot there, std::size_t gaps) { after.copy(line_.gaps, here, there, gaps); });
    report.to_left.reached = in_chain(reached_left_);
    report.to_right.reached = in_chain(reached_right_);
  }

  // ---- of the copy, for Ties
  Slot left(Slot s) const { return s - 1; }
  Slot right(Slot s) const { return s + 1; }
  T due(Slot s) const { return line_.due(s); }

 private:
  enum class Made { all, contested, out_of_order };
  static constexpr Slot first_ = 2;  // of the gaps held; beside them stands one that never closes

  Slot here(Slot there) const { return static_cast<Slot>(static_cast<std::ptrdiff_t>(there) - offset_); }
  Slot in_chain(Slot s) const {
    std::ptrdiff_t slot = static_cast<std::ptrdiff_t>(s) + offset_;
    if (ring_ > 0) slot += slot < ring_first_ ? ring_ : slot >= ring_first_ + ring_ ? -ring_ : 0;
    return static_cast<Slot>(slot);
  }

  // Calls copy(here, in the chain, how many) for runs of slots that follow each other in both.
  template <class Copy> void each_piece(Slot from, Slot to, Copy copy) const {
    while (from <= to) {
      const Slot there = in_chain(from);
      const auto seam = static_cast<std::size_t>(ring_first_ + ring_) - there;  // slots up to there
      const std::size_t gaps = ring_ > 0 ? std::min(to + 1 - from, seam) : to + 1 - from;
      copy(from, there, gaps);
      from += gaps;
    }
  }

  // Copies what belongs to the segment, and fills the queue.
  void take(const Chain& chain, const Own& own, std::size_t ghosts, Report& report) {
    ring_first_ = static_cast<std::ptrdiff_t>(chain.first());
    ring_ = chain.on_ring() ? static_cast<std::ptrdiff_t>(chain.last() + 1 - chain.first()) : 0;
    left_end_ = !chain.on_ring() && own.first == chain.first();
    right_end_ = !chain.on_ring() && own.first + own.gaps > chain.last();
    // At the end of a row bodies are taken along that the front may reach.
    const auto beside = [&](bool at_end, std::size_t within_reach, std::size_t held) {
      return chain.on_ring() ? ghosts : std::min(ghosts, at_end ? within_reach : held);
    };
    const std::size_t before = beside(left_end_, chain.within_reach_left(), own.first - chain.first());
    const std::size_t behind = beside(right_end_, chain.within_reach_right(), chain.last() + 1 - own.first - own.gaps);
    own_first_ = first_ + before;
    own_last_ = own_first_ + own.gaps - 1;
    last_ = own_last_ + behind;
    offset_ = static_cast<std::ptrdiff_t>(own.first) - static_cast<std::ptrdiff_t>(own_first_);
    across_seam_ = in_chain(first_) + (last_ - first_) != in_chain(last_);
    last_gap_ = chain.bodies().count() - 2;

    line_.resemble(chain.line(), last_ + 3, offset_);
    const Slot from = left_end_ ? own_first_ : first_, to = right_end_ ? own_last_ : last_;
    each_piece(from, to, [&](Slot here, Slot there, std::size_t gaps) { line_.copy(chain.line(), there, here, gaps); });
    for (Slot s = first_; s < from; ++s) line_.load(s, chain.bodies(), T(0)), line_.load_mass(s, chain.bodies());
    for (Slot s = to + 1; s <= last_; ++s) line_.load(s, chain.bodies(), T(0)), line_.load_mass(s + 1, chain.bodies());
    line_.wall(first_ - 1);
    line_.wall(last_ + 1);
    reached_left_ = left_end_ ? here(chain.front_slot_left()) : own_first_;
    reached_right_ = right_end_ ? here(chain.front_slot_right()) : own_last_;
    set_inner();

    if (queue_.slots() < last_ + 3 || queue_.slots() > 4 * last_) queue_ = EventQueue(last_ + 3, Chain::keys_are_exact);
    queue_.clear();
    for (Slot s = first_; s <= last_; ++s) queue_.set(s, line_.queue_due(s));
    queue_.rebuild(0, queue_.slots() - 1);
    ties_.forget();
    noticed_ = Notice::none;
    report.contacts = report.below_cutoff = 0;
    report.left.clear(), report.right.clear();
    report.to_left.at_end.clear(), report.to_right.at_end.clear();
  }

  // The event loop of a segment.
  template <bool exact> Made make_contacts(const Law& law, const T& stop, Report& report) {
    const double latest = line_.gaps.queue_time(stop);
    const EventQueue::Key certainly_before = queue_.certainly_before(latest);
    const EventQueue::Key possibly_before = queue_.possibly_before(latest);
    EventQueue::Key passed = 0;  // of the contact before: all that may be at the same time
    T time = T(0);
    Slot before = 0;  // slot of the contact before
    for (std::uint64_t made = 0;; ++made) {
      const EventQueue::Key next = queue_.next();
      Slot s = queue_.slot(next);
      if (next >= certainly_before) [[unlikely]] {
        if (next > possibly_before) return Made::all;
        const bool contested = queue_.contested();
        if (contested && !exact) return Made::contested;
        if (contested) s = ties_.first(queue_, *this, made);
        if (!(due(s) <= stop)) return Made::all;
      }
      if constexpr (exact) {
        if (queue_.contested()) {
          if (across_seam_) return Made::out_of_order;  // positions are not in order there
          s = ties_.first(queue_, *this, made);
        }
        const T now = due(s);
        if (made > 0 && (now < time || (now == time && s < before))) return Made::out_of_order;
        time = now;
        before = s;
      } else {
        if (next <= passed || queue_.close(next, s - 1) || queue_.close(next, s + 1)) return Made::contested;
        passed = queue_.no_later_than(next);
        time = due(s);
      }
      const Outcome<T> outcome = law(line_.closing(s), line_.masses.of_pair(s));
      const bool own = s - inner_first_ < inner_ || at_edge(s, time, outcome, report);
      const Collision<T> collision = line_.strike(s - 1, s, s + 1, time, outcome, Notice::none);
      queue_.replace(s, collision.due_left, collision.due, collision.due_right);
      if (!own) [[unlikely]]
        continue;
      ++report.contacts;
      report.below_cutoff += outcome.below_cutoff;
      report.last_contact = time;
      line_.gaps.lose(s, outcome.energy_lost);
      noticed_ |= collision.notice;
    }
  }

  // A contact that may be at a cut or a front, or beyond. Whether it is at a gap of the segment's own.
  [[gnu::noinline]] bool at_edge(Slot s, const T& time, const Outcome<T>& outcome, Report& report) {
    const T& closing = line_.closing(s);
    if (!left_end_ && s + 1 - own_first_ < 2) report.left.push_back({s == own_first_, time, closing});
    if (!right_end_ && s - own_last_ < 2) report.right.push_back({s != own_last_, time, closing});
    if (left_end_ && s <= reached_left_) {
      reached_left_ = s;
      if (line_.body(s) == 0)
        report.to_left.at_end.push_back({time, outcome.to_left});
      else if (s == first_)
        noticed_ |= Notice::needs_slots;  // no more bodies have been taken along
    }
    if (right_end_ && s >= reached_right_) {
      reached_right_ = s;
      if (line_.body(s) == last_gap_)
        report.to_right.at_end.push_back({time, outcome.to_right});
      else if (s == last_)
        noticed_ |= Notice::needs_slots;
    }
    set_inner();
    return (left_end_ || s >= own_first_) && (right_end_ || s <= own_last_);
  }
  void set_inner() {
    inner_first_ = reached_left_ + 1;
    inner_ = reached_right_ > inner_first_ ? reached_right_ - inner_first_ : 0;
  }

  GapLine<T, Masses> line_;
  EventQueue queue_;
  Ties<Segment> ties_;
  Slot own_first_ = 0, own_last_ = 0, last_ = 0;
  std::ptrdiff_t offset_ = 0;                 // from a slot here to the chain's
  std::ptrdiff_t ring_first_ = 0, ring_ = 0;  // slots of a ring
  bool left_end_ = false, right_end_ = false, across_seam_ = false;
  Slot reached_left_ = 0, reached_right_ = 0;  // fronts; at a cut the gap owned beside it
  Slot inner_first_ = 0, inner_ = 0;           // between them
  BodyIndex last_gap_ = 0;
  Notice noticed_ = Notice::none;
};

}  // namespace cradle
