#pragma once
// Particles on a line with walls at one end or both (wall.hpp), gravity, or both. Shaken walls are as at the start.

#include <utility>

#include "cradle/core/initial/particles.hpp"

namespace cradle {

// Gap and closing speed of a particle at an end and its wall, which is in its place.
template <Real T> struct AtWall { T gap, closing_speed; };

template <Real T> class Walled final : public Particles<T> {
 public:
  // Throws std::invalid_argument for particles on a ring, walls that are not outside the particles, a floor that keeps
  // what falls on it without a rest speed, two walls on which several can rest, and numbers out of range.
  // `at_left`, `at_right`: what is known more precisely than as a difference of rounded numbers.
  Walled(std::shared_ptr<const Particles<T>> particles, std::optional<Wall<T>> left, std::optional<Wall<T>> right,
         const T& acceleration = T(0), std::optional<AtWall<T>> at_left = {}, std::optional<AtWall<T>> at_right = {})
      : particles_(std::move(particles)), count_(particles_->count()), left_(std::move(left)), right_(std::move(right)),
        at_left_(std::move(at_left)), at_right_(std::move(at_right)), acceleration_(acceleration) {
    require_finite(acceleration_, "acceleration of the particles");
    require(!particles_->on_ring(), this->fall() ? "gravity" : "walls", " on a ring (circumference ",
            particles_->circumference(), "): leave ", this->fall() ? "it" : "them",
            " out, or give particles on a line");
    if (left_) require_wall(*left_, "left"), require_outside(gap(-1), "left", position(-1), 0);
    if (right_)
      require_wall(*right_, "right"), require_outside(gap(count() - 1), "right", position(count()), count() - 1);
    if (count() > 1 && left_ && right_ && (left_->holds() || right_->holds())) {
      require_one_pile(!(left_->holds() && right_->holds()), "a rest speed, which a wall at one end may have");
      require_one_pile(left_->motion == nullptr || right_->motion == nullptr,
                       "a motion, between which particles would rest");
    }
    for (const auto* wall : {&left_, &right_})
      if (*wall && (&**wall == this->floor() || (*wall)->motion != nullptr) && !((*wall)->temperature > 0) &&
          !is_positive((*wall)->restitution) && !is_positive((*wall)->rest_speed))
        require(false, "a floor or shaken wall of restitution 0, on which particles come to rest (restitution ",
                (*wall)->restitution, "): give it a rest speed, or a small restitution");
    if (this->fall()) potential_energy_ = -(acceleration_ * (total_mass() * particles_->centre_of_mass()));
  }

  ParticleIndex count() const override { return count_; }
  T position(ParticleIndex particle) const override {
    if (!is_wall(particle)) return particles_->position(particle);
    const Wall<T>& wall = at(particle);
    return wall.motion == nullptr ? wall.position : T(wall.position + at_start(particle).x);
  }
  T velocity(ParticleIndex particle) const override {
    if (!is_wall(particle)) return particles_->velocity(particle);
    const Wall<T>& wall = at(particle);  // 0 is not added to a ball: that rounds
    return wall.motion == nullptr ? wall.speed : T(wall.speed + at_start(particle).v);
  }
  T mass(ParticleIndex particle) const override { return particles_->mass(is_wall(particle) ? 0 : particle); }
  bool identical_masses() const override { return particles_->identical_masses(); }
  const Wall<T>* wall(End end) const override {
    const auto& wall = end == End::left ? left_ : right_;
    return wall ? &*wall : nullptr;
  }

  T gap(ParticleIndex particle) const override {
    if (!is_wall(particle) && !is_wall(particle + 1)) return particles_->gap(particle);
    const auto& known = is_wall(particle) ? at_left_ : at_right_;
    if (!known) return position(particle + 1) - position(particle);
    return is_wall(particle) ? T(known->gap - at_start(particle).x) : T(known->gap + at_start(particle + 1).x);
  }
  T closing_speed(ParticleIndex particle) const override {
    if (!is_wall(particle) && !is_wall(particle + 1)) return particles_->closing_speed(particle);
    const auto& known = is_wall(particle) ? at_left_ : at_right_;
    if (!known) return velocity(particle) - velocity(particle + 1);
    return is_wall(particle) ? T(known->closing_speed + at_start(particle).v)
                             : T(known->closing_speed - at_start(particle + 1).v);
  }
  GapRange gaps_in_motion() const override {
    const GapRange inner = particles_->gaps_in_motion(), all = this->gaps();
    return {left_ ? all.first : inner.first, right_ ? all.last : inner.last};
  }

  T acceleration() const override { return acceleration_; }
  T potential_energy() const override { return potential_energy_; }
  T kinetic_energy() const override { return particles_->kinetic_energy(); }
  T momentum() const override { return particles_->momentum(); }
  T conserved_momentum() const override { return particles_->conserved_momentum(); }
  T total_mass() const override { return particles_->total_mass(); }
  T mass_between(ParticleIndex from, ParticleIndex to) const override { return particles_->mass_between(from, to); }
  T least_mass() const override { return particles_->least_mass(); }
  T greatest_mass() const override { return particles_->greatest_mass(); }
  T rounded_place(ParticleIndex particle) const override {
    if (!is_wall(particle)) return particles_->rounded_place(particle);
    return (particle < 0 ? at_left_ : at_right_) ? T(0) : at(particle).position;
  }
  // Walls may add energy: the ledger allows for a million times the initial energy, which costs 20 of its spare bits.
  T energy_to_lose() const override {
    if (!this->walled()) return particles_->energy_to_lose();
    T twice_per_mass(0);
    for (const auto* wall : {&left_, &right_})
      if (*wall)
        twice_per_mass +=
            (*wall)->fastest() * (*wall)->fastest() + exactly<T>((*wall)->temperature / to_double(least_mass()));
    return T(1 << 20) * (kinetic_energy() + this->energy_of_fall() + total_mass() * twice_per_mass);
  }

 private:
  bool is_wall(ParticleIndex particle) const { return particle < 0 || particle >= count(); }
  const Wall<T>& at(ParticleIndex particle) const { return particle < 0 ? *left_ : *right_; }
  auto at_start(ParticleIndex particle) const { return this->shift(particle, Pair<T>{}); }

  static void require_wall(const Wall<T>& wall, const char* which) {
    require_finite(wall.position, "position of the ", which, " wall");
    require_finite(wall.speed, "speed of the ", which, " wall");
    require(!is_negative(wall.rest_speed) && is_finite(wall.rest_speed), "rest speed of the ", which,
            " wall is out of range (", wall.rest_speed, "): give 0 or more");
    require(!is_negative(wall.restitution) && !(T(1) < wall.restitution), "restitution of the ", which,
            " wall is out of range (", wall.restitution, "): give a number from 0 to 1");
    require(wall.temperature >= 0 && wall.temperature <= std::numeric_limits<double>::max(), "temperature of the ",
            which, " wall is negative or not finite (", wall.temperature,
            "): give a positive one, or 0 for a reflecting wall");
  }
  void require_one_pile(bool one, const char* what) const {
    require(one, "two walls with ", what, " (", count(), " particles, rest speeds ", left_->rest_speed, " and ",
            right_->rest_speed, "): leave it out at one of them");
  }
  void require_outside(const T& gap, const char* which, const T& wall, ParticleIndex particle) const {
    require(is_positive(gap), "the ", which,
            " wall is not outside the particles, which would have met it before the start (wall at ", wall,
            ", particle ", particle, " at ", particles_->position(particle), "): move it outwards");
  }

  std::shared_ptr<const Particles<T>> particles_;
  ParticleIndex count_;  // of these, which collisions at a wall ask for
  std::optional<Wall<T>> left_, right_;
  std::optional<AtWall<T>> at_left_, at_right_;
  T acceleration_, potential_energy_{0};
};

}  // namespace cradle
