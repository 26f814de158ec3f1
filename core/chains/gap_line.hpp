#pragma once
// `GapLine` is the line of gaps of a `GapChain`. It holds the gaps with their local times and closing speeds, and the
// masses of the particles between them, and it computes what a collision does to three gaps. Its ends are handled by
// its owner: by the chain (gap_chain.hpp), or by a segment, which works on a copy of a part of the line (segments.hpp).

#include <cstddef>
#include <type_traits>
#include <utility>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/chains/certainty.hpp"
#include "cradle/core/chains/chain.hpp"
#include "cradle/core/chains/masses.hpp"
#include "cradle/core/chains/timed_gaps.hpp"
#include "cradle/core/chains/watched_gap.hpp"

namespace cradle {

// Stands in for `Certainty` in a line whose masses are not watched; it holds nothing.
struct NothingMore {
  static auto state(auto&) { return fields(); }
};

template <Real T, class MassesOf> class GapLine {
 public:
  using Scalar = T;
  using Masses = MassesOf;
  static constexpr bool watched = Watched<Masses>;
  using Gaps = TimedGaps<T, std::conditional_t<watched, WatchedGap<T>, Gap<T>>>;

  GapLine(const Particles<T>& particles, const T& start, typename Gaps::Memory memory = {})
      : gaps(start, particles.energy_to_lose(), std::move(memory)), masses(particles),
        exact_(cradle::far_apart(particles) && sums_can_be_exact<T>) {}

  // Makes a line like another one, with room for `slots` gaps but without any gap yet.
  explicit GapLine(const GapLine& other, std::size_t slots)
      : gaps(other.gaps.clock().start(), T(1)), masses(other.masses.without_slots()), exact_(other.exact_) {
    resemble(other, slots, 0);
  }

  Gaps gaps;
  Masses masses;
  ParticleIndex particle_of_slot_0 = 0;
  [[no_unique_address]] std::conditional_t<watched, Certainty<T, Gaps>, NothingMore> certainty;

  static auto state(auto& self) { return fields(self.gaps, self.masses, self.particle_of_slot_0, self.certainty); }

  // Whether sums of closing speeds are exact.
  bool exact_sums() const { return watched && exact_; }

  // ---- copies of a part of another line (segments.hpp); slot s of the copy is slot s + offset of the other line
  void resemble(const GapLine& other, std::size_t slots, std::ptrdiff_t offset) {
    gaps.resemble(other.gaps, slots);
    masses.resize(slots);
    particle_of_slot_0 = other.particle_of_slot_0 + offset;
  }
  void copy(const GapLine& other, Slot from, Slot to, std::size_t count) {
    gaps.copy(other.gaps, from, to, count);
    masses.copy(other.masses, from, to, count + 1);
  }
  // Makes a gap that no collision beside it can close.
  void block(Slot s) { gaps.put(s, cell(very_large(), T(0), T(-std::int64_t{1} << 62))); }

  ParticleIndex particle(Slot s) const { return static_cast<ParticleIndex>(s) + particle_of_slot_0; }
  const T& closing(Slot s) const { return gaps[s].closing; }
  void add_closing(Slot s, CompensatedSum<T>& sum) const {
    sum.add(closing(s));
    if constexpr (watched) sum.add(gaps[s].rest);
  }
  T due(Slot s) const { return gaps.due(s, closing(s)); }
  double queue_due(Slot s) const { return gaps.queue_due(s, closing(s)); }

  // The gap right of a particle as at the start, and the mass of the particle.
  void load(Slot s, const Particles<T>& particles, const T& time) {
    const ParticleIndex b = particle(s);
    gaps.put(s, cell(particles.gap(b), time, particles.closing_speed(b)));
    if constexpr (watched) {
      const ParticleIndex next = particles.on_ring() && b + 1 == particles.count() ? 0 : b + 1;
      if (exact_) add(s, two_sum(particles.velocity(b), T(-particles.velocity(next))) - closing(s));
      gaps[s].off = at_start(particles, b, next);
    }
    gaps.foresee(s, closing(s));
  }
  void load_mass(Slot s, const Particles<T>& particles) { masses.set(s, mass_of(s, particles)); }
  bool has_mass(Slot s, const Particles<T>& particles) const { return masses[s] == mass_of(s, particles); }

  // The effect of a collision at the gap s on it and on its neighbours p and n. Inlined by force: a call would pass all
  // results through memory, which costs a fifth of the time per collision.
  [[gnu::always_inline]] CollisionResult<T> strike(Slot p, Slot s, Slot n, const T& time, const Outcome<T>& outcome,
                                                   Notice notice) {
    const T since = gaps.flown(s, time);
    notice |= of_flight(gaps.queue_time(since), gaps.queue_time(time));
    if constexpr (watched)
      certainty.collision(gaps, Straight{gaps}, p, s, n, particle(s), time, closing(s), outcome, masses.of_pair(s),
                          exact_);
    const auto handed = this->handed(s, outcome);
    gaps.close(s, outcome.closing, since, time);
    gaps[s].closing = outcome.closing;
    if constexpr (watched) gaps[s].rest = T(0);
    gaps.forget(s);
    notice |= kick(p, handed.left, since, time);
    notice |= kick(n, handed.right, since, time);
    return {outcome, gaps.predict(p, closing(p)), EventQueue::never, gaps.predict(n, closing(n)), notice, p, n};
  }

  // How gaps move (certainty.hpp): uniformly.
  struct Straight {
    static constexpr bool curved = false;
    const Gaps& gaps;
    [[gnu::always_inline]] GapMotion<T> operator()(Slot s, const T& time) const {
      const T since = gaps.flown(s, time);
      return {since, T(gaps[s].gap - gaps[s].closing * since), gaps[s].closing};
    }
  };

  // Updates a gap and adds to its closing speed; `struck` is the time since the local time of the neighbouring gap that
  // had the collision.
  template <class Gain> [[gnu::always_inline]] Notice kick(Slot s, const Gain& gain, const T& struck, const T& time) {
    const T since = gaps.kick(
        s, closing(s), [&]() -> const T& { return high(gain); }, time);
    if constexpr (watched)
      add(s, gain);
    else
      gaps[s].closing += gain;
    if (gaps.below_floor(s)) [[unlikely]]
      return gaps.note(s, closing(s), high(gain), since, struck, particle(s), time);
    return Notice::none;
  }

  // There is no gap beyond the last particle: its slot holds one that always opens, whatever the collisions give it.
  void seal(Slot s, const T& time, const T& handed) {
    gaps.put(s, cell(very_large(), time, T(-(handed + handed) - T(1))));
  }

  // The gains of the neighbours in a collision at the gap s. With exact sums the three closing speeds keep their sum:
  // the rest of the rounding is added to the larger gain, which is on the side of the lighter particle.
  struct SpeedGains {
    const T &left, &right;
  };
  struct ExactSpeedGains {
    Pair<T> left, right;
  };
  [[gnu::always_inline]] auto handed(Slot s, const Outcome<T>& outcome) const {
    if constexpr (watched) {
      const Pair<T> before{closing(s), gaps[s].rest};
      const T over = exact_ ? T((before - outcome.closing - outcome.to_left - outcome.to_right).value()) : T(0);
      const bool both = outcome.to_left == outcome.to_right, left = outcome.to_right < outcome.to_left;
      const T share = both ? T(over / T(2)) : over, none(0);
      return ExactSpeedGains{{outcome.to_left, both || left ? share : none},
                             {outcome.to_right, both || !left ? share : none}};
    } else {
      return SpeedGains{outcome.to_left, outcome.to_right};
    }
  }

 private:
  using Cell = std::remove_cvref_t<decltype(std::declval<Gaps&>()[Slot{}])>;
  static Cell cell(const T& gap, const T& time, const T& closing) {
    Cell made;
    made.gap = gap;
    made.time = time;
    made.closing = closing;
    return made;
  }
  // Of gaps that are none: no speed closes it during a run, and no error of another gap is as large.
  static T very_large() { return T(far_away<T>() / T(std::int64_t{1} << 60)); }
  static const T& high(const T& gain) { return gain; }
  static const T& high(const Pair<T>& gain) { return gain.high; }
  void add(Slot s, const Pair<T>& gain) {
    if (!exact_) {
      gaps[s].closing += gain.high;
      return;
    }
    const Pair<T> sum = Pair<T>{closing(s), gaps[s].rest} + gain.high + gain.low;
    gaps[s].closing = sum.high;
    gaps[s].rest = sum.low;
  }
  // The mass of the particle, or of any other if there is none or a wall.
  T mass_of(Slot s, const Particles<T>& particles) const {
    return particles.mass(particle(s) >= 0 && particle(s) < particles.count() ? particle(s) : 0);
  }
  bool exact_;
};

}  // namespace cradle
