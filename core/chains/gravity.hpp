#pragma once
// Gravity and shaken walls as a chain sees them: a pull on the gaps to walls, or a motion of these walls, and nothing
// else (laws/wall_approach.hpp). Whether there is either is a type, chosen once: without it a chain
// has none of this.

#include "cradle/core/initial/particles.hpp"
#include "cradle/core/laws/wall_approach.hpp"

namespace cradle {

template <Real T> class Gravity {
 public:
  static constexpr bool acts = true;

  explicit Gravity(const Particles<T>& particles)
      : acceleration_(particles.acceleration()), splitter_(splitter<T>()), left_(end(particles, End::left)),
        right_(end(particles, End::right)) {}

  const T& acceleration() const { return acceleration_; }
  // Whether this is a gap to a wall that does not close uniformly.
  bool pulls(ParticleIndex gap) const { return gap == left_.gap || gap == right_.gap; }
  // Of a gap that it pulls, at a time since the start.
  WallApproach<T> approach(ParticleIndex gap, const T& size, const T& closing, const Pair<T>& since) const {
    const bool left = gap == left_.gap;
    return {size, closing, left ? T(-acceleration_) : acceleration_, splitter_, (left ? left_ : right_).wall, since};
  }
  // Whether a particle that meets the wall at this speed stays on it.
  bool holds(ParticleIndex gap, const T& speed, const Pair<T>& elapsed) const {
    const AtEnd& end = gap == left_.gap ? left_ : right_;
    return end.gap == gap && end.wall.holds && speed < end.rest_speed &&
           end.wall.presses(gap == left_.gap ? T(-acceleration_) : acceleration_, elapsed);
  }
  // The speed towards the particles at which the wall at a gap is shaken.
  T shaken_at(ParticleIndex gap, const Pair<T>& elapsed) const {
    if (!pulls(gap)) return T(0);
    const WallMotion<T>* motion = (gap == left_.gap ? left_ : right_).wall.motion;
    return motion != nullptr ? motion->speed(motion->at(elapsed).rest) : T(0);
  }

 private:
  static constexpr ParticleIndex none = std::numeric_limits<ParticleIndex>::min();
  struct AtEnd {
    ParticleIndex gap = none;
    HoldingWall<T> wall = {};
    T rest_speed{0};
  };
  static AtEnd end(const Particles<T>& particles, End end) {
    const Wall<T>* wall = particles.wall(end);
    if (wall == nullptr || !(particles.fall() || wall->motion != nullptr)) return {};
    const T pull = end == End::left ? T(-particles.acceleration()) : particles.acceleration();
    const WallMotion<T>* motion = wall->motion.get();
    return {end == End::left ? -1 : particles.count() - 1,
            {motion, wall->holds(), motion != nullptr ? motion->release(pull) : std::nullopt},
            wall->rest_speed};
  }

  T acceleration_, splitter_;
  AtEnd left_, right_;
};

template <Real T> class NoGravity {
 public:
  static constexpr bool acts = false;
  explicit NoGravity(const Particles<T>&) {}
};

// A chain with gravity or shaken walls. In it closing speeds of gaps to walls change between collisions.
template <class C>
concept FallingChain = requires {
  requires C::falls;
};

// Whether a collision with a wall under gravity, or where a wall is shaken, is below the law's cut-off. On an inelastic
// floor particles collapse without any others; so collisions with walls below the cut-off are elastic too, also if it
// sets in slowly among particles: as slowly a particle would come to rest on the floor only after exponentially many
// collisions.
template <Real T, class Law> bool below_cutoff(const Law& law, const T& w) {
  if constexpr (requires { law.below_cutoff(w); })
    return law.below_cutoff(w);
  else if constexpr (requires { law.cutoff(); })
    return w < law.cutoff();
  else
    return false;
}

}  // namespace cradle
