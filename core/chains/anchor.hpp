#pragma once
// Particles whose flight is known, from which the positions and velocities of the others are computed: a particle that
// has not collided, or the last one at an end of a line, which is followed from collision to collision.

#include "cradle/core/base/fields.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/queue/clock.hpp"

namespace cradle {

template <Real T> struct Flight {
  Pair<T> x, v;
  static auto state(auto& self) { return fields(self.x, self.v); }
};

// What gravity adds in a time to the velocity and to the place of every particle.
template <Real T> struct Fall {
  T speed, way;
  Fall(const Particles<T>& particles, const T& time)
      : speed(particles.acceleration() * time), way(speed * time / T(2)) {}
};

// Adds to the straight flight of a particle, after a time, what gravity does in it.
template <Real T>
Flight<T> fallen(Flight<T> straight, const Particles<T>& particles, ParticleIndex particle, const T& time) {
  if (!particles.falls(particle)) return straight;
  const Fall<T> fall(particles, time);
  return {straight.x + fall.way, straight.v + fall.speed};
}

// The flight of a particle that has not collided, at a time since the start.
template <Real T> Flight<T> undisturbed(const Particles<T>& particles, ParticleIndex particle, const T& elapsed) {
  const T v = particles.velocity(particle);
  return fallen<T>({two_sum(particles.position(particle), T(v * elapsed)), {v, T(0)}}, particles, particle, elapsed);
}

// The way of such a particle from its place at the start, without the rounding of places.
template <Real T> T undisturbed_way(const Particles<T>& particles, ParticleIndex particle, const T& elapsed) {
  return particles.velocity(particle) * elapsed + Fall<T>(particles, elapsed).way;
}

// The place and velocity of a wall after a time since the start; there must be a wall with this number (-1 or count).
template <Real T> Flight<T> at_wall(const Particles<T>& particles, ParticleIndex particle, const Pair<T>& elapsed) {
  const Wall<T>& wall = *particles.wall_at(particle);
  const Flight<T> straight{two_sum(wall.position, T(wall.speed * elapsed.value())), {wall.speed, T(0)}};
  const auto shift = particles.shift(particle, elapsed);
  return {straight.x + shift.x, straight.v + shift.v};
}

// Times are local ones of the chain that the clock belongs to.
template <Real T> class Anchor {
 public:
  ParticleIndex particle() const { return particle_; }

  Flight<T> flight(const Particles<T>& particles, const Clock<T>& clock, const T& time) const {
    if (particles.shaken(particle_)) return at_wall(particles, particle_, clock.since_start(time));
    if (!collided_) return undisturbed(particles, particle_, clock.elapsed(time));
    const T flown = difference(Pair<T>{time, T(0)}, since_);
    return fallen<T>({from_.x + T(from_.v.value() * flown), from_.v}, particles, particle_, flown);
  }

  T velocity(const Particles<T>& particles) const {
    return collided_ ? from_.v.value() : particles.velocity(particle_);
  }

  // Changes to a particle that has not collided.
  void take(ParticleIndex particle) { particle_ = particle; }
  // The particle, the last one of a line, has had this flight until now, and gains velocity in a collision: Gain is T
  // or Pair<T>.
  template <class Gain> void follow(const Flight<T>& until_now, const T& time, const Gain& gain) {
    from_ = until_now;
    from_.v = from_.v + gain;
    since_ = {time, T(0)};
    collided_ = true;
  }
  void move_origin(const T& by) { since_ = since_ - by; }
  static auto state(auto& self) { return fields(self.particle_, self.collided_, self.from_, self.since_); }

 private:
  ParticleIndex particle_ = 0;
  bool collided_ = false;
  Flight<T> from_;  // after a collision: as its last collision, at the time since_, left it
  Pair<T> since_;
};

}  // namespace cradle
