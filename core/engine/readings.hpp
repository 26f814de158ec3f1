#pragma once
// What can be read of a run between two collisions. Times of readings are times of the scene, between the last
// collision and the time advanced to.

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "cradle/core/chains/chain.hpp"
#include "cradle/core/engine/status.hpp"

namespace cradle {

template <class Chain> class Readings {
  using T = typename Chain::Scalar;

 public:
  using Scalar = T;

  const Chain& chain() const { return chain_; }
  const Account<T>& account() const { return chain_.account(); }

  // The state at a time between the last collision and the time advanced to.
  Configuration<T> configuration(const T& time) const {
    Configuration<T> now = chain_.configuration(local(time));
    now.time = time;  // the clock, which counts from its origin, rounds it
    return now;
  }
  // The state right after the last collision. At the rounded time of the scene, gaps that close within the rounding
  // would be negative.
  Configuration<T> configuration_at_last_collision() const { return chain_.configuration(last_collision_); }
  bool on_ring() const { return chain_.on_ring(); }
  ParticleIndex collided_particles() const { return chain_.collided_particles(); }
  T front_left(const T& time) const { return chain_.front_left(local(time)); }
  T front_right(const T& time) const { return chain_.front_right(local(time)); }
  // The gap between a wall and the particle beside it, at such a time; nothing if there is no wall.
  std::optional<T> gap_to_wall(End end, const T& time) const {
    if constexpr (requires { chain_.walls(); }) {
      const Slot s = end == End::left ? chain_.first() : chain_.last();
      const ParticleIndex gap = chain_.particle(s);
      const auto& walls = chain_.walls();
      if (end == End::left ? walls.left_of(gap) : walls.right_of(gap)) return chain_.gap_at(s, local(time));
    }
    return {};
  }
  const Counts& counts() const { return counts_; }
  T energy_lost() const { return chain_.energy_lost(); }
  // At a time between the last collision and the time advanced to, which matters if a wall carries a particle.
  T energy_lost(const T& time) const {
    if constexpr (requires { wall_tallies(time); })
      if (falls()) return chain_.energy_lost() - (given_by(wall_tallies(time)) - given_by(chain_.walls().tallies()));
    return chain_.energy_lost();
  }
  WallTallies<T> wall_tallies(const T& time) const requires requires(const Chain& c) { c.walls(); }
  {
    if constexpr (requires { chain_.walls_at(time); })
      return chain_.walls_at(local(time)).tallies();
    else
      return chain_.walls().tallies();
  }
  // After the last collision; at a time between it and the time advanced to, which matters if particles fall.
  T kinetic_energy() const { return chain_.kinetic_energy(last_collision_); }
  T kinetic_energy(const T& time) const { return chain_.kinetic_energy(local(time)); }
  bool falls() const { return chain_.falls(); }
  // The start if there has been no collision.
  T last_collision_time() const { return chain_.stamp(last_collision_).value(); }

 protected:
  explicit Readings(Chain chain) : chain_(std::move(chain)), last_collision_(chain_.local_time(chain_.start())) {}

  void begin_again(std::shared_ptr<const Particles<T>> particles) {
    if constexpr (requires { chain_.begin_again(particles); })
      chain_.begin_again(std::move(particles));
    else
      chain_ = Chain(std::move(particles), T(chain_.start()));
    last_collision_ = chain_.local_time(chain_.start());
    counts_ = {};
  }

  // The local time of a reading. Where particles fall, the rounded time of the last collision stands for the state
  // which that collision has left: at any other time a particle that has come to rest on a floor would have fallen for
  // a rounding.
  T local(const T& time) const {
    if (falls() && time == last_collision_time()) return last_collision_;
    return chain_.local_time(time);
  }
  // Whether particles slower than a given speed come to rest on a wall.
  bool can_rest() const {
    if constexpr (requires { chain_.particles(); })
      return falls() && chain_.particles().holding() != nullptr;
    else
      return false;
  }
  T elapsed(const T& local) const { return difference(chain_.stamp(local), Pair<T>{chain_.start(), T(0)}); }
  std::uint64_t active() const { return static_cast<std::uint64_t>(chain_.collided_particles()); }

  Chain chain_;
  T last_collision_;  // local time; the start if there was none
  Counts counts_;
};

}  // namespace cradle
