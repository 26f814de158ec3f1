#pragma once
// A segment's part of the chain in gaps and closing speeds (segments.hpp). A collision at the gap i reads and changes
// the gaps i - 1, i and i + 1. A collision beside a cut is logged: its gap, exact time and closing speed.

#include <algorithm>
#include <tuple>

#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/parallel/segment.hpp"

namespace cradle {

template <Real T> struct GapCollision {
  bool behind;  // at the gap right of the cut
  T time, closing;
  friend bool operator==(const GapCollision&, const GapCollision&) = default;
};

template <Real T, class Masses> class GapSegment {
 public:
  using Scalar = T;
  using Chain = GapChain<T, Masses>;
  using Gaps = typename Chain::Line::Gaps;
  using Observed = ObservedCollision<T>;
  struct Report : SegmentReport<T, GapCollision<T>, Observed> {
    FrontMove<T> to_left, to_right;  // at the ends of a line
    auto logs() { return std::tie(this->left, this->right, this->observed, to_left.at_end, to_right.at_end); }
  };

  explicit GapSegment(const Chain& chain) : line_(chain.line(), 0), wall_gaps_(chain.wall_gaps()) {}

  // ---- slots of the copy: ghosts and what is owned; beside them stands a gap that never closes
  static constexpr Slot first() { return first_; }
  Slot last() const { return last_; }
  Slot left(Slot s) const { return s - 1; }
  Slot right(Slot s) const { return s + 1; }
  T due(Slot s) const { return wall_gaps_.due(line_, s); }
  double queue_key(Slot s) {
    if constexpr (!Gaps::keys_are_exact)
      if (wall_gaps_.pulls(line_.particle(s))) return wall_gaps_.pulled_queue_due(line_, s);
    return line_.gaps.queue_key(s, line_.closing(s));
  }
  double queue_time(const T& local) const { return line_.gaps.queue_time(local); }
  bool across_seam() const { return across_seam_; }
  bool is_ring() const { return is_ring_; }  // a whole one, without cuts
  void lose(Slot s, const T& energy) { line_.gaps.lose(s, energy); }
  // The collision at a gap of the segment's own, before it is made.
  Observed observed(Slot s, const T& time) const {
    return {time, closing_when_due(s),
            ring_ > 0 ? static_cast<ParticleIndex>(in_chain(s)) - ring_first_ : line_.particle(s)};
  }
  // The particles on its left and right.
  static std::pair<ParticleIndex, ParticleIndex> particles(const Chain& chain, const Observed& collision) {
    const ParticleIndex left = collision.place;
    return {left, chain.on_ring() && left + 1 == chain.count() ? 0 : left + 1};
  }

  // Copies what belongs to the segment. Returns true: unlike clusters, gaps never vanish.
  bool take(const Chain& chain, const OwnedGaps& own, std::size_t ghosts, Report& report) {
    report.to_left.at_end.clear(), report.to_right.at_end.clear();
    ring_first_ = static_cast<std::ptrdiff_t>(chain.first());
    ring_ = chain.on_ring() ? static_cast<std::ptrdiff_t>(chain.last() + 1 - chain.first()) : 0;
    left_end_ = !chain.on_ring() && own.first == chain.first();
    right_end_ = !chain.on_ring() && own.first + own.gaps > chain.last();
    // At the end of a row particles are taken along that the front may reach.
    is_ring_ = ring_ > 0 && own.gaps == chain.last() + 1 - chain.first();
    const auto beside = [&](bool at_end, std::size_t within_reach, std::size_t held) {
      return is_ring_ ? 0 : chain.on_ring() ? ghosts : std::min(ghosts, at_end ? within_reach : held);
    };
    const std::size_t before = beside(left_end_, chain.range().free_left(), own.first - chain.first());
    const std::size_t behind =
        beside(right_end_, chain.range().free_right(chain.slots()), chain.last() + 1 - own.first - own.gaps);
    own_first_ = first_ + before;
    own_last_ = own_first_ + own.gaps - 1;
    last_ = own_last_ + behind;
    offset_ = static_cast<std::ptrdiff_t>(own.first) - static_cast<std::ptrdiff_t>(own_first_);
    across_seam_ = in_chain(first_) + (last_ - first_) != in_chain(last_);
    gaps_ = chain.particles().gaps();
    walls_ = chain.walls();
    wall_gaps_ = chain.wall_gaps();

    line_.resemble(chain.line(), last_ + 3, offset_);
    const Slot from = left_end_ ? own_first_ : first_, to = right_end_ ? own_last_ : last_;
    each_piece(from, to, [&](Slot here, Slot there, std::size_t gaps) { line_.copy(chain.line(), there, here, gaps); });
    const T start = chain.local_time(chain.start());
    for (Slot s = first_; s < from; ++s) line_.load(s, chain.particles(), start), line_.load_mass(s, chain.particles());
    for (Slot s = to + 1; s <= last_; ++s)
      line_.load(s, chain.particles(), start), line_.load_mass(s + 1, chain.particles());
    line_.block(first_ - 1);
    line_.block(last_ + 1);
    reached_left_ = left_end_ ? here(chain.range().front_left()) : own_first_;
    reached_right_ = right_end_ ? here(chain.range().front_right()) : own_last_;
    set_inner();
    return true;
  }

  template <class Law>
  [[gnu::always_inline]] OwnedResult<T> collide(const Law& law, Slot s, const T& time, Report& report) {
    Outcome<T> outcome = law(line_.closing(s), line_.masses.of_pair(s));
    Edge edge;
    if (!(s - inner_first_ < inner_count_)) [[unlikely]] {
      if (walls_.beside(line_.particle(s))) outcome = at_wall(law, s, time);
      edge = at_edge(s, time, outcome, report);
      if (wall_gaps_.anywhere()) return {strike_at_edge(s - 1, s, s + 1, time, outcome, edge.notice), edge.own};
    }
    return {line_.strike(s - 1, s, s + 1, time, outcome, edge.notice), edge.own};
  }

  // Puts the segment's own gaps into `after`.
  void give(const Chain&, const OwnedGaps&, Gaps& after, Report& report) const {
    report.lost = line_.gaps.ledger();
    // At the end of a row the gap beside the front is held too.
    const Slot first = left_end_ ? std::max(first_, std::min(own_first_, reached_left_ - 1)) : own_first_;
    const Slot last = right_end_ ? std::min(last_, std::max(own_last_, reached_right_ + 1)) : own_last_;
    each_piece(first, last,
               [&](Slot here, Slot there, std::size_t gaps) { after.copy(line_.gaps, here, there, gaps); });
    report.to_left.reached = in_chain(reached_left_);
    report.to_right.reached = in_chain(reached_right_);
    report.to_left.wall = walls_.tally(End::left);
    report.to_right.wall = walls_.tally(End::right);
  }

  static bool fit(const std::vector<Report>&) { return true; }
  static void continue_with(Chain& chain, Gaps& after, const std::vector<Report>& reports) {
    chain.continue_with(after, reports.front().to_left, reports.back().to_right);
  }

 private:
  static constexpr Slot first_ = 2;
  struct Edge {
    bool own = true;
    Notice notice = Notice::none;
  };

  Slot here(Slot there) const { return static_cast<Slot>(static_cast<std::ptrdiff_t>(there) - offset_); }
  Slot in_chain(Slot s) const {
    std::ptrdiff_t slot = static_cast<std::ptrdiff_t>(s) + offset_;
    if (ring_ > 0 && (slot < ring_first_ || slot >= ring_first_ + ring_)) {
      slot = (slot - ring_first_) % ring_ + ring_first_;
      if (slot < ring_first_) slot += ring_;
    }
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

  T closing_when_due(Slot s) const { return wall_gaps_.closing_when_due(line_, s); }
  template <class Law> [[gnu::noinline]] Outcome<T> at_wall(const Law& law, Slot s, const T& time) {
    const ParticleIndex gap = line_.particle(s);
    const T& mass = line_.masses[walls_.left_of(gap) ? s + 1 : s];
    if (!wall_gaps_.anywhere()) return walls_.strike(gap, line_.closing(s), mass);
    const Pair<T> elapsed = line_.gaps.clock().since_start(time);
    return with_law(law, [&](const auto& own) {
      return wall_gaps_.strike_wall(walls_, gap, own, closing_when_due(s), mass, elapsed);
    });
  }
  // Where anything falls or is shaken, collisions at walls and beside gaps to them have rules of their own.
  CollisionResult<T> strike_at_edge(Slot p, Slot s, Slot n, const T& time, const Outcome<T>& outcome, Notice notice) {
    if (!wall_gaps_.anywhere()) return line_.strike(p, s, n, time, outcome, notice);
    return wall_gaps_.strike(line_, p, s, n, time, outcome, notice, 0, [] { return Notice::none; });
  }
  // Logs a collision that is beside a cut, moves a front that it is at, and says whether its gap is the segment's own.
  [[gnu::noinline]] Edge at_edge(Slot s, const T& time, const Outcome<T>& outcome, Report& report) {
    const T closing = closing_when_due(s);
    Notice notice = Notice::none;
    if (is_ring_) return {};
    if (!left_end_ && s + 1 - own_first_ < 2) report.left.push_back({s == own_first_, time, closing});
    if (!right_end_ && s - own_last_ < 2) report.right.push_back({s != own_last_, time, closing});
    const auto reach = [&](bool at_wall, ParticleIndex end, Slot outermost, FrontMove<T>& front, const T& handed) {
      if (at_wall) return;  // nothing to follow, nothing beyond
      if (line_.particle(s) == end)
        front.at_end.push_back({time, handed});
      else if (s == outermost)
        notice = Notice::needs_slots;  // no more particles have been taken along
    };
    if (left_end_ && s <= reached_left_) {
      reached_left_ = s;
      reach(walls_.left_of(line_.particle(s)), gaps_.first, first_, report.to_left, outcome.to_left);
    }
    if (right_end_ && s >= reached_right_) {
      reached_right_ = s;
      reach(walls_.right_of(line_.particle(s)), gaps_.last, last_, report.to_right, outcome.to_right);
    }
    set_inner();
    return {(left_end_ || s >= own_first_) && (right_end_ || s <= own_last_), notice};
  }
  void set_inner() {
    constexpr std::size_t radius = 8;  // of a decision in steps, over the seam
    if (is_ring_) return void((inner_first_ = first_ + radius, inner_count_ = last_ + 1 - first_ - 2 * radius));
    // Collisions beside a curved gap are not inner ones either.
    const bool curved = wall_gaps_.anywhere();
    inner_first_ = reached_left_ + 1 + (curved && left_end_);
    const Slot end = reached_right_ - (curved && right_end_);
    inner_count_ = end > inner_first_ ? end - inner_first_ : 0;
  }

  // ---- for steps (steps/stepped.hpp)
  template <class Law, class Part> friend struct Stepped;
  template <class Part> friend class AroundSteps;
  bool curved() const { return wall_gaps_.anywhere(); }
  template <class Law> Outcome<T> outcome_at_edge(const Law& law, Slot s, const T& time) {
    return walls_.beside(line_.particle(s)) ? at_wall(law, s, time) : law(line_.closing(s), line_.masses.of_pair(s));
  }
  // What collisions at edges change.
  auto edges() { return std::tie(reached_left_, reached_right_, walls_); }

  GapLine<T, Masses> line_;
  Slot own_first_ = 0, own_last_ = 0, last_ = 0;
  std::ptrdiff_t offset_ = 0;                 // from a slot here to the chain's
  std::ptrdiff_t ring_first_ = 0, ring_ = 0;  // slots of a ring
  bool left_end_ = false, right_end_ = false, across_seam_ = false, is_ring_ = false;
  Slot reached_left_ = 0, reached_right_ = 0;  // fronts; at a cut the gap owned beside it
  Slot inner_first_ = 0, inner_count_ = 0;     // first inner slot, between them, and how many there are
  GapRange gaps_{0, 0};                        // all that there are on the line
  Walls<T> walls_;
  WallGaps<GapLine<T, Masses>> wall_gaps_;  // no particles rest there
};

template <Real T, class Masses> struct PartOf<GapChain<T, Masses>> { using Type = GapSegment<T, Masses>; };

}  // namespace cradle
