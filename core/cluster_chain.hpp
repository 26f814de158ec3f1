#pragma once
// The chain for laws whose bodies merge or pass through each other: gaps and body velocities, for any masses.
// Velocities are told in the frame in which the total momentum vanishes: a heavy cluster's kick of 1e-8 is lost in a
// closing speed of order one, and the drift of their sum integrates into the gaps; added to the cluster's own small
// velocity it is kept.
//
// A cell holds a body and the gap between it and the next one. When two bodies merge, the cell of the right one is
// vacated and links pass over it; vacant cells are dropped when the chain is laid out anew. Seen by places on the line,
// bodies that pass exchange cells. Gaps, local times and the streaming of rows are as in gap_chain.hpp.
//
// Positions come from a body at an end that has not collided, else from the centre of mass, which moves uniformly. On a
// ring the cells are linked in a circle; told by the cells, from the first to the last, the centre of mass jumps by L
// times the mass that has gone from the first cell to the last one across the seam, which is kept account of.

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/account.hpp"
#include "cradle/core/clock.hpp"
#include "cradle/core/collision.hpp"
#include "cradle/core/configuration.hpp"
#include "cradle/core/event_queue.hpp"
#include "cradle/core/local_times.hpp"

namespace cradle {

template <Real T> class ClusterChain {
 public:
  using Scalar = T;
  static constexpr bool keys_are_exact = std::same_as<T, double>;
  static constexpr bool may_collapse = false;

  // Holds the bodies at the gaps in motion and streams the others in as the fronts reach them; `hold_all` holds every
  // body.
  ClusterChain(std::shared_ptr<const Bodies<T>> bodies, const T& start, bool hold_all = false)
      : bodies_(std::move(bodies)), ring_(bodies_->on_ring()), clock_(start),
        frame_(bodies_->momentum() / bodies_->total_mass()), runaway_(T(2) + T(4) * bodies_->energy_over_least_mass()) {
    const BodyIndex last = bodies_->count() - 1;
    const GapRange held = hold_all || ring_ ? GapRange{0, last - 1} : bodies_->gaps_in_motion();
    std::vector<Cell> cells;
    cells.reserve(static_cast<std::size_t>(held.last - held.first + 2));
    for (BodyIndex b = held.first; b <= held.last + 1; ++b) cells.push_back(load(b, T(0), b > held.last && !ring_));
    unheld_left_ = held.first;
    unheld_right_ = last - held.last - 1;
    if (ring_) active_ = bodies_->count();
    lay_out(cells, std::vector<T>(cells.size(), T(0)));
  }

  // ---- times: offsets from the chain's origin
  const Clock<T>& clock() const { return clock_; }
  const T& start() const { return clock_.start(); }
  T local_time(const T& time) const { return clock_.offset(time); }
  Pair<T> stamp(const T& local) const { return clock_.stamp(local); }
  double queue_time(const T& local) const { return to_double(local); }

  // ---- slots: cells held are first() to last(), vacant ones among them; the last one's gap is none
  std::size_t slots() const { return cells_.size(); }
  Slot first() const { return first_; }
  Slot last() const { return last_; }
  Slot left(Slot s) const { return cells_[s].left; }
  Slot right(Slot s) const { return cells_[s].right; }
  BodyIndex body(Slot s) const { return cells_[s].body; }
  BodyIndex collided_bodies() const { return active_; }
  bool on_ring() const { return ring_; }

  T due(Slot s) const {
    const Cell& c = cells_[s];
    if constexpr (keys_are_exact)
      return c.due;
    else
      return local_times_.after(s, c.time, c.gap / closing(s));
  }
  double queue_due(Slot s) const {
    if (vacant(s)) return EventQueue::never;
    if constexpr (keys_are_exact)
      return cells_[s].due;
    else
      return is_positive(closing(s)) ? queue_time(due(s)) : EventQueue::never;
  }
  T closing(Slot s) const { return cells_[s].velocity - cells_[cells_[s].right].velocity; }

  // ---- events (inlined by force, see gap_chain.hpp)
  template <class Law>
  [[gnu::always_inline]] Collision<T> collide(const Law& law, Slot s, const T& time) requires(!LawWithMemory<Law, T>) {
    Cell& l = cells_[s];
    const Outcome<T> outcome = law(closing(s), TwoMasses<T>{l.mass, cells_[l.right].mass});
    const T flown = local_times_.flown(s, l.time, time);
    Notice notice = of_flight(queue_time(flown), queue_time(time));
    if ((s <= front_left_) | (l.right >= front_right_)) [[unlikely]] {
      if (ring_)
        cross_seam(s, outcome.event);
      else
        notice |= widen(s, time);
    }
    const Slot p = l.left, n = l.right;
    Cell& r = cells_[n];
    const T late_left = settle(p, time), late_right = settle(n, time);
    const bool behind = is_negative(flown);  // a gap's local time never goes back
    const T opened = behind ? T(outcome.closing * flown) : T(0);

    const T before_left = l.velocity, before_right = r.velocity;
    const T slowed = before_left - outcome.to_left, sped = before_right + outcome.to_right;
    Slot beyond = n;  // the cell that has the gap right of the contact
    if (outcome.event == Event::merge) {
      notice |= absorb_right(s, l.mass < r.mass ? sped : slowed);  // the heavier one's velocity hardly changes
      beyond = s;
    } else {
      l.gap = opened;
      if (!behind) local_times_.renew(s, l.time, time);
      const bool pass = outcome.event == Event::pass;
      l.velocity = pass ? sped : slowed;
      r.velocity = pass ? slowed : sped;
      if (pass) {
        std::swap(l.mass, r.mass);
        std::swap(l.body, r.body);
      }
    }
    // What came too late for a neighbour's local time acts as if it had been there since.
    if (is_negative(late_left)) [[unlikely]]
      cells_[p].gap += (before_left - l.velocity) * late_left;
    if (is_negative(late_right)) [[unlikely]]
      cells_[beyond].gap += (cells_[beyond].velocity - before_right) * late_right;
    notice |= inspect(p, time) | inspect(beyond, time);
    return {outcome, predict(p), predict(s), beyond == n ? predict(n) : EventQueue::never, notice, p, n};
  }

  T move_origin(const T& local) {
    clock_.move_origin(local);
    for (Slot s = first_; s <= last_; ++s) {
      if (vacant(s)) continue;
      Cell& c = cells_[s];
      local_times_.move(s, c.time, local);
      if constexpr (keys_are_exact) predict_anew(s);
    }
    return T(0);
  }

  // True when the next contact at an end could find no cell for the body that it sets free, or most cells are vacant.
  bool cramped() const {
    return (unheld_left_ > 0 && end_left_ <= 2) || (unheld_right_ > 0 && end_right_ + 3 >= slots()) || sparse();
  }
  void make_room() {
    std::vector<Cell> cells;
    std::vector<T> lag;
    Slot fronts[2] = {front_left_, front_right_};
    const bool collided = front_left_ <= front_right_;
    for (Slot s = first_;; s = cells_[s].right) {
      for (int side : {0, 1})
        if (s == (side ? front_right_ : front_left_)) fronts[side] = cells.size();
      cells.push_back(cells_[s]);
      lag.push_back(local_times_.lag(s));
      if (s == last_) break;
    }
    lay_out(cells, lag);
    if (collided) front_left_ = first_ + fronts[0], front_right_ = first_ + fronts[1];
  }

  void set_floor(const T& floor) { floor_ = floor; }
  T nearest_gap(Slot s) const {
    const T far = far_away<T>();
    const Slot p = cells_[s].left, n = cells_[s].right;
    const T on_left = p == end_left_ && !ring_ ? far : cells_[p].gap,
            on_right = (n == last_ || n == end_right_) && !ring_ ? far : cells_[n].gap;
    return on_left < on_right ? on_left : on_right;
  }
  const Account<T>& account() const { return account_; }
  // What times of contacts are told apart by, as times since the start.
  T time_resolution(Slot, const T& time) const {
    return T(std::numeric_limits<T>::epsilon()) * magnitude(clock_.elapsed(time));
  }

  // ---- reading, at a local time not before the last contact
  T gap_at(Slot s, const T& time) const {
    const Cell& c = cells_[s];
    return c.gap - closing(s) * local_times_.flown(s, c.time, time);
  }
  // Positions of the outermost bodies that have collided; only once there are some.
  T front_left(const T& time) const {
    if (first_ == front_left_) return configuration(time).x.front();
    const Slot beside = cells_[front_left_].left;
    return (undisturbed(cells_[beside].body, time) + gap_at(beside, time)).value();
  }
  T front_right(const T& time) const {
    if (last_ == front_right_) return configuration(time).x.back();
    return (undisturbed(cells_[cells_[front_right_].right].body, time) - gap_at(front_right_, time)).value();
  }
  // The bodies that have collided and the next one on each side; all that are held before the first contact. On a ring
  // all bodies, from the first one right of x = 0.
  Configuration<T> configuration(const T& time) const;

 private:
  struct Cell {
    T gap{1}, time{0}, velocity{0}, mass{1};
    double due = EventQueue::never;  // where keys are exact
    Slot left = 0, right = 0;
    BodyIndex body = 0;
  };

  bool vacant(Slot s) const { return cells_[s].right == s; }
  // Vacant cells make the queue's tree deep, and neighbours live in different branches of it.
  bool sparse() const { return 2 * vacated_ > last_ - first_ + 24; }

  // Position of a body that has not collided.
  Pair<T> undisturbed(BodyIndex b, const T& time) const {
    return two_sum(bodies_->position(b), T(bodies_->velocity(b) * clock_.elapsed(time)));
  }

  // The gap right of the last body held is none yet: it is not asked for, which would be random numbers in vain.
  Cell load(BodyIndex b, const T& time, bool last = false) const {
    Cell c;
    if (!last) c.gap = bodies_->gap(b);
    c.time = time;
    c.velocity = bodies_->velocity(b) - frame_;
    c.mass = bodies_->mass(b);
    c.body = b;
    return c;
  }

  // Puts the cells, without vacant ones, in the middle of slots enough for the zone to grow by half on either side.
  void lay_out(const std::vector<Cell>& cells, const std::vector<T>& lag) {
    const auto growth = static_cast<BodyIndex>(std::max<std::size_t>(cells.size() / 2, 24));
    const auto room_left = static_cast<Slot>(std::min(unheld_left_, growth)) + 3;
    const auto room_right = static_cast<Slot>(std::min(unheld_right_, growth)) + 3;
    cells_.assign(room_left + cells.size() + room_right, Cell{});
    for (Slot s = 0; s < cells_.size(); ++s) cells_[s].left = cells_[s].right = s;
    local_times_.resize(cells_.size());
    first_ = room_left;
    last_ = first_ + cells.size() - 1;
    vacated_ = 0;
    for (Slot s = first_; s <= last_; ++s) {
      cells_[s] = cells[s - first_];
      local_times_.set_lag(s, lag[s - first_]);
      cells_[s].left = s - 1;
      cells_[s].right = s + 1;
    }
    if (ring_) {
      cells_[first_].left = last_;
      cells_[last_].right = first_;
    } else {
      place_end(first_ - 1, first_);
      place_end(last_ + 1, last_);
    }
    if constexpr (keys_are_exact)
      for (Slot s = first_; s <= last_; ++s) predict_anew(s);
  }

  // Beyond the bodies held something runs away, faster than any body can.
  void place_end(Slot s, Slot beside) {
    cells_[s] = Cell{};
    local_times_.set_lag(s, T(0));
    const bool on_left = s < beside;
    cells_[s].velocity = on_left ? T(-runaway_) : runaway_;
    cells_[s].left = on_left ? s : beside;
    cells_[s].right = on_left ? beside : s;
    (on_left ? cells_[beside].left : cells_[beside].right) = s;
    (on_left ? end_left_ : end_right_) = s;
  }

  // A contact at an end of the active zone: takes in the next body there, if there is one.
  Notice widen(Slot s, const T& time) {
    const Slot n = cells_[s].right;
    const bool begun = front_left_ <= front_right_;
    const auto count = [&](Slot from, Slot to) {  // cells held from one to before the other
      BodyIndex cells = 0;
      for (; from != to; from = cells_[from].right) ++cells;
      return cells;
    };
    if (!begun)
      active_ = 2;
    else
      active_ += (s < front_left_ ? count(s, front_left_) : 0) + (n > front_right_ ? count(front_right_, n) : 0);
    if (!begun || s < front_left_) front_left_ = s;
    if (!begun || n > front_right_) front_right_ = n;
    if (s == first_ && unheld_left_ > 0) {
      first_ = end_left_;
      cells_[first_] = load(--unheld_left_, time);
      local_times_.set_lag(first_, T(0));
      cells_[first_].right = s;
      cells_[s].left = first_;
      place_end(first_ - 1, first_);
    }
    if (n == last_ && unheld_right_ > 0) {
      last_ = end_right_;
      // The gap right of n was not one before: it is as at the start.
      cells_[n].gap = bodies_->gap(cells_[n].body);
      cells_[n].time = time;
      local_times_.set_lag(n, T(0));
      cells_[last_] = load(bodies_->count() - unheld_right_--, time, true);
      local_times_.set_lag(last_, T(0));
      cells_[last_].left = n;
      cells_[n].right = last_;
      place_end(last_ + 1, last_);
    }
    return cramped() ? Notice::needs_slots : Notice::none;
  }

  // Keeps account of the mass that goes from the first cell of a ring to the last one, that is, by a turn to the right.
  void cross_seam(Slot s, Event event) {
    const Slot n = cells_[s].right;
    if (n > s || event == Event::bounce) return;
    carried_.add(cells_[n].mass);
    if (event == Event::pass) carried_.add(T(-cells_[s].mass));
  }

  // The bodies at s and right of it go on as one, in the cell s.
  Notice absorb_right(Slot s, const T& velocity) {
    Cell& l = cells_[s];
    const Slot n = l.right;
    Cell& r = cells_[n];
    if (l.mass < r.mass) l.body = r.body;
    l.velocity = velocity;
    l.mass += r.mass;
    l.gap = r.gap;
    l.time = r.time;
    local_times_.set_lag(s, local_times_.lag(n));
    l.right = r.right;
    cells_[l.right].left = s;
    r.right = n;
    if constexpr (keys_are_exact) r.due = EventQueue::never;
    if (last_ == n) last_ = s;
    if (first_ == n) first_ = cells_[s].right;
    if (front_right_ == n) front_right_ = s;
    --active_;
    ++vacated_;
    return sparse() ? Notice::needs_slots : Notice::none;
  }

  // Brings a gap up to date; where the local time is ahead of the contact it stays, and how far is returned (negative).
  T settle(Slot s, const T& time) {
    Cell& c = cells_[s];
    const T flown = local_times_.flown(s, c.time, time);
    if (is_negative(flown)) [[unlikely]]
      return flown;
    c.gap -= closing(s) * flown;
    local_times_.renew(s, c.time, time);
    return T(0);
  }

  Notice inspect(Slot s, const T& time) {
    const Cell& c = cells_[s];
    if (!(c.gap < floor_)) [[likely]]
      return Notice::none;
    if (is_positive(c.gap)) return Notice::gap_below_floor;
    const T rounding = T(16) * T(std::numeric_limits<T>::epsilon()) * magnitude(closing(s)) * magnitude(time);
    account_.enter({clock_.time(time), c.body, c.gap}, rounding);
    return Notice::gap_below_floor;
  }

  // Off the hot path.
  void predict_anew(Slot s) {
    Cell& c = cells_[s];
    c.due = closing(s) > 0 ? local_times_.after(s, c.time, c.gap / closing(s)) : EventQueue::never;
  }

  double predict(Slot s) {
    Cell& c = cells_[s];
    const T w = closing(s);
    if constexpr (keys_are_exact) {
      // Whether a gap closes cannot be predicted: choose by bits, where a positive number is a positive integer.
      const auto bits = std::bit_cast<std::uint64_t>(c.time + c.gap / w);
      const auto opening = std::uint64_t{0} - (std::bit_cast<std::int64_t>(w) <= 0);
      return c.due =
                 std::bit_cast<double>((bits & ~opening) | (std::bit_cast<std::uint64_t>(EventQueue::never) & opening));
    } else {
      if (!is_positive(w)) return EventQueue::never;
      const double rounded = to_double(c.time) + to_double(c.gap) / to_double(w);
      return std::isfinite(rounded) && !is_negative(c.time) ? rounded : queue_time(due(s));
    }
  }

  std::vector<Cell> cells_;
  LocalTimes<T> local_times_;  // beside Cell::time
  Slot first_ = 0, last_ = 0, end_left_ = 0, end_right_ = 0;
  Slot front_left_ = std::numeric_limits<Slot>::max(), front_right_ = 0;  // outermost bodies that have collided
  std::size_t vacated_ = 0;                                               // since the last layout
  BodyIndex unheld_left_ = 0, unheld_right_ = 0, active_ = 0;
  T floor_{0};
  std::shared_ptr<const Bodies<T>> bodies_;
  bool ring_;
  Clock<T> clock_;
  T frame_;                                  // velocity of the centre of mass
  T runaway_;                                // twice 1 + 2E/m >= sqrt(2E/m), which no speed exceeds
  mutable std::optional<T> centre_of_mass_;  // at the start; found when first asked for
  CompensatedSum<T> carried_;                // mass across the seam of a ring, see cross_seam
  Account<T> account_;
};

template <Real T> Configuration<T> ClusterChain<T>::configuration(const T& time) const {
  const bool collided = front_left_ <= front_right_;
  const Slot from = collided && front_left_ > first_ ? cells_[front_left_].left : first_;
  const Slot to = collided && front_right_ < last_ ? cells_[front_right_].right : last_;
  Configuration<T> c;
  c.time = clock_.time(time);
  // A body that has not collided is still itself; where all at an end have, they are those from the end of the line.
  const bool free_left = !ring_ && (!collided || from != front_left_);
  const bool free_right = !ring_ && (!collided || to != front_right_);
  c.from = free_left ? cells_[from].body : 0;
  c.to = free_right ? cells_[to].body : bodies_->count() - 1;
  CompensatedSum<T> way, moment, mass;
  std::vector<T> ways;
  for (Slot s = from;; s = cells_[s].right) {
    const Cell& cell = cells_[s];
    c.index.push_back(cell.body);
    c.m.push_back(cell.mass);
    c.v.push_back(cell.velocity + frame_);
    ways.push_back(way.value());
    moment.add(cell.mass * ways.back());
    mass.add(cell.mass);
    if (s == to && !ring_) break;
    c.gap.push_back(gap_at(s, time));
    c.closing_speed.push_back(closing(s));
    way.add(c.gap.back());
    if (s == to) break;
  }
  Pair<T> leftmost;
  if (free_left)
    leftmost = undisturbed(cells_[from].body, time);
  else if (free_right)
    leftmost = undisturbed(cells_[to].body, time) - way.value();
  else {
    if (!centre_of_mass_) centre_of_mass_ = bodies_->centre_of_mass();
    leftmost = two_sum(*centre_of_mass_, T(frame_ * clock_.elapsed(time)));
    leftmost = leftmost - T((moment.value() - carried_.value() * bodies_->circumference()) / mass.value());
  }
  for (const T& w : ways) c.x.push_back((leftmost + w).value());
  if (collided || ring_) c.collided_from = free_left ? 1 : 0, c.collided_to = c.x.size() - (free_right ? 1 : 0);
  if (ring_) {
    c.closure_gap = bodies_->circumference() - way.value();
    fold(c, bodies_->circumference());
  }
  return c;
}

}  // namespace cradle
