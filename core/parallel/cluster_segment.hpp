#pragma once
// A segment's part of the chain in gaps and particle velocities (segments.hpp). A collision at the gap
// behind the particle l reads and changes that gap, the gaps on either side of it, and the particles l and r beside it.
// A cut is at a particle, the one on the right of the last gap before the cut. Both sides know this particle's velocity
// as long as they know the collisions at the two gaps beside it. These collisions are logged: the gap, the exact time,
// and the two that met.
//
// When particles merge, the gap between them vanishes. If the particles at the last gap before a cut merge, the merged
// particle stays in that gap's cell, and the gap behind it is the one that was the first behind the cut. This gap now
// belongs to the segment before the cut, which has had it as a ghost; the next gap is the first one behind the cut from
// then on. Both sides log all that they know of the gap, so that it is taken over as it should be. Any other merger is
// a collision like others. A segment whose last cell is absorbed from the left owns nothing any more: it is joined with
// its neighbours.
//
// On a ring, where positions are counted from the first cell, mass that crosses the seam is recorded in the order in
// which it crosses. If two segments have such collisions in one time slab, the plain loop computes the slab.

#include <algorithm>
#include <tuple>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/parallel/segment.hpp"

namespace cradle {

// A collision beside a cut; or a gap that a segment takes over then, and the particles beside it.
template <Real T> struct ClusterCollision {
  struct Particle {
    T velocity, mass;
    ParticleIndex particle;
    friend bool operator==(const Particle&, const Particle&) = default;
  };
  bool behind;  // at the gap right of the cut
  T time;
  Particle left, right;
  T gap{0}, gap_time{0}, lag{0}, lost{0};  // in a collision 0
  friend bool operator==(const ClusterCollision&, const ClusterCollision&) = default;
};

template <Real T> class ClusterSegment {
 public:
  using Scalar = T;
  using Chain = ClusterChain<T>;
  using Gaps = typename ClusterLine<T>::Gaps;
  struct Observed : ObservedCollision<T> {
    ParticleIndex left, right;
  };
  struct Report : SegmentReport<T, ClusterCollision<T>, Observed> {
    std::vector<CellsInARow> cells;        // of the segment's own that there are still, in `after`
    std::vector<T> carried;                // mass across the seam
    ClusterFront left_front, right_front;  // at the ends of a line
    auto logs() { return std::tie(this->left, this->right, carried); }
  };

  explicit ClusterSegment(const Chain& chain) : line_(chain.line(), 0) {}

  // ---- slots of the copy: ghosts and what is owned; beyond them something runs away
  static constexpr Slot first() { return first_; }
  Slot last() const { return last_; }
  Slot left(Slot s) const { return line_.left(s); }
  Slot right(Slot s) const { return line_.right(s); }
  T due(Slot s) const { return line_.due(s); }
  double queue_key(Slot s) { return line_.gaps.queue_key(s, line_.closing(s)); }
  double queue_time(const T& local) const { return line_.gaps.queue_time(local); }
  bool across_seam() const { return seam_ > 0; }
  static constexpr bool is_ring() { return false; }  // a whole one has no segment
  void lose(Slot s, const T& energy) { line_.gaps.lose(s, energy); }
  // The collision at a gap of the segment's own, before it is made.
  Observed observed(Slot s, const T& time) const {
    return {{time, line_.closing(s), place_[s]}, line_.gaps[s].particle, line_.gaps[right(s)].particle};
  }
  // The particles on its left and right.
  static std::pair<ParticleIndex, ParticleIndex> particles(const Chain&, const Observed& collision) {
    return {collision.left, collision.right};
  }

  // Copies what belongs to the segment; false where that is nothing, or where there are not enough particles around it.
  bool take(const Chain& chain, const OwnedGaps& own, std::size_t ghosts, Report& report) {
    report.cells.clear(), report.carried.clear();
    const auto& cells = chain.line();
    const HeldRange& range = chain.range();
    const bool ring = chain.on_ring();
    left_end_ = !ring && own.first == chain.first();
    right_end_ = !ring && own.first + own.gaps > chain.last();
    Slot from = own.first, to = from;
    std::size_t held = 0;
    each_slot(chain, own, [&](Slot s) {
      if (cells.vacant(s)) return;
      to = s;
      if (held++ == 0) from = s;
    });
    const auto others = static_cast<std::size_t>(chain.collided_particles()) - held;
    report.nothing_left = held == 0;
    report.plain = ring && others < 2;
    if (report.nothing_left || report.plain) return false;
    // No particle is held twice. On a ring no front runs through them, so that a small segment needs fewer.
    const std::size_t most = ring ? std::min({ghosts, others / 2, std::max<std::size_t>(held / 64, 24)}) : ghosts;
    std::size_t before = 0, behind = 0;
    for (; before < most && (ring || from != chain.first()); ++before) from = cells.left(from);
    for (; behind < most && (ring || to != chain.last()); ++behind) to = cells.right(to);
    // At the end of a row particles are taken along that the front may reach.
    along_left_ = left_end_ ? std::min(ghosts, range.free_left()) : 0;
    along_right_ = right_end_ ? std::min(ghosts, range.free_right(chain.slots())) : 0;
    own_first_ = first_ + before;
    own_last_ = first_ + along_left_ + before + held - 1 + along_right_;
    last_ = own_last_ + behind;
    seam_ = 0;
    more_left_ = range.unheld_left() > static_cast<ParticleIndex>(along_left_);
    more_right_ = range.unheld_right() > static_cast<ParticleIndex>(along_right_);
    line_.gaps.resemble(cells.gaps, last_ + 3);
    if (report.observe) place_.resize(last_ + 1);
    const Slot begin = first_ + along_left_, end = last_ - along_right_;  // of what is not taken along
    const Slot front_left = range.front_left(), front_right = range.front_right();
    for (Slot s = begin; s <= end; ++s) {  // one by one: where particles have merged, few are side by side
      line_.gaps.copy(cells.gaps, from, s);
      line_.gaps[s].left = s - 1, line_.gaps[s].right = s + 1;
      if (report.observe) place_[s] = chain.place(from);
      if (from == front_left) reached_left_ = s;
      if (from == front_right) reached_right_ = s;
      const Slot next = cells.right(from);
      if (ring && next < from && s < end) seam_ = s;
      from = next;
    }
    farthest_ = reached_right_;
    take_along(chain, report.observe);
    for (Slot s = first_; s < begin; ++s) line_.link(s, s + 1);
    for (Slot s = end; s < last_; ++s) line_.link(s, s + 1);
    line_.place_end(first_ - 1, first_);
    line_.place_end(last_ + 1, last_);
    line_.gaps.forget(last_);
    set_inner();
    return true;
  }

  template <class Law>
  [[gnu::always_inline]] OwnedResult<T> collide(const Law& law, Slot s, const T& time, Report& report) {
    const Outcome<T> outcome = law(line_.closing(s), line_.masses(s));
    Edge edge;
    const Slot n = right(s);
    if (!((s > inner_first_) & (n < inner_last_) & (s != seam_) & (n != seam_))) [[unlikely]]
      edge = at_edge(s, time, outcome, report);
    return {line_.strike(s, time, outcome, edge.notice), edge.own};
  }

  // Puts the segment's own cells into `after`, from its first slot on, and from the chain's first one behind the seam.
  // At the end of a row the particles that the front has reached are its own too, and the next one.
  void give(const Chain& chain, const OwnedGaps& own, Gaps& after, Report& report) const {
    report.lost = line_.gaps.ledger();
    const Slot begin = first_ + along_left_, end = last_ - along_right_;  // of what has not been taken along
    Slot s = own_first_, last = own_last_;
    if (left_end_) s = std::min(std::max(left(reached_left_), first_), line_.vacant(begin) ? last : begin);
    if (right_end_) last = std::max(std::min(right(reached_right_), own_last_), line_.vacant(end) ? s : end);
    report.left_front.taken = left_end_ ? static_cast<ParticleIndex>(begin - s) : 0;
    report.right_front.taken =
        static_cast<ParticleIndex>(right_end_ ? std::max(std::min(farthest_ + 1, last_), end) - end : 0);
    // Owned slots, up to the chain's last one and from its first one on.
    const Slot first_end = std::min(own.first + own.gaps, chain.last() + 1),
               second_end = chain.first() + (own.first + own.gaps - first_end);
    const auto vacate = [&](Slot from, Slot to) {
      for (; from < to; ++from) after.put(from, {{}, T(0), T(1), 0, from, from});
    };
    Slot there = own.first - static_cast<Slot>(report.left_front.taken);
    const auto go_on_behind_seam = [&] { vacate(there, first_end), there = chain.first(); };
    // The seam may have been taken over by what is left of it.
    bool behind_seam = second_end > chain.first() && seam_ < own_first_;
    if (behind_seam) go_on_behind_seam();
    for (Slot row = there;; s = right(s)) {
      after.copy(line_.gaps, s, there);
      after[there].left = there - 1, after[there].right = there + 1;
      if (s == reached_left_) report.left_front.slot = there;
      if (s == reached_right_) report.right_front.slot = there;
      ++there;
      if (s != last && s != seam_) continue;
      report.cells.push_back({row, there - row});
      if (s == last) break;
      go_on_behind_seam(), behind_seam = true;
      row = there;
    }
    vacate(there, behind_seam ? second_end : first_end);
    if (!behind_seam) vacate(chain.first(), second_end);
  }

  // False where the time slab is for the plain loop.
  static bool fit(const std::vector<Report>& reports) {
    return std::count_if(reports.begin(), reports.end(), [](const Report& r) { return !r.carried.empty(); }) < 2;
  }
  static void continue_with(Chain& chain, Gaps& after, const std::vector<Report>& reports) {
    std::vector<CellsInARow> cells;
    std::vector<T> carried;
    for (const Report& report : reports) {
      cells.insert(cells.end(), report.cells.begin(), report.cells.end());
      if (carried.empty()) carried = report.carried;
    }
    chain.continue_with(after, std::move(cells), carried, reports.front().left_front, reports.back().right_front);
  }

 private:
  using Collision = ClusterCollision<T>;
  static constexpr Slot first_ = 2;
  struct Edge {
    bool own = true;
    Notice notice = Notice::none;
  };

  template <class Visit> static void each_slot(const Chain& chain, const OwnedGaps& own, Visit visit) {
    Slot s = own.first;
    for (std::size_t k = 0; k < own.gaps; ++k, s = s == chain.last() ? chain.first() : s + 1) visit(s);
  }

  typename Collision::Particle what(Slot s) const {
    const Cell<T>& cell = line_.gaps[s];
    return {cell.velocity, cell.mass, cell.particle};
  }

  // The particles beyond both ends of a row, with the gaps between them.
  void take_along(const Chain& chain, bool observe) {
    const HeldRange& range = chain.range();
    const Slot begin = first_ + along_left_, end = last_ - along_right_;
    const auto place = [&](Slot s, Slot beside) {
      if (observe) place_[s] = place_[beside] + (s < beside ? -1 : 1);
    };
    ParticleIndex b = range.unheld_left();
    for (Slot s = begin; s-- > first_; place(s, s + 1)) line_.gaps.put(s, chain.undisturbed_cell(--b));
    b = chain.count() - range.unheld_right();
    for (Slot s = end + 1; s <= last_; ++s, ++b) {
      line_.gaps.put(s, chain.undisturbed_cell(b));
      place(s, s - 1);
    }
    if (last_ == end || along_right_ == 0) return;
    const Cell<T> at_end = chain.undisturbed_cell(chain.count() - range.unheld_right() - 1);
    line_.gaps.start(end, at_end.gap, at_end.time);
  }
  void set_inner() {
    inner_first_ = left_end_ ? reached_left_ : own_first_;
    inner_last_ = right_end_ ? reached_right_ : own_last_;
  }

  // Handles a collision that may be at a cut, a front or the seam, or beyond, and says whether it is the segment's own.
  // Follows the cuts, the fronts and the seam where particles merge.
  [[gnu::noinline]] Edge at_edge(Slot s, const T& time, const Outcome<T>& outcome, Report& report) {
    const Slot n = right(s);
    const bool merge = outcome.event == Event::merge;
    const bool own = s >= own_first_ && s <= own_last_;
    Notice notice = Notice::none;
    const auto enter = [&](std::vector<Collision>& log, bool behind) {
      log.push_back({behind, time, what(s), what(n)});
      if (!merge || behind) return;
      const Cell<T>& next = line_.gaps[n];
      log.push_back({true, time, what(n), what(right(n)), next.gap, next.time, line_.gaps.lag(n), line_.gaps.lost(n)});
    };
    if (!left_end_ && (n == own_first_ || s == own_first_)) enter(report.left, s == own_first_);
    if (!right_end_ && (s == own_last_ || left(s) == own_last_)) enter(report.right, s != own_last_);
    if (left_end_ && s <= reached_left_) {
      reached_left_ = s;
      if (s == first_ && more_left_) notice = Notice::needs_slots;
    }
    if (right_end_ && n >= reached_right_) {
      farthest_ = std::max(farthest_, n);
      reached_right_ = merge ? s : n;
      if (n == last_ && more_right_) notice = Notice::needs_slots;
    }
    if (own && s == seam_ && outcome.event != Event::bounce) {
      report.carried.push_back(line_.gaps[n].mass);
      if (outcome.event == Event::pass) report.carried.push_back(T(-line_.gaps[s].mass));
    }
    if (merge) {
      report.nothing_left = n == own_first_ && n == own_last_;
      if (n == own_first_) own_first_ = right(n);
      if (n == own_last_) own_last_ = s;
      if (n == seam_) seam_ = s;
      if (right_end_ && reached_right_ < own_first_) notice = Notice::needs_slots;  // the front is in another segment
    }
    set_inner();
    return {own, notice};
  }

  // ---- for steps (steps/stepped_clusters.hpp)
  template <class Law, class Part> friend struct Stepped;
  template <class Part> friend class AroundSteps;
  // What collisions at edges change.
  auto edges() { return std::tie(own_first_, own_last_, reached_left_, reached_right_, farthest_, seam_); }

  ClusterLine<T> line_;
  std::vector<ParticleIndex> place_;  // in the chain, of slots here, for observers
  Slot own_first_ = 0, own_last_ = 0, last_ = 0;
  bool left_end_ = false, right_end_ = false;     // whether the line ends here
  std::size_t along_left_ = 0, along_right_ = 0;  // particles of rows that have been taken along
  bool more_left_ = false, more_right_ = false;   // whether there are more of them
  Slot farthest_ = 0;                             // the slot farthest right that has had a collision
  Slot reached_left_ = 0, reached_right_ = 0;     // fronts
  Slot inner_first_ = 0, inner_last_ = 0;         // a collision between them concerns no cut and no front
  Slot seam_ = 0;                                 // the last cell of the chain, if it is here and the first one too
};

template <Real T> struct PartOf<ClusterChain<T>> { using Type = ClusterSegment<T>; };

}  // namespace cradle
