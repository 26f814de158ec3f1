#pragma once
// A segment's part of the chain in gaps and particle velocities, on a ring (segments.hpp). A collision at the gap
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
// If positions are counted from the first cell, mass that crosses the seam is recorded in the order in which it
// crosses. If two segments have such collisions in one time slab, the plain loop computes the slab.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

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
    std::vector<CellsInARow> cells;  // of the segment's own that there are still, in `after`
    std::vector<T> carried;          // mass across the seam
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
    Slot there = own.first;
    std::size_t held = 0;
    each_slot(chain, own, [&](Slot s) {
      if (cells.vacant(s)) return;
      if (held++ == 0) there = s;
    });
    const auto others = static_cast<std::size_t>(chain.collided_particles()) - held;
    report.nothing_left = held == 0;
    report.plain = others < 2;
    if (report.nothing_left || report.plain) return false;
    // No particle is held twice.
    const std::size_t beside = std::min(ghosts, others / 2);
    own_first_ = first_ + beside;
    own_last_ = own_first_ + held - 1;
    last_ = own_last_ + beside;
    seam_ = 0;
    line_.gaps.resemble(cells.gaps, last_ + 3);
    if (report.observe) place_.resize(last_ + 1);
    for (std::size_t k = 0; k < beside; ++k) there = cells.left(there);
    for (Slot s = first_; s <= last_; ++s, there = cells.right(there)) {
      line_.gaps.copy(cells.gaps, there, s, 1);
      if (report.observe) place_[s] = chain.place(there);
      line_.link(s - 1, s);
      if (cells.right(there) <= there && s < last_) seam_ = s;
    }
    line_.place_end(first_ - 1, first_);
    line_.place_end(last_ + 1, last_);
    line_.gaps.forget(last_);
    return true;
  }

  template <class Law>
  [[gnu::always_inline]] OwnedResult<T> collide(const Law& law, Slot s, const T& time, Report& report) {
    const Outcome<T> outcome = law(line_.closing(s), line_.masses(s));
    bool own = true;
    const Slot n = right(s);
    if (!((s > own_first_) & (n < own_last_) & (s != seam_) & (n != seam_))) [[unlikely]]
      own = at_edge(s, time, outcome, report);
    return {line_.strike(s, time, outcome, Notice::none), own};
  }

  // Puts the segment's own cells into `after`, from its first slot on, and from the chain's first one behind the seam.
  void give(const Chain& chain, const OwnedGaps& own, Gaps& after, Report& report) const {
    report.lost = line_.gaps.ledger();
    // The seam may have been taken over by what is left of it.
    const bool behind_seam = own.first + own.gaps > chain.last() + 1 && seam_ < own_first_;
    Slot s = own_first_, there = behind_seam ? chain.first() : own.first, row = there;
    const auto end_row = [&] {
      if (there > row) report.cells.push_back({row, there - row});
    };
    for (bool more = true; more; s = right(s)) {
      after.copy(line_.gaps, s, there, 1);
      after[there].left = there - 1;
      after[there].right = there + 1;
      ++there;
      more = s != own_last_;
      if (s == seam_ && more) end_row(), row = there = chain.first();
    }
    end_row();
    each_slot(chain, own, [&](Slot slot) {
      for (const auto& [first, count] : report.cells)
        if (slot - first < count) return;
      after.put(slot, {{}, T(0), T(1), slot, slot, 0});
    });
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
    chain.continue_with(after, std::move(cells), carried);
  }

 private:
  using Collision = ClusterCollision<T>;
  static constexpr Slot first_ = 2;

  template <class Visit> static void each_slot(const Chain& chain, const OwnedGaps& own, Visit visit) {
    Slot s = own.first;
    for (std::size_t k = 0; k < own.gaps; ++k, s = s == chain.last() ? chain.first() : s + 1) visit(s);
  }

  typename Collision::Particle what(Slot s) const {
    const Cell<T>& cell = line_.gaps[s];
    return {cell.velocity, cell.mass, cell.particle};
  }

  // Handles a collision that may be at a cut or the seam, or beyond, and says whether it is the segment's own. Follows
  // the cuts and the seam where particles merge.
  [[gnu::noinline]] bool at_edge(Slot s, const T& time, const Outcome<T>& outcome, Report& report) {
    const Slot n = right(s);
    const bool merge = outcome.event == Event::merge;
    const bool own = s >= own_first_ && s <= own_last_;
    const auto enter = [&](std::vector<Collision>& log, bool behind) {
      log.push_back({behind, time, what(s), what(n)});
      if (!merge || behind) return;
      const Cell<T>& next = line_.gaps[n];
      log.push_back({true, time, what(n), what(right(n)), next.gap, next.time, line_.gaps.lag(n), line_.gaps.lost(n)});
    };
    if (n == own_first_ || s == own_first_) enter(report.left, s == own_first_);
    if (s == own_last_ || left(s) == own_last_) enter(report.right, s != own_last_);
    if (own && s == seam_ && outcome.event != Event::bounce) {
      report.carried.push_back(line_.gaps[n].mass);
      if (outcome.event == Event::pass) report.carried.push_back(T(-line_.gaps[s].mass));
    }
    if (merge) {
      report.nothing_left = n == own_first_ && n == own_last_;
      if (n == own_first_) own_first_ = right(n);
      if (n == own_last_) own_last_ = s;
      if (n == seam_) seam_ = s;
    }
    return own;
  }

  ClusterLine<T> line_;
  std::vector<ParticleIndex> place_;  // in the chain, of slots here, for observers
  Slot own_first_ = 0, own_last_ = 0, last_ = 0;
  Slot seam_ = 0;  // the last cell of the chain, if it is here and the first one too
};

template <Real T> struct PartOf<ClusterChain<T>> { using Type = ClusterSegment<T>; };

}  // namespace cradle
