#pragma once
// The chain for laws whose bodies merge or pass through each other: gaps and body velocities, for any masses.
//
// Why velocities, where gap_chain.hpp keeps closing speeds: a contact changes the velocity of a cluster of mass M by
// J/M, 1e-8 and less. The closing speed between it and a light body is of order one and would round such a kick away,
// and what the closing speeds lose drifts into the gaps. The cluster's own velocity, in the frame in which the total
// momentum vanishes, is small itself and keeps the kick.
//
// A cell holds a body and the gap between it and the next one (timed_gaps.hpp). Cells are linked from left to right.
// When two bodies merge they go on in the left one's cell, and the right one's is vacated: links pass over it until the
// chain is laid out anew. Bodies that pass exchange cells, so that cells stay in the order of the line. Rows are
// streamed (window.hpp).
//
// Positions come from a body at an end that has not collided, else from the centre of mass, which moves uniformly. On a
// ring the cells are linked in a circle. Positions there are told once round from the first cell on, and a body that
// goes from the first cell to the last one, across the seam, is told one circumference L further right: the mass that
// has done so is kept account of, since the centre of mass as told jumps by L times its share.

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/anchor.hpp"
#include "cradle/core/collision.hpp"
#include "cradle/core/configuration.hpp"
#include "cradle/core/timed_gaps.hpp"
#include "cradle/core/window.hpp"

namespace cradle {

template <Real T> struct Cell : TimedGap<T> {
  T velocity{0}, mass{1};
  Slot left = 0, right = 0;
  BodyIndex body = 0;  // by whose number at the start a cluster goes: its heaviest one's
};

template <Real T> class ClusterChain {
 public:
  using Scalar = T;
  static constexpr bool may_collapse = false;
  static constexpr bool keys_are_exact = TimedGaps<T, Cell<T>, may_collapse>::keys_are_exact;

  // Holds the bodies at the gaps in motion and streams the others in as fronts reach them; `hold_all`: holds all.
  ClusterChain(std::shared_ptr<const Bodies<T>> bodies, const T& start, bool hold_all = false)
      : ClusterChain(bodies, start,
                     hold_all || bodies->on_ring() ? GapRange{0, bodies->count() - 2} : bodies->gaps_in_motion()) {}

  // ---- times: local ones are offsets from an origin that moves
  const Clock<T>& clock() const { return gaps_.clock(); }
  const T& start() const { return clock().start(); }
  T local_time(const T& time) const { return clock().offset(time); }
  Pair<T> stamp(const T& local) const { return clock().stamp(local); }
  double queue_time(const T& local) const { return gaps_.queue_time(local); }

  // ---- slots: cells held are first() to last(), vacant ones among them; the last one's gap is none
  std::size_t slots() const { return gaps_.slots(); }
  Slot first() const { return window_.first(); }
  Slot last() const { return window_.last(); }
  Slot left(Slot s) const { return gaps_[s].left; }
  Slot right(Slot s) const { return gaps_[s].right; }
  BodyIndex body(Slot s) const { return gaps_[s].body; }
  BodyIndex collided_bodies() const { return active_; }
  bool on_ring() const { return window_.on_ring(); }

  T due(Slot s) const { return gaps_.due(s, closing(s)); }
  double queue_due(Slot s) const { return vacant(s) ? EventQueue::never : gaps_.queue_due(s, closing(s)); }
  T closing(Slot s) const { return gaps_[s].velocity - gaps_[gaps_[s].right].velocity; }

  // ---- events (inlined by force, see gap_chain.hpp)
  template <class Law>
  [[gnu::always_inline]] Collision<T> collide(const Law& law, Slot s, const T& time) requires(!LawWithMemory<Law, T>) {
    Cell<T>& l = gaps_[s];
    const Outcome<T> outcome = law(closing(s), TwoMasses<T>{l.mass, gaps_[l.right].mass});
    const T since = gaps_.flown(s, time);
    Notice notice = of_flight(queue_time(since), queue_time(time));
    if (!window_.inside(s, l.right)) [[unlikely]] {
      if (on_ring())
        cross_seam(s, outcome.event);
      else
        notice |= widen(s, time);
    }
    const Slot p = l.left, n = l.right;
    Cell<T>& r = gaps_[n];
    const T closing_left = closing(p), closing_right = closing(n);
    const T before_left = l.velocity, before_right = r.velocity;
    const T slowed = before_left - outcome.to_left, sped = before_right + outcome.to_right;
    Slot beyond = n;
    if (outcome.event == Event::merge) {
      notice |= absorb_right(s, l.mass < r.mass ? sped : slowed);  // the heavier one's velocity hardly changes
      beyond = s;
    } else {
      gaps_.close(s, outcome.closing, since, time);
      const bool pass = outcome.event == Event::pass;
      l.velocity = pass ? sped : slowed;
      r.velocity = pass ? slowed : sped;
      if (pass) {
        std::swap(l.mass, r.mass);
        std::swap(l.body, r.body);
      }
    }
    notice |= kick(p, closing_left, before_left, l.velocity, time);
    notice |= kick(beyond, closing_right, gaps_[beyond].velocity, before_right, time);
    beyond_ = beyond;
    return {outcome, predict(p), predict(s), beyond == n ? predict(n) : EventQueue::never, notice, p, n};
  }

  T move_origin(const T& local) {
    gaps_.move_origin(local, [this](auto&& each) {
      for (Slot s = first(); s <= last(); ++s)
        if (!vacant(s)) each(s, closing(s));
    });
    return T(0);
  }

  // Drops vacant cells.
  void make_room() {
    std::vector<Slot> kept;
    kept.reserve(last() + 1 - first());
    kept.push_back(first());
    while (kept.back() != last()) kept.push_back(right(kept.back()));
    lay_out(kept, kept.size());
    link();
  }

  void set_floor(const T& floor) { gaps_.set_floor(floor); }
  // The smaller gap next to the last contact, as of its local time; an end of the line counts as far away.
  T nearest_gap(Slot s) const {
    const T far = far_away<T>();
    const Slot p = left(s), n = beyond_;
    const T on_left = !on_ring() && p < first() ? far : gaps_[p].gap,
            on_right = !on_ring() && n >= last() ? far : gaps_[n].gap;
    return on_left < on_right ? on_left : on_right;
  }
  const Account<T>& account() const { return gaps_.account(); }
  void lose(Slot s, const T& energy) { gaps_.lose(s, energy); }
  T energy_lost() const { return gaps_.energy_lost(first(), last()); }
  T time_resolution(Slot, const T& time) const { return gaps_.time_resolution(time); }

  // ---- reading, at a local time not before the last contact
  T gap_at(Slot s, const T& time) const { return gaps_.gap_at(s, closing(s), time); }
  // Positions of the outermost bodies that have collided; only once there are some.
  T front_left(const T& time) const {
    if (first() == window_.front_left()) return configuration(time).x.front();
    const Slot beside = left(window_.front_left());
    return (undisturbed_place(beside, time) + gap_at(beside, time)).value();
  }
  T front_right(const T& time) const {
    const Slot front = window_.front_right();
    if (last() == front) return configuration(time).x.back();
    return (undisturbed_place(right(front), time) - gap_at(front, time)).value();
  }
  // What there is of it: the bodies that have collided and the next one on each side, see
  // cluster_chain_configuration.hpp.
  Configuration<T> configuration(const T& time) const;

 private:
  ClusterChain(std::shared_ptr<const Bodies<T>> bodies, const T& start, GapRange held)
      : bodies_(std::move(bodies)), gaps_(start, bodies_->energy_to_lose()),
        window_(bodies_->on_ring(), held.first, bodies_->count() - 2 - held.last, 3),
        frame_(bodies_->momentum() / bodies_->total_mass()), runaway_(T(2) + T(4) * bodies_->energy_over_least_mass()) {
    require_bodies(*bodies_, start);
    lay_out({}, static_cast<std::size_t>(held.last - held.first + 2));
    for (Slot s = first(); s <= last(); ++s)
      gaps_.put(s, load(held.first + static_cast<BodyIndex>(s - first()), T(0), s < last() || on_ring()));
    link();
    if (on_ring()) active_ = bodies_->count();
  }

  bool vacant(Slot s) const { return gaps_[s].right == s; }
  // Vacant cells make the queue's tree deep, and neighbours live in different branches of it.
  bool sparse() const { return 2 * vacated_ > last() - first() + 24; }

  // Position of a body that has not collided.
  Pair<T> undisturbed_place(Slot s, const T& time) const {
    return undisturbed(*bodies_, body(s), clock().elapsed(time)).x;
  }

  // As at the start. A gap that is none yet, right of the last body held, is not asked for: that would be random
  // numbers in vain.
  Cell<T> load(BodyIndex b, const T& time, bool with_gap) const {
    return {{with_gap ? bodies_->gap(b) : T(1), time}, bodies_->velocity(b) - frame_, bodies_->mass(b), 0, 0, b};
  }

  // Goes over to slots enough for the zone to grow by half on either side, with the cells at `kept`.
  void lay_out(const std::vector<Slot>& kept, std::size_t held) {
    const auto growth = static_cast<BodyIndex>(std::max<std::size_t>(held / 2, 24));
    const std::size_t slots = window_.lay_out(held, growth, kept);
    gaps_.lay_out(slots, first(), kept);
    vacated_ = 0;
  }
  // Links the cells held one to the next; those that are not are vacant, linked to themselves.
  void link() {
    for (Slot s = 0; s < slots(); ++s) {
      const bool held = s >= first() && s <= last();
      gaps_[s].left = held ? s - 1 : s;
      gaps_[s].right = held ? s + 1 : s;
    }
    if (on_ring()) {
      gaps_[first()].left = last();
      gaps_[last()].right = first();
    } else {
      place_end(first() - 1, first());
      place_end(last() + 1, last());
    }
    for (Slot s = first(); s <= last(); ++s) gaps_.foresee(s, closing(s));
  }

  // Beyond the bodies held something runs away, faster than any body can.
  void place_end(Slot s, Slot beside) {
    const bool on_left = s < beside;
    gaps_.put(s, {{}, on_left ? T(-runaway_) : runaway_, T(1), on_left ? s : beside, on_left ? beside : s, 0});
    (on_left ? gaps_[beside].left : gaps_[beside].right) = s;
  }

  // A contact at an end of the active zone: takes in the next body there, if there is one.
  Notice widen(Slot s, const T& time) {
    const Slot n = right(s);
    const auto count = [&](Slot from, Slot to) {  // cells held from one to before the other
      BodyIndex cells = 0;
      for (; from < to; from = right(from)) ++cells;
      return cells;
    };
    active_ = window_.has_fronts() ? active_ + count(s, window_.front_left()) + count(window_.front_right(), n) : 2;
    window_.reach(s, n);
    if (window_.beyond_left(s) == Window::Beyond::row) {
      const BodyIndex b = window_.take_in_left();
      gaps_.put(first(), load(b, time, true));
      gaps_[first()].right = s;
      gaps_[s].left = first();
      place_end(first() - 1, first());
    }
    if (window_.beyond_right(n) == Window::Beyond::row) {
      // The gap right of n was not one before: it is as at the start.
      gaps_.start(n, bodies_->gap(body(n)), time);
      const BodyIndex b = window_.take_in_right(bodies_->count());
      gaps_.put(last(), load(b, time, false));
      gaps_[last()].left = n;
      gaps_[n].right = last();
      place_end(last() + 1, last());
    }
    const bool all_collided = window_.front_left() == first() && window_.front_right() == last();
    if (all_collided && !centre_) centre_ = bodies_->centre_of_mass();
    return window_.cramped(slots()) || sparse() ? Notice::needs_slots : Notice::none;
  }

  // Keeps account of the mass that goes from the first cell of a ring to the last one, that is, by a turn to the right.
  void cross_seam(Slot s, Event event) {
    const Slot n = right(s);
    if (n > s || event == Event::bounce) return;
    carried_.add(gaps_[n].mass);
    if (event == Event::pass) carried_.add(T(-gaps_[s].mass));
  }

  // The bodies at s and right of it go on as one, in the cell s.
  Notice absorb_right(Slot s, const T& velocity) {
    Cell<T>& l = gaps_[s];
    const Slot n = l.right;
    Cell<T>& r = gaps_[n];
    if (l.mass < r.mass) l.body = r.body;
    l.velocity = velocity;
    l.mass += r.mass;
    gaps_.carry(n, s);
    gaps_.forget(n);
    l.right = r.right;
    gaps_[l.right].left = s;
    r.right = n;
    window_.merge(s, n, l.right);
    --active_;
    ++vacated_;
    return sparse() ? Notice::needs_slots : Notice::none;
  }

  // A gap between bodies of which one has had a contact, by which it closes faster by as much as u_left exceeds
  // u_right.
  [[gnu::always_inline]] Notice kick(Slot s, const T& so_far, const T& u_left, const T& u_right, const T& time) {
    const T since = gaps_.kick(
        s, so_far, [&] { return T(u_left - u_right); }, time);
    if (gaps_.below_floor(s)) [[unlikely]]
      return gaps_.note(s, closing(s), body(s), since, time);
    return Notice::none;
  }
  [[gnu::always_inline]] double predict(Slot s) { return gaps_.predict(s, closing(s)); }

  std::shared_ptr<const Bodies<T>> bodies_;
  TimedGaps<T, Cell<T>, may_collapse> gaps_;
  Window window_;
  std::size_t vacated_ = 0;  // since the last layout
  BodyIndex active_ = 0;     // bodies from one front to the other, both included
  Slot beyond_ = 0;  // the cell that has the gap right of the last contact: of both bodies where they have merged
  T frame_;          // velocity of the centre of mass
  T runaway_;        // twice 1 + 2E/m >= sqrt(2E/m), which no speed exceeds
  std::optional<T> centre_;    // of mass at the start, on a line where positions can be told from nothing else
  CompensatedSum<T> carried_;  // mass across the seam of a ring, see cross_seam
};

}  // namespace cradle

#include "cradle/core/cluster_chain_configuration.hpp"
