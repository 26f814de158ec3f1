#pragma once
// Gravity as a chain sees it: a pull on the gaps to walls, and on nothing else (laws/approach.hpp). Whether there is
// gravity is a type, chosen once: without it a chain has none of this.

#include "cradle/core/initial/particles.hpp"
#include "cradle/core/laws/approach.hpp"

namespace cradle {

template <Real T> class Gravity {
 public:
  static constexpr bool acts = true;

  explicit Gravity(const Particles<T>& particles)
      : acceleration_(particles.acceleration()), splitter_(splitter<T>()),
        left_(particles.wall(End::left) != nullptr ? -1 : none),
        right_(particles.wall(End::right) != nullptr ? particles.count() - 1 : none) {}

  const T& acceleration() const { return acceleration_; }
  // Whether this is the gap to a wall.
  bool pulls(ParticleIndex gap) const { return gap == left_ || gap == right_; }
  Approach<T> approach(ParticleIndex gap, const T& size, const T& closing) const {
    return {size, closing, gap == left_ ? T(-acceleration_) : acceleration_, splitter_};
  }

 private:
  static constexpr ParticleIndex none = std::numeric_limits<ParticleIndex>::min();
  T acceleration_, splitter_;
  ParticleIndex left_, right_;  // the gaps to walls
};

template <Real T> class NoGravity {
 public:
  static constexpr bool acts = false;
  explicit NoGravity(const Particles<T>&) {}
};

// A chain with gravity. In it closing speeds of gaps to walls change between collisions.
template <class C>
concept FallingChain = requires {
  requires C::falls;
};

// Whether a collision with a wall under gravity is below the law's cut-off. On an inelastic floor particles collapse
// without any others; so collisions with walls below the cut-off are elastic too, also if it sets in slowly among
// particles: as slowly a particle would come to rest on the floor only after exponentially many collisions.
template <Real T, class Law> bool below_cutoff(const Law& law, const T& w) {
  if constexpr (requires { law.below_cutoff(w); })
    return law.below_cutoff(w);
  else if constexpr (requires { law.cutoff(); })
    return w < law.cutoff();
  else
    return false;
}

}  // namespace cradle
