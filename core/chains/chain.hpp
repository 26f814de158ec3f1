#pragma once
// What the event loop requires of a chain, and what a chain reports of a collision. A chain holds the particles of a
// run in order, in coordinates of its choice. It knows the next collision of each gap, makes one collision at a time
// and reports its result; the loop decides which collision is next.
//
// Slots number the gaps from left to right; the held ones are first() to last(), and there are two empty ones at either
// end. (In `ClusterChain` they are cells, some of them vacant; the last one of a line has no gap.) Local times
// represent times of the scene inside the chain: offsets from an origin that moves, or the times themselves. A local
// time is valid until the origin moves.

#include <concepts>
#include <cstddef>
#include <optional>

#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/chains/gravity.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

// The requests of a chain to the event loop after a collision, handled off the hot path: a set, named by what to do.
enum class Notice : unsigned {
  none = 0,
  origin_should_move = 1,  // the flight before the collision was shorter than 2^-20 of the time since the origin
  origin_must_move = 2,    // shorter than 2^-40 of it: time loses digits unless the origin moves now
  gap_below_floor = 4,     // the collision left a neighbouring gap below the floor (collapse, or a gap that has closed)
  needs_slots = 8          // lay the chain out anew: no slot is left for the next particle of a row, or many are vacant
};

constexpr Notice operator|(Notice a, Notice b) {
  return static_cast<Notice>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr Notice& operator|=(Notice& a, Notice b) { return a = a | b; }
constexpr Notice when(bool holds, Notice notice) {
  return static_cast<Notice>(static_cast<unsigned>(holds) * static_cast<unsigned>(notice));
}
// Whether it has any of the others.
constexpr bool includes(Notice notices, Notice others) {
  return (static_cast<unsigned>(notices) & static_cast<unsigned>(others)) != 0;
}

// The request after a flight that ends at the given time since the origin, both as queue times.
[[gnu::always_inline]] inline Notice of_flight(double flown, double time) {
  return when(flown < time * 0x1p-20, Notice::origin_should_move) |
         when(flown < time * 0x1p-40, Notice::origin_must_move);
}

// The law's outcome and the next collisions of the three gaps involved, as queue times.
template <Real T> struct CollisionResult {
  Outcome<T> outcome;
  double due_left, due, due_right;
  Notice notice;
  Slot left, right;  // of the gaps on either side
};

template <class C>
concept Chain = Real<typename C::Scalar> && requires(const C chain, C changing, Slot s, const typename C::Scalar time) {
  typename C::Scalar;
  // Whether queue times are the exact local times, not rounded ones; whether gaps can shrink without limit.
  { C::keys_are_exact } -> std::convertible_to<bool>;
  { C::may_collapse } -> std::convertible_to<bool>;

  // The time of the scene at which the run starts; conversions from times of the scene to local ones and back, and from
  // local times to queue times. `move_origin` takes the local time of the new origin and returns its new local time.
  { chain.start() } -> std::convertible_to<typename C::Scalar>;
  { chain.local_time(time) } -> std::convertible_to<typename C::Scalar>;
  { chain.stamp(time) } -> std::same_as<Pair<typename C::Scalar>>;
  { chain.queue_time(time) } -> std::same_as<double>;
  { changing.move_origin(time) } -> std::convertible_to<typename C::Scalar>;

  // The held gaps: the number of slots, the neighbours of a slot, the particle on its left.
  { chain.slots() } -> std::same_as<std::size_t>;
  { chain.first() } -> std::same_as<Slot>;
  { chain.last() } -> std::same_as<Slot>;
  { chain.left(s) } -> std::same_as<Slot>;
  { chain.right(s) } -> std::same_as<Slot>;
  { chain.particle(s) } -> std::same_as<ParticleIndex>;
  { chain.on_ring() } -> std::same_as<bool>;

  // Closing speed; local time of the next collision of a gap that is closing; that time as a queue time, or `never` if
  // the gap opens.
  { chain.closing(s) } -> std::convertible_to<typename C::Scalar>;
  { chain.due(s) } -> std::convertible_to<typename C::Scalar>;
  { chain.queue_due(s) } -> std::same_as<double>;

  // Whether anything falls or is shaken: closing speeds of gaps to walls then change between collisions. What follows a
  // collision that has just been made, if it was with a floor.
  { chain.falls() } -> std::same_as<bool>;
  { chain.rebound(s) } -> std::same_as<std::optional<Rebound<typename C::Scalar>>>;

  // Sets the gap floor: collisions that leave a smaller gap beside them are noticed. Reads the smaller gap beside the
  // last collision, at its time (a gap beyond an end is far away); the least difference of two collision times that is
  // resolved; the account of what could not be resolved.
  changing.set_floor(time);
  { chain.nearest_gap(s) } -> std::convertible_to<typename C::Scalar>;
  { chain.time_resolution(s, time) } -> std::convertible_to<typename C::Scalar>;
  { chain.account() } -> std::same_as<const Account<typename C::Scalar>&>;

  // Enters the energy lost by a collision at a gap; all energy lost.
  changing.lose(s, time);
  { chain.energy_lost() } -> std::convertible_to<typename C::Scalar>;

  // Reading, at a local time not before the last collision: a gap; the kinetic energy of all particles of the scene;
  // the outermost particles that have collided, of which there must be some, and the number of particles between them,
  // both included; the configuration.
  { chain.gap_at(s, time) } -> std::convertible_to<typename C::Scalar>;
  { chain.kinetic_energy(time) } -> std::convertible_to<typename C::Scalar>;
  { chain.front_left(time) } -> std::convertible_to<typename C::Scalar>;
  { chain.front_right(time) } -> std::convertible_to<typename C::Scalar>;
  { chain.collided_particles() } -> std::same_as<ParticleIndex>;
  { chain.configuration(time) } -> std::same_as<Configuration<typename C::Scalar>>;
};

// The smallest gap held at the start; throws std::invalid_argument if one is not a number.
template <Chain C> typename C::Scalar smallest_gap(const C& chain) {
  using T = typename C::Scalar;
  const T start = chain.local_time(chain.start());
  T least = far_away<T>();
  for (Slot s = chain.first(); s <= chain.last(); ++s) {
    const T gap = chain.gap_at(s, start);
    require(is_finite(gap) && is_finite(T(chain.closing(s))), "the distance or closing speed of particles ",
            chain.particle(s), " and the next is not finite: check their positions and velocities");
    if (gap < least) least = gap;
  }
  return least;
}

// A chain that requests to be laid out anew (Notice::needs_slots). Slots are renumbered then.
template <class C>
concept StreamingChain = Chain<C> && requires(C chain) {
  chain.make_room();
};

// A chain that can make a collision at slot s, due at the given local time, by this law.
template <class C, class L>
concept CollidesBy = Chain<C> && Law<L, typename C::Scalar> &&
    requires(C chain, const L& law, Slot s, const typename C::Scalar& time) {
  { chain.collide(law, s, time) } -> std::same_as<CollisionResult<typename C::Scalar>>;
};

}  // namespace cradle
