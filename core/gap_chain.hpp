#pragma once
// The chain in gaps and closing speeds: for neighbours l, r the gap g >= 0, the closing speed w = u_l - u_r and the
// local time at which g was last brought up to date. A contact hands an impulse J from left to right and changes three
// gaps:
//
//   w[i] -> w',   w[i-1] += J/m_l,   w[i+1] += J/m_r,   g[i] = 0 exactly.
//
// Nothing is ever a difference of positions, so gaps keep their relative precision down to underflow, however small
// they are against the size of the system. Times are offsets from a moving origin; no gap is rounded by a move
// (local_times.hpp).
//
// Rows are streamed: of a row, only the body next to the outermost one that has collided is held. Velocities and
// positions come from the two anchors: the bodies that end the active zone, whose flight is known, or integrated once
// all have collided. On a ring the gap after the last slot is the first one; there positions come from the centre of
// mass, velocities from the total momentum.

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "cradle/core/account.hpp"
#include "cradle/core/clock.hpp"
#include "cradle/core/collision.hpp"
#include "cradle/core/configuration.hpp"
#include "cradle/core/event_queue.hpp"
#include "cradle/core/local_times.hpp"
#include "cradle/core/masses.hpp"

namespace cradle {

template <Real T> struct Gap { T gap{1}, closing{-1}, time{0}; };
// In double the time of the next contact is its own key: it is kept, which saves a division when it comes.
template <> struct alignas(32) Gap<double> { double gap = 1, closing = -1, time = 0, due = EventQueue::never; };

template <Real T, class Masses = IdenticalMasses<T>> class GapChain {
 public:
  using Scalar = T;
  static constexpr bool keys_are_exact = std::same_as<T, double>;
  static constexpr bool may_collapse = true;

  // Holds the gaps in motion and streams the others in as the fronts reach them; `hold_all` holds every gap from the
  // start.
  GapChain(std::shared_ptr<const Bodies<T>> bodies, const T& start, bool hold_all = false)
      : bodies_(std::move(bodies)), ring_(bodies_->on_ring()), clock_(start), masses_(*bodies_) {
    const GapRange held = hold_all && !ring_ ? GapRange{0, bodies_->count() - 2} : bodies_->gaps_in_motion();
    lay_out(held.first, held.last, [&](BodyIndex body) { return load(body, T(0)); });
  }

  // ---- times: what a chain calls a local time is an offset from its origin
  const Clock<T>& clock() const { return clock_; }
  const T& start() const { return clock_.start(); }
  T local_time(const T& time) const { return clock_.offset(time); }
  Pair<T> stamp(const T& local) const { return clock_.stamp(local); }
  double queue_time(const T& local) const {
    if constexpr (WiderRange<T>) {
      long exponent = 0;
      const double mantissa = split(local, exponent);
      return scale(mantissa, exponent + shift_);
    } else {
      return to_double(local);
    }
  }

  // ---- slots: the gaps held are first() to last()
  std::size_t slots() const { return gaps_.size(); }
  Slot first() const { return first_; }
  Slot last() const { return last_; }
  Slot left(Slot s) const { return ring_ && s == first_ ? last_ : s - 1; }
  Slot right(Slot s) const { return ring_ && s == last_ ? first_ : s + 1; }
  bool on_ring() const { return ring_; }
  BodyIndex body(Slot s) const { return static_cast<BodyIndex>(s) + body_of_slot_0_; }
  BodyIndex collided_bodies() const {
    if (ring_) return bodies_->count();
    return front_right_ < front_left_ ? 0 : body(front_right_) - body(front_left_) + 2;
  }

  // Local time of the next contact of a gap that is closing.
  T due(Slot s) const {
    const Gap<T>& g = gaps_[s];
    if constexpr (keys_are_exact)
      return g.due;
    else
      return local_times_.after(s, g.time, g.gap / g.closing);
  }
  double queue_due(Slot s) const {
    if constexpr (keys_are_exact)
      return gaps_[s].due;
    else
      return gaps_[s].closing > T(0) ? queue_time(due(s)) : EventQueue::never;
  }

  const T& closing(Slot s) const { return gaps_[s].closing; }

  // ---- events. Inlined by force: the loop comes in two versions, observed or not, and as a call this passes all
  // results through memory, a fifth of the time per contact.
  template <class Law>
  [[gnu::always_inline]] Collision<T> collide(const Law& law, Slot s, const T& time) requires(Law::bounces_only) {
    if ((s <= front_left_) | (s >= front_right_)) [[unlikely]]
      return collide_at_end(law, s, time);
    return strike(s - 1, s, s + 1, time, outcome(law, s, time), Notice::none);
  }

  // Moves the origin of time to the given local time and returns what that time is called now. Touches no gap: only the
  // times they are told in.
  T move_origin(const T& local) {
    clock_.move_origin(local);
    for (Slot s = first_; s <= last_; ++s) {
      Gap<T>& g = gaps_[s];
      local_times_.move(s, g.time, local);
      if (!last_contact_.empty()) last_contact_[s] -= local;
      if constexpr (keys_are_exact)
        g.due = g.closing > 0 ? local_times_.after(s, g.time, g.gap / g.closing) : EventQueue::never;
    }
    for (Anchor* anchor : {&left_, &right_}) anchor->time = anchor->time - local;
    if constexpr (WiderRange<T>) choose_shift();
    return T(0);
  }

  // True when the next contact at an end could find no slot for the body that it sets free.
  bool cramped() const {
    return (body(first_) > 0 && first_ <= 2) || (body(last_) + 2 < bodies_->count() && last_ + 3 >= slots());
  }
  void make_room() {
    const std::vector<Gap<T>> gaps = std::move(gaps_);
    const LocalTimes<T> local_times = std::move(local_times_);
    const std::vector<T> last_contact = std::move(last_contact_);
    const BodyIndex from = body(first_);
    const Slot first = first_, fronts[2] = {front_left_, front_right_};
    const bool collided = front_left_ <= front_right_;
    lay_out(from, body(last_), [&](BodyIndex b) {
      const Slot old = static_cast<Slot>(b - from) + first;
      if (!last_contact.empty()) {
        last_contact_.resize(gaps_.size(), longest_ago_);
        last_contact_[static_cast<Slot>(b - body_of_slot_0_)] = last_contact[old];
      }
      local_times_.set_lag(static_cast<Slot>(b - body_of_slot_0_), local_times.lag(old));
      return gaps[old];
    });
    if (collided) front_left_ = fronts[0] - first + first_, front_right_ = fronts[1] - first + first_;
  }

  // Contacts that leave a gap below `floor` beside them are noticed (gap_below_floor).
  void set_floor(const T& floor) { floor_ = floor; }
  // The smaller gap next to a contact, as of its local time; an end of the line counts as far away.
  T nearest_gap(Slot s) const {
    if (ring_) {
      const T &on_left = gaps_[left(s)].gap, &on_right = gaps_[right(s)].gap;
      return on_left < on_right ? on_left : on_right;
    }
    const T far = far_away<T>();
    const T on_left = s > first_ ? gaps_[s - 1].gap : far, on_right = s < last_ ? gaps_[s + 1].gap : far;
    return on_left < on_right ? on_left : on_right;
  }
  const Account<T>& account() const { return account_; }
  // What times of contacts are told apart by, as times since the start.
  T time_resolution(Slot, const T& time) const {
    return T(std::numeric_limits<T>::epsilon()) * magnitude(clock_.elapsed(time));
  }

  // ---- reading, at a local time not before the last contact
  T gap_at(Slot s, const T& time) const {
    const Gap<T>& g = gaps_[s];
    return g.gap - g.closing * local_times_.flown(s, g.time, time);
  }
  // Positions of the outermost bodies that have collided; only once there are some.
  T front_left(const T& time) const {
    const Pair<T> x = flight(left_, time).x;
    return (body(front_left_) > left_.body ? x + gap_at(front_left_ - 1, time) : x).value();
  }
  T front_right(const T& time) const {
    const Pair<T> x = flight(right_, time).x;
    return (body(front_right_) + 1 < right_.body ? x - gap_at(front_right_ + 1, time) : x).value();
  }

  // The bodies that have collided and the next one on each side; all that are held before the first contact. On a ring
  // all bodies, from the first one right of x = 0.
  Configuration<T> configuration(const T& time) const;

 private:
  Configuration<T> ring_configuration(const T& time) const;

  // A body whose flight is known: as at the start (not collided), or from its last contact.
  struct Anchor {
    BodyIndex body = 0;
    bool collided = false;
    Pair<T> x, v, time;
  };
  struct Flight {
    Pair<T> x;
    Pair<T> v;
  };

  Flight flight(const Anchor& a, const T& time) const {
    if (a.collided) return {a.x + T(a.v.value() * difference(Pair<T>{time, T(0)}, a.time)), a.v};
    const T v = bodies_->velocity(a.body);
    return {two_sum(bodies_->position(a.body), T(v * clock_.elapsed(time))), {v, T(0)}};
  }
  void turn(Anchor& a, const T& time, const T& gain) {
    const Flight now = flight(a, time);
    a = {a.body, true, now.x, now.v + gain, {time, T(0)}};
  }

  Gap<T> load(BodyIndex body, const T& time) const {
    Gap<T> g;
    g.gap = bodies_->gap(body);
    g.closing = bodies_->closing_speed(body);
    g.time = time;
    if constexpr (keys_are_exact) g.due = g.closing > 0 ? time + g.gap / g.closing : EventQueue::never;
    return g;
  }

  // Puts the gaps of bodies from..to in the middle of slots enough for the zone to grow by half on either side.
  template <class Make> void lay_out(BodyIndex from, BodyIndex to, Make make) {
    const BodyIndex held = to - from + 1, growth = held / 2 + 8;
    const BodyIndex room_left = std::min(from, growth) + 2;
    const BodyIndex room_right = std::clamp(bodies_->count() - 2 - to, BodyIndex{0}, growth) + 2;
    gaps_.assign(static_cast<std::size_t>(room_left + held + room_right), Gap<T>{});
    local_times_.resize(gaps_.size());
    masses_.resize(gaps_.size());
    body_of_slot_0_ = from - room_left;
    first_ = static_cast<Slot>(room_left);
    last_ = first_ + static_cast<Slot>(held) - 1;
    for (BodyIndex b = from; b <= to; ++b) gaps_[static_cast<Slot>(b - body_of_slot_0_)] = make(b);
    for (BodyIndex b = from; b <= to + 1; ++b)
      masses_.set(static_cast<Slot>(b - body_of_slot_0_), bodies_->mass(b < bodies_->count() ? b : 0));
    if (ring_) {
      front_left_ = first_, front_right_ = last_;  // beyond them lies the other one
      centre_ = bodies_->centre_of_mass();
      return;
    }
    if (front_right_ < front_left_) left_.body = from, right_.body = to + 1;
  }

  template <class Law> [[gnu::always_inline]] Outcome<T> outcome(const Law& law, Slot s, const T& time) {
    if constexpr (LawWithMemory<Law, T>)
      if (!rested(s, time, law.contact_time())) return law.elastic(closing(s), masses_.of_pair(s));
    return law(closing(s), masses_.of_pair(s));
  }
  // A contact at an end of the active zone, or at the seam of a ring.
  template <class Law> [[gnu::noinline]] Collision<T> collide_at_end(const Law& law, Slot s, const T& time) {
    const Outcome<T> of_law = outcome(law, s, time);
    const Notice notice = ring_ ? Notice::none : widen(s, time, of_law);
    return strike(left(s), s, right(s), time, of_law, notice);
  }

  // What a contact at the gap s does to it and to its neighbours p and n.
  [[gnu::always_inline]] Collision<T> strike(Slot p, Slot s, Slot n, const T& time, const Outcome<T>& outcome,
                                             Notice notice) {
    Gap<T>& pair = gaps_[s];
    const T flown = local_times_.flown(s, pair.time, time);
    notice |= of_flight(queue_time(flown), queue_time(time));
    if (is_negative(flown)) [[unlikely]]  // a gap's local time never goes back
      pair.gap = outcome.closing * flown;
    else {
      pair.gap = T(0);
      local_times_.renew(s, pair.time, time);
    }
    pair.closing = outcome.closing;
    if constexpr (keys_are_exact) pair.due = EventQueue::never;

    notice |= kick(p, time, outcome.to_left);
    notice |= kick(n, time, outcome.to_right);
    return {outcome, predict(p), EventQueue::never, predict(n), notice, p, n};
  }

  // A contact at an end of the active zone: takes in the next body there, or, at an end of the line, follows the last
  // one.
  Notice widen(Slot s, const T& time, const Outcome<T>& outcome) {
    if (s <= front_left_) {
      front_left_ = s;
      if (body(s) > 0) {
        if (s == first_) {
          gaps_[--first_] = load(body(s) - 1, time);
          masses_.set(first_, bodies_->mass(body(first_)));
        }
        left_.body = body(s) - 1;
      } else {
        left_.body = body(s);
        turn(left_, time, T(-outcome.to_left));
        seal(s - 1, time, outcome.to_left);
      }
    }
    if (s >= front_right_) {
      front_right_ = s;
      if (body(s) + 2 < bodies_->count()) {
        if (s == last_) {
          gaps_[++last_] = load(body(s) + 1, time);
          masses_.set(last_ + 1, bodies_->mass(body(last_) + 1));
        }
        right_.body = body(s) + 2;
      } else {
        right_.body = body(s) + 1;
        turn(right_, time, outcome.to_right);
        seal(s + 1, time, outcome.to_right);
      }
    }
    return cramped() ? Notice::needs_slots : Notice::none;
  }

  // There is no gap beyond the last body: what stands in its slot keeps opening, whatever it is handed.
  void seal(Slot s, const T& time, const T& handed) {
    gaps_[s] = Gap<T>{};
    gaps_[s].closing = -(handed + handed) - T(1);
    gaps_[s].time = time;
    local_times_.set_lag(s, T(0));
  }

  // Whether both bodies of the gap have had their last contact longer ago than that. Remembers this one.
  bool rested(Slot s, const T& time, const T& contact_time) {
    if (last_contact_.empty()) {
      longest_ago_ = clock_.offset(clock_.start()) - contact_time - T(1);
      last_contact_.assign(gaps_.size(), longest_ago_);
    }
    bool all = true;
    for (const Slot each : {left(s), s, right(s)}) all = all && time - last_contact_[each] > contact_time;
    last_contact_[s] = time;
    return all;
  }

  // Brings a gap up to date and adds to its closing speed.
  [[gnu::always_inline]] Notice kick(Slot s, const T& time, const T& gain) {
    Gap<T>& g = gaps_[s];
    const T flown = local_times_.flown(s, g.time, time);
    if (is_negative(flown)) [[unlikely]]  // keeps its local time: as if it had had the new speed since the contact
      g.gap += gain * flown;
    else {
      g.gap -= g.closing * flown;
      local_times_.renew(s, g.time, time);
    }
    g.closing += gain;
    if (g.gap < floor_) [[unlikely]]
      return note(s, time, flown);
    return Notice::none;
  }

  Notice note(Slot s, const T& time, const T& flown) {
    const Gap<T>& g = gaps_[s];
    if (is_positive(g.gap)) return Notice::gap_below_floor;
    // Times are rounded in units of the offset, the way flown in units of the way.
    const T rounding =
        T(16) * T(std::numeric_limits<T>::epsilon()) * magnitude(g.closing) * (magnitude(time) + magnitude(flown));
    account_.enter({clock_.time(time), body(s), g.gap}, rounding);
    return Notice::gap_below_floor;
  }

  // Queue time of the next contact of a gap touched just now. Wide types: a rounded time will do, the queue knows.
  double predict(Slot s) {
    Gap<T>& g = gaps_[s];
    if constexpr (keys_are_exact) {
      // Whether a gap closes cannot be predicted: choose by bits, where a positive number is a positive integer.
      const auto bits = std::bit_cast<std::uint64_t>(g.time + g.gap / g.closing);
      const auto opening = std::uint64_t{0} - (std::bit_cast<std::int64_t>(g.closing) <= 0);
      return g.due =
                 std::bit_cast<double>((bits & ~opening) | (std::bit_cast<std::uint64_t>(EventQueue::never) & opening));
    } else {
      if (!is_positive(g.closing)) return EventQueue::never;
      if (is_negative(g.time)) [[unlikely]]
        return queue_time(due(s));
      if constexpr (WiderRange<T>) {
        long of_gap = 0, of_closing = 0;
        const double gap = split(g.gap, of_gap), closing = split(g.closing, of_closing);
        return queue_time(g.time) + scale(gap / closing, of_gap - of_closing + shift_);
      } else {
        const double rounded = to_double(g.time) + to_double(g.gap) / to_double(g.closing);
        return std::isfinite(rounded) ? rounded : queue_time(due(s));
      }
    }
  }

  // Queue times are local times in units of 2^-shift, such that the next contact is within the range of double.
  void choose_shift() {
    long least = std::numeric_limits<long>::max();
    for (Slot s = first_; s <= last_; ++s) {
      if (!is_positive(gaps_[s].closing)) continue;
      const T next = due(s);
      long exponent = 0;
      if (split(next, exponent) > 0) least = std::min(least, exponent);
    }
    shift_ = least < -500 || (least > 500 && least < std::numeric_limits<long>::max()) ? -least : 0;
  }

  std::vector<Gap<T>> gaps_;
  std::vector<T> last_contact_;  // local time of the last contact at each gap; empty unless the law has a memory
  T longest_ago_{0};             // what stands there for none
  LocalTimes<T> local_times_;    // beside Gap::time
  Slot first_ = 0, last_ = 0;
  Slot front_left_ = std::numeric_limits<Slot>::max(), front_right_ = 0;  // gaps of the outermost contacts so far
  BodyIndex body_of_slot_0_ = 0;
  T floor_{0};
  long shift_ = 0;  // of queue times, see choose_shift(); stays 0 in types of the range of double
  std::shared_ptr<const Bodies<T>> bodies_;
  bool ring_;
  T centre_{0};  // on a ring: of mass, at the start
  Clock<T> clock_;
  Masses masses_;
  Anchor left_, right_;
  Account<T> account_;
};

template <Real T, class Masses> Configuration<T> GapChain<T, Masses>::ring_configuration(const T& time) const {
  Configuration<T> c;
  c.time = clock_.time(time);
  c.to = bodies_->count() - 1;
  c.collided_to = static_cast<std::size_t>(bodies_->count());
  CompensatedSum<T> way, slowing, moment, momentum;
  std::vector<T> ways, slowings;  // from body 0 to each one
  for (Slot s = first_; s <= last_; ++s) {
    c.index.push_back(body(s));
    c.m.push_back(masses_[s]);
    ways.push_back(way.value());
    slowings.push_back(slowing.value());
    moment.add(c.m.back() * ways.back());
    momentum.add(c.m.back() * slowings.back());
    c.gap.push_back(gap_at(s, time));
    c.closing_speed.push_back(gaps_[s].closing);
    way.add(c.gap.back());
    slowing.add(c.closing_speed.back());
  }
  c.closure_gap = bodies_->circumference() - way.value();
  c.closure_speed = -slowing.value();
  const T mass = bodies_->total_mass(), drift = bodies_->momentum() / mass;
  const Pair<T> start = two_sum(centre_, T(drift * clock_.elapsed(time))) - T(moment.value() / mass);
  const T stretch = c.closure_gap / way.value();
  const T speed = drift + momentum.value() / mass;
  for (std::size_t j = 0; j < ways.size(); ++j) {
    c.x.push_back((start + T(ways[j] + stretch * ways[j])).value());
    c.v.push_back(speed - slowings[j]);
  }
  fold(c, bodies_->circumference());
  return c;
}

template <Real T, class Masses> Configuration<T> GapChain<T, Masses>::configuration(const T& time) const {
  if (ring_) return ring_configuration(time);
  const bool collided = front_left_ <= front_right_;
  const Slot from = collided && front_left_ > first_ ? front_left_ - 1 : first_;
  const Slot to = collided && front_right_ < last_ ? front_right_ + 1 : last_;
  const auto n = static_cast<std::size_t>(to + 2 - from);

  Configuration<T> c;
  c.time = clock_.time(time);
  for (Slot s = from; s <= to + 1; ++s) {
    c.index.push_back(body(s));
    c.m.push_back(masses_[s]);
  }
  c.from = body(from);
  c.to = body(to) + 1;
  if (collided) c.collided_from = front_left_ - from, c.collided_to = front_right_ - from + 2;
  CompensatedSum<T> way, slowing;
  std::vector<T> ways{T(0)}, slowings{T(0)};  // from the left anchor to each body
  for (Slot s = from; s <= to; ++s) {
    c.gap.push_back(gap_at(s, time));
    c.closing_speed.push_back(gaps_[s].closing);
    way.add(c.gap.back());
    slowing.add(c.closing_speed.back());
    ways.push_back(way.value());
    slowings.push_back(slowing.value());
  }
  const Flight left = flight(left_, time), right = flight(right_, time);
  c.closure_gap = difference(right.x, left.x) - way.value();
  c.closure_speed = difference(left.v, right.v) - slowing.value();
  const T stretch = way.value() > T(0) ? T(c.closure_gap / way.value()) : T(0);
  for (std::size_t j = 0; j < n; ++j) {
    c.x.push_back((left.x + T(ways[j] + stretch * ways[j])).value());
    const T share = n > 1 ? T(T(static_cast<std::int64_t>(j)) / T(static_cast<std::int64_t>(n - 1))) : T(0);
    c.v.push_back((left.v - T(slowings[j] + share * c.closure_speed)).value());
  }
  return c;
}

}  // namespace cradle
