#pragma once
// A gas on a piece of a line, which two walls close (walled.hpp): particles of mass 1, or with other masses, at equal
// distances, displaced at random or at random places, with independent velocities of a given variance. Places and
// velocities are whole numbers times a unit that every scalar type rounds, as on a ring (ring.hpp); but no mean
// velocity is taken off, since walls do not conserve momentum.

#include <utility>
#include <vector>

#include "cradle/core/initial/mass_pattern.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/initial/ring.hpp"
#include "cradle/core/initial/rows.hpp"

namespace cradle {

template <Real T> class Gas final : public OnLattice<T> {
  using OnLattice<T>::displacement_, OnLattice<T>::unit_;

 public:
  // From `left` on over `length`. `deviation`: standard deviation of the velocities. Throws std::invalid_argument for
  // no particles, 2^31 or more of them, or a length or deviation that is not positive and finite.
  Gas(ParticleIndex count, T left, T length, T deviation, const VelocityDraw& draw, Displacement displacement,
      MassPattern<T> masses = {})
      : OnLattice<T>(count, T(length / (T(count) * T(displacement_unit))), std::move(displacement), std::move(masses)),
        left_(std::move(left)), velocity_unit_(deviation / T(displacement_unit)) {
    require_finite(left_, "left end of the gas");
    detail::require_gas("gas", count, length, deviation);
    pace_ = drawn(draw, 0, count);
    this->add_up(0, count);
  }

  T velocity(ParticleIndex particle) const override { return T(pace(particle)) * velocity_unit_; }
  T position(ParticleIndex particle) const override { return left_ + T(this->place_from_end(particle)) * unit_; }
  // Between the particle at an end and that end of the gas.
  T gap_to(End end) const {
    const std::int64_t half = displacement_unit / 2;
    return T(end == End::left ? half + displacement_(0) : half - displacement_(this->count_ - 1)) * unit_;
  }
  T closing_speed(ParticleIndex particle) const override {
    return T(pace(particle) - pace(particle + 1)) * velocity_unit_;
  }

 private:
  std::int64_t pace(ParticleIndex particle) const { return pace_[static_cast<std::size_t>(particle)]; }

  T left_;
  std::vector<std::int64_t> pace_;  // in units of velocities
  T velocity_unit_;
};

}  // namespace cradle
