#pragma once
// A gas on a piece of a line, which two walls close (walled.hpp): particles of mass 1, or with other masses, at equal
// distances, displaced at random or at random places, with independent velocities of a given variance. Places and
// velocities are whole numbers times a unit that every scalar type rounds, as on a ring (ring.hpp); but no mean
// velocity is taken off, since walls do not conserve momentum.

#include <stdexcept>
#include <string>
#include <utility>

#include "cradle/core/initial/mass_pattern.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/initial/ring.hpp"
#include "cradle/core/initial/rows.hpp"

namespace cradle {

template <Real T> class Gas final : public PatternedParticles<T> {
  using PatternedParticles<T>::count_;

 public:
  // From `left` on over `length`. `deviation`: standard deviation of the velocities. Throws std::invalid_argument for
  // no particles, 2^31 or more of them, or a length or deviation that is not positive and finite.
  Gas(ParticleIndex count, T left, T length, T deviation, VelocityDraw velocity, Displacement displacement,
      MassPattern<T> masses = {})
      : PatternedParticles<T>(count, std::move(masses)), left_(std::move(left)), velocity_(std::move(velocity)),
        displacement_(std::move(displacement)), unit_(length / (T(count) * T(displacement_unit))),
        velocity_unit_(deviation / T(displacement_unit)) {
    if (count < 1 || count >= std::int64_t{1} << 31)
      throw std::invalid_argument("a gas of " + std::to_string(count) + " particles: give it from 1 to 2147483647");
    require_finite(left_, "left end of the gas");
    require_finite(length, "length of the gas");
    require_finite(deviation, "standard deviation of the velocities");
    if (!(length > T(0) && deviation > T(0)))
      throw std::invalid_argument("length or variance of the gas is not positive (length " + in_message(length) +
                                  ", standard deviation " + in_message(deviation) + "): give positive numbers");
    this->add_up(0, count);
  }

  T velocity(ParticleIndex particle) const override { return T(velocity_(particle)) * velocity_unit_; }
  T position(ParticleIndex particle) const override {
    return left_ + T((2 * particle + 1) * (displacement_unit / 2) + displacement_(particle)) * unit_;
  }
  T gap(ParticleIndex particle) const override {
    return T(displacement_unit + displacement_(particle + 1) - displacement_(particle)) * unit_;
  }
  // Between the particle at an end and that end of the gas.
  T gap_to(End end) const {
    const std::int64_t half = displacement_unit / 2;
    return T(end == End::left ? half + displacement_(0) : half - displacement_(count_ - 1)) * unit_;
  }
  T closing_speed(ParticleIndex particle) const override {
    return T(velocity_(particle) - velocity_(particle + 1)) * velocity_unit_;
  }

 private:
  T left_;
  VelocityDraw velocity_;
  Displacement displacement_;
  T unit_, velocity_unit_;
};

}  // namespace cradle
