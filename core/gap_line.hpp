#pragma once
// The bare line of gaps that a chain in gaps works on: timed gaps with their closing speeds, the masses of the bodies
// between them, and what a contact does to three of them. What is at its ends is the chain's (gap_chain.hpp), or that
// of a segment (segments.hpp), which is a copy of a part of it.

#include <concepts>
#include <cstddef>
#include <tuple>

#include "cradle/core/collision.hpp"
#include "cradle/core/masses.hpp"
#include "cradle/core/timed_gaps.hpp"

namespace cradle {

// In double 32 bytes, two to a line of the cache.
template <Real T> struct alignas(std::same_as<T, double> ? 32 : alignof(T)) Gap : TimedGap<T> {
  T closing{-1};
  static auto state(auto& self) { return std::tuple_cat(TimedGap<T>::state(self), std::tie(self.closing)); }
};

template <Real T, class MassesOf> class GapLine {
 public:
  using Scalar = T;
  using Masses = MassesOf;
  using Gaps = TimedGaps<T, Gap<T>, true>;

  GapLine(const Bodies<T>& bodies, const T& start) : gaps(start, bodies.energy_to_lose()), masses(bodies) {}

  // Like another one, without any gaps yet.
  explicit GapLine(const GapLine& other, std::size_t slots)
      : gaps(other.gaps.clock().start(), T(1)), masses(other.masses.without_slots()) {
    resemble(other, slots, 0);
  }

  Gaps gaps;
  Masses masses;
  BodyIndex body_of_slot_0 = 0;

  static auto state(auto& self) { return std::tie(self.gaps, self.masses, self.body_of_slot_0); }

  // ---- copies of a part (segments.hpp): with so many slots; slot s here is s + offset there
  void resemble(const GapLine& other, std::size_t slots, std::ptrdiff_t offset) {
    gaps.resemble(other.gaps, slots);
    masses.resize(slots);
    body_of_slot_0 = other.body_of_slot_0 + offset;
  }
  void copy(const GapLine& other, Slot from, Slot to, std::size_t count) {
    gaps.copy(other.gaps, from, to, count);
    masses.copy(other.masses, from, to, count + 1);
  }
  // A gap that no contact beside it closes.
  void block(Slot s) { gaps.put(s, {{T(1), T(0)}, T(-std::int64_t{1} << 62)}); }

  BodyIndex body(Slot s) const { return static_cast<BodyIndex>(s) + body_of_slot_0; }
  const T& closing(Slot s) const { return gaps[s].closing; }
  // Local time of the next contact of a gap that is closing.
  T due(Slot s) const { return gaps.due(s, closing(s)); }
  double queue_due(Slot s) const { return gaps.queue_due(s, closing(s)); }

  // As it is at the start, the gap right of a body, and the mass of a body.
  void load(Slot s, const Bodies<T>& bodies, const T& time) {
    gaps.put(s, {{bodies.gap(body(s)), time}, bodies.closing_speed(body(s))});
    gaps.foresee(s, closing(s));
  }
  void load_mass(Slot s, const Bodies<T>& bodies) { masses.set(s, mass_of(s, bodies)); }
  bool has_mass(Slot s, const Bodies<T>& bodies) const { return masses[s] == mass_of(s, bodies); }

  // What a contact at the gap s does to it and to its neighbours p and n. Inlined by force: as a call this passes all
  // results through memory, a fifth of the time per contact.
  [[gnu::always_inline]] Collision<T> strike(Slot p, Slot s, Slot n, const T& time, const Outcome<T>& outcome,
                                             Notice notice) {
    const T since = gaps.flown(s, time);
    notice |= of_flight(gaps.queue_time(since), gaps.queue_time(time));
    gaps.close(s, outcome.closing, since, time);
    gaps[s].closing = outcome.closing;
    gaps.forget(s);
    notice |= kick(p, outcome.to_left, since, time);
    notice |= kick(n, outcome.to_right, since, time);
    return {outcome, gaps.predict(p, closing(p)), EventQueue::never, gaps.predict(n, closing(n)), notice, p, n};
  }

  // There is no gap beyond the last body: what stands in its slot keeps opening, whatever it is handed.
  void seal(Slot s, const T& time, const T& handed) { gaps.put(s, {{T(1), time}, T(-(handed + handed) - T(1))}); }

 private:
  // That of any body where there is none, or a wall.
  T mass_of(Slot s, const Bodies<T>& bodies) const {
    return bodies.mass(body(s) >= 0 && body(s) < bodies.count() ? body(s) : 0);
  }
  // Brings a gap up to date and adds to its closing speed; `struck` is the time since the local time of the gap beside
  // it that had the contact.
  [[gnu::always_inline]] Notice kick(Slot s, const T& gain, const T& struck, const T& time) {
    const T since = gaps.kick(
        s, closing(s), [&]() -> const T& { return gain; }, time);
    gaps[s].closing += gain;
    if (gaps.below_floor(s)) [[unlikely]]
      return gaps.note(s, closing(s), gain, since, struck, body(s), time);
    return Notice::none;
  }
};

}  // namespace cradle
