#pragma once
// Free cooling: particles on a ring (a periodic line), of mass 1 or with other masses, at equal distances or
// displaced at random, with independent velocities of a given variance and zero total momentum. Velocities and
// displacements are whole numbers times a unit (README.md).
//
// Zero momentum: for identical masses the mean is subtracted from the integers, and its remainder, less than one per
// particle, from the first particles. For masses that differ the velocity of the centre of mass, sum m_b n_b / sum m_b
// of the integers n_b, is a fraction: it is subtracted in the working precision; closing speeds do not contain it.

#include <string>
#include <utility>
#include <vector>

#include "cradle/core/initial/mass_pattern.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/core/initial/velocities.hpp"

namespace cradle {

namespace detail {

// Throws std::invalid_argument for what cannot be a gas on a length; `name`: of which kind it is.
template <Real T> void require_gas(const std::string& name, ParticleIndex count, const T& length, const T& deviation) {
  require_countable(count, "a " + name);
  require_finite(length, "length of the ", name);
  require_finite(deviation, "standard deviation of the velocities");
  require(length > T(0) && deviation > T(0), "length or variance of the ", name, " is not positive (length ", length,
          ", standard deviation ", deviation, "): give positive numbers");
}

}  // namespace detail

template <Real T> class Ring final : public OnLattice<T> {
  using OnLattice<T>::count_, OnLattice<T>::masses_;

 public:
  // `deviation`: standard deviation of the velocities. Throws std::invalid_argument for no particles, 2^31 or more of
  // them, a length or deviation that is not positive and finite, or a pattern of masses that does not divide the ring.
  Ring(ParticleIndex count, T length, T deviation, const VelocityDraw& draw, Displacement displacement,
       MassPattern<T> masses = {})
      : OnLattice<T>(count, T(length / (T(count) * T(displacement_unit))), std::move(displacement), std::move(masses)),
        length_(std::move(length)), velocity_unit_(deviation / T(displacement_unit)) {
    detail::require_gas("ring", count, length_, deviation);
    require(count % masses_.period() == 0, "a pattern of ", masses_.period(), " masses does not divide a ring of ",
            count, " particles: give a multiple of it");
    pace_ = drawn(draw, 0, count);
    if (masses_.identical())
      take_off_mean();
    else
      take_off_drift();
    this->add_up(0, count);
    this->momentum_ = T(0);
  }

  T circumference() const override { return length_; }
  T velocity(ParticleIndex particle) const override {
    return (masses_.identical() ? T(pace(particle)) : T(T(pace(particle)) - drift_)) * velocity_unit_;
  }
  T position(ParticleIndex particle) const override { return T(this->place_from_end(particle)) * this->unit_; }
  T gap(ParticleIndex particle) const override { return this->distance(particle, next(particle)); }
  T closing_speed(ParticleIndex particle) const override {
    return T(pace(particle) - pace(next(particle))) * velocity_unit_;
  }
  GapRange gaps_in_motion() const override { return {0, count_ - 1}; }

 private:
  ParticleIndex next(ParticleIndex particle) const { return particle + 1 < count_ ? particle + 1 : 0; }
  std::int64_t pace(ParticleIndex particle) const { return pace_[static_cast<std::size_t>(particle)]; }

  void take_off_mean() {
    std::int64_t sum = 0;
    for (const std::int64_t pace : pace_) sum += pace;
    const std::int64_t mean = sum / count_ - (sum % count_ < 0 ? 1 : 0);
    std::int64_t more = sum - mean * count_;  // so many particles lose one more
    for (std::int64_t& pace : pace_) pace -= mean + (more-- > 0 ? 1 : 0);
  }
  // The sums of integers, one for each entry of the pattern, are exact.
  void take_off_drift() {
    std::vector<std::int64_t> sums(static_cast<std::size_t>(masses_.period()), 0);
    for (ParticleIndex particle = 0; particle < count_; ++particle)
      sums[static_cast<std::size_t>(particle % masses_.period())] += pace(particle);
    CompensatedSum<T> momentum;
    for (ParticleIndex entry = 0; entry < masses_.period(); ++entry)
      momentum.add(masses_.of(entry) * T(sums[static_cast<std::size_t>(entry)]));
    drift_ = momentum.value() / this->total_mass();
  }

  T length_;
  std::vector<std::int64_t> pace_;  // in units of velocities
  T velocity_unit_;
  T drift_{0};  // of the centre of mass, if masses differ
};

}  // namespace cradle
