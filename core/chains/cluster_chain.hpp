#pragma once
// The chain for laws whose particles merge or pass through each other: gaps and particle velocities, for any masses.
//
// It holds velocities, not closing speeds as gap_chain.hpp does: a collision changes the velocity of a cluster of mass
// M by J/M, 1e-8 and less. The closing speed between the cluster and a light particle is of order one; rounding it
// would lose such a kick, and these errors would drift into the gaps. The cluster's own velocity, in the frame in which
// the total momentum vanishes, is small and keeps the kick.
//
// For cells and their collisions see cluster_line.hpp. Rows are streamed (held_range.hpp).
//
// On a ring the cells are linked in a circle. Positions are counted once round from the first cell; a particle that
// moves from the first cell to the last one, across the seam, appears one circumference L further right. The mass that
// has crossed is recorded, since each crossing moves the centre of mass of these positions by L times its share.

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/cluster_places.hpp"

namespace cradle {

// Consecutive cells in consecutive slots.
struct CellsInARow {
  Slot first;
  std::size_t count;
};

// A front after a time slab: its slot, and how many particles of the row beyond it have been taken in.
struct ClusterFront {
  Slot slot = 0;
  ParticleIndex taken = 0;
};

template <Real T> class ClusterChain : public ClusterPlaces<T> {
  using Places = ClusterPlaces<T>;

 public:
  using Places::closing;
  using Places::slots, Places::first, Places::last, Places::left, Places::right, Places::particle, Places::on_ring;
  using typename Places::Line;

  // Holds the particles at the gaps in motion and streams the others in as fronts reach them; `hold_all`: holds all.
  ClusterChain(const std::shared_ptr<const Particles<T>>& particles, const T& start, bool hold_all = false)
      : ClusterChain(particles, start,
                     hold_all || particles->on_ring() ? GapRange{0, particles->count() - 2}
                                                      : particles->gaps_in_motion()) {}

  // ---- events (inlined by force, see gap_line.hpp)
  template <class Law>
  [[gnu::always_inline]] CollisionResult<T> collide(const Law& law, Slot s,
                                                    const T& time) requires(!LawWithMemory<Law, T>) {
    const Outcome<T> outcome = law(closing(s), line_.masses(s));
    Notice notice = Notice::none;
    if (!range_.inside(s, right(s))) [[unlikely]] {
      if (on_ring())
        cross_seam(s, outcome.event);
      else
        notice = widen(s, time);
    }
    beyond_ = right(s);
    if (outcome.event == Event::merge) notice |= merge(s, std::exchange(beyond_, s));
    return line_.strike(s, time, outcome, notice);
  }

  T move_origin(const T& local) {
    line_.gaps.move_origin(local, [this](auto&& each) {
      for (Slot s = first(); s <= last(); ++s)
        if (!line_.vacant(s)) each(s, closing(s));
    });
    return T(0);
  }

  // Drops vacant cells.
  void make_room() {
    std::vector<Slot> kept;
    kept.reserve(last() + 1 - first());
    kept.push_back(first());
    while (kept.back() != last()) kept.push_back(right(kept.back()));
    const auto beyond = std::lower_bound(kept.begin(), kept.end(), beyond_) - kept.begin();
    lay_out(kept, kept.size());
    link();
    beyond_ = first() + static_cast<Slot>(beyond);
  }

  T nearest_gap(Slot s) const {
    const T far = far_away<T>();
    const Slot p = left(s), n = beyond_;
    const T on_left = !on_ring() && p < first() ? far : line_.gaps[p].gap,
            on_right = !on_ring() && n >= last() ? far : line_.gaps[n].gap;
    return on_left < on_right ? on_left : on_right;
  }

  static auto state(auto& self) {
    return fields(self.line_, self.range_, self.vacated_, self.active_, self.beyond_, self.centre_, self.carried_);
  }
  void loaded() const {
    const auto& cells = line_.gaps;
    require_state(range_.fits(slots(), particles_->count()) && range_.on_ring() == particles_->on_ring(), "slots");
    require_state(beyond_ < slots() && active_ >= 0 && active_ <= particles_->count() && vacated_ <= slots(), "counts");
    const T heaviest = T(2) * particles_->total_mass();
    for (Slot s = 0; s < slots(); ++s)
      require_state(cells[s].left < slots() && cells[s].right < slots() && cells[s].particle >= 0 &&
                        cells[s].particle < particles_->count() && is_positive(cells[s].mass),
                    "cells");
    // Follows the links from the first cell to the last; only vacant cells are between them.
    int fronts = range_.has_fronts() ? 0 : 2;
    for (Slot s = first();; s = right(s)) {
      require_state(line_.fits(s, !on_ring() && s == last()) && cells[s].mass < heaviest, "numbers");
      fronts += range_.has_fronts() ? (s == range_.front_left()) + (s == range_.front_right()) : 0;
      if (s == last()) break;
      require_state(right(s) > s && right(s) <= last() && left(right(s)) == s, "links");
      for (Slot v = s + 1; v < right(s); ++v) require_state(line_.vacant(v), "vacant cells");
    }
    require_state(fronts == 2, "fronts");
    require_state(on_ring() ? right(last()) == first() && left(first()) == last() && !range_.front_right()
                            : line_.ends_beside(first(), last()),
                  "ends");
  }

  // ---- for segments (segments.hpp)
  bool cramped(std::size_t particles) const {
    return sparse() || range_.cramped(slots(), static_cast<ParticleIndex>(particles));
  }
  // The particle that continues the row at an end, as at the start, with the gap behind it if there is one.
  Cell<T> undisturbed_cell(ParticleIndex b) const {
    return load(b, this->local_time(this->start()), b + 1 < particles_->count());
  }
  // Replaces the cells by those after a time slab, and enters the mass that crossed the seam, collision by collision.
  void continue_with(typename Line::Gaps& after, std::vector<CellsInARow> cells, const std::vector<T>& carried,
                     const ClusterFront& on_left, const ClusterFront& on_right) {
    line_.gaps.swap_gaps(after);
    std::sort(cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::size_t held = 0;
    Slot before = cells.back().first + cells.back().count - 1;
    range_.take_in(on_left.taken, on_right.taken);
    range_.hold(cells.front().first, before);
    for (const auto& [slot, count] : cells) {
      line_.link(before, slot);
      before = slot + count - 1;
      held += count;
    }
    vacated_ = last() + 1 - first() - held;
    active_ = static_cast<ParticleIndex>(held);
    for (const T& mass : carried) carried_.add(mass);
    if (on_ring()) return;
    range_.place_fronts(on_left.slot, on_right.slot);
    active_ -= static_cast<ParticleIndex>((on_left.slot - first()) + (last() - on_right.slot));
    line_.place_end(first() - 1, first());
    line_.place_end(last() + 1, last());
    if (last() > on_right.slot)
      line_.gaps.start(last(), T(1), T(0));  // its gap is that at the start until it is reached
    find_centre();
  }

 private:
  using Places::frame_, Places::centre_, Places::carried_;
  using Places::line_, Places::range_, Places::particles_, Places::vacated_, Places::active_, Places::beyond_;

  ClusterChain(const std::shared_ptr<const Particles<T>>& particles, const T& start, GapRange held)
      : Places(particles, start, held) {
    const auto cells = static_cast<std::size_t>(held.last - held.first + 2);
    const std::size_t needed = range_.lay_out(cells, growth(cells));
    line_.gaps.fill(needed, first(), cells, [&](std::size_t k) {
      return load(held.first + static_cast<ParticleIndex>(k), T(0), k + 1 < cells || on_ring());
    });
    link();
    if (on_ring()) active_ = particles_->count();
  }

  // Vacant cells make the queue's tree deep, and put neighbours into different branches of it.
  bool sparse() const { return 2 * vacated_ > last() - first() + 24; }

  // A cell as at the start. The gap right of the last held particle is not computed: it would draw random numbers in
  // vain.
  Cell<T> load(ParticleIndex b, const T& time, bool with_gap) const {
    return {
        {with_gap ? particles_->gap(b) : T(1), time}, particles_->relative_velocity(b, frame_), particles_->mass(b), b};
  }

  static ParticleIndex growth(std::size_t held) {
    return static_cast<ParticleIndex>(std::max<std::size_t>(held / 2, 24));
  }
  // Changes to enough slots for the zone to grow by half on either side, with the cells at `kept`.
  void lay_out(const std::vector<Slot>& kept, std::size_t held) {
    const std::size_t needed = range_.lay_out(held, growth(held), kept);
    line_.gaps.lay_out(needed, first(), kept);
    vacated_ = 0;
  }
  // Links the held cells in order; the others are vacant, linked to themselves.
  void link() {
    for (Slot s = 0; s < slots(); ++s) {
      const bool held = s >= first() && s <= last();
      line_.gaps[s].left = held ? s - 1 : s;
      line_.gaps[s].right = held ? s + 1 : s;
    }
    if (on_ring()) {
      line_.link(last(), first());
    } else {
      line_.place_end(first() - 1, first());
      line_.place_end(last() + 1, last());
    }
    for (Slot s = first(); s <= last(); ++s) line_.gaps.foresee(s, closing(s));
  }

  // A collision at an end of the active zone: takes in the next particle there, if there is one.
  Notice widen(Slot s, const T& time) {
    const Slot n = right(s);
    const auto count = [&](Slot from, Slot to) {  // held cells from one slot to before the other
      ParticleIndex cells = 0;
      for (; from < to; from = right(from)) ++cells;
      return cells;
    };
    active_ = range_.has_fronts() ? active_ + count(s, range_.front_left()) + count(range_.front_right(), n) : 2;
    range_.reach(s, n);
    if (range_.beyond_left(s) == HeldRange::Beyond::row) {
      const ParticleIndex b = range_.take_in_left();
      line_.gaps.put(first(), load(b, time, true));
      line_.link(first(), s);
      line_.place_end(first() - 1, first());
    }
    if (range_.beyond_right(n) == HeldRange::Beyond::row) {
      // The gap right of n is new; its state is that at the start.
      line_.gaps.start(n, particles_->gap(particle(n)), time);
      const ParticleIndex b = range_.take_in_right(particles_->count());
      line_.gaps.put(last(), load(b, time, false));
      line_.link(n, last());
      line_.place_end(last() + 1, last());
    }
    find_centre();
    return range_.cramped(slots()) || sparse() ? Notice::needs_slots : Notice::none;
  }

  void find_centre() {
    const bool all_collided = range_.front_left() == first() && range_.front_right() == last();
    if (all_collided && !centre_) centre_ = particles_->centre_of_mass();
  }

  // Records the mass that passes from the first cell of a ring to the last one, which is one turn to the right.
  void cross_seam(Slot s, Event event) {
    const Slot n = right(s);
    if (n > s || event == Event::bounce) return;
    carried_.add(line_.gaps[n].mass);
    if (event == Event::pass) carried_.add(T(-line_.gaps[s].mass));
  }

  // The particle at `gone` becomes part of the one at s.
  Notice merge(Slot s, Slot gone) {
    range_.merge(s, gone, right(gone));
    --active_;
    ++vacated_;
    return sparse() ? Notice::needs_slots : Notice::none;
  }
};

}  // namespace cradle
