#pragma once
// Gases: particles of mass 1 or with other masses, at equal distances, displaced at random or at random places, with
// independent velocities of a given variance. Velocities and displacements are whole numbers times a unit that every
// scalar type rounds (README.md).

#include "cradle/core/initial/rows.hpp"
#include "cradle/core/initial/velocities.hpp"

namespace cradle {

// What is the same on a ring and between walls.
template <Real T> class GasOnLength : public OnLattice<T> {
 protected:
  // `deviation`: standard deviation of the velocities. Throws std::invalid_argument for no particles, 2^31 or more of
  // them, or a length or deviation that is not positive and finite; `name`: of which kind the gas is.
  GasOnLength(const std::string& name, ParticleIndex count, const T& length, const T& deviation,
              const VelocityDraw& draw, Displacement displacement, MassPattern<T> masses)
      : OnLattice<T>(count, T(length / (T(count) * T(displacement_unit))), std::move(displacement), std::move(masses)),
        velocity_unit_(deviation / T(displacement_unit)) {
    require_countable(count, "a " + name);
    require_finite(length, "length of the ", name);
    require_finite(deviation, "standard deviation of the velocities");
    require(length > T(0) && deviation > T(0), "length or variance of the ", name, " is not positive (length ", length,
            ", standard deviation ", deviation, "): give positive numbers");
    pace_ = drawn(draw, 0, count);
  }
  std::int64_t pace(ParticleIndex particle) const { return pace_[static_cast<std::size_t>(particle)]; }
  T closing_between(ParticleIndex left, ParticleIndex right) const {
    return T(pace(left) - pace(right)) * velocity_unit_;
  }

  std::vector<std::int64_t> pace_;  // in units of velocities
  T velocity_unit_;
};

// On a piece of a line, which two walls close (walled.hpp).
template <Real T> class Gas final : public GasOnLength<T> {
  using GasOnLength<T>::displacement_, GasOnLength<T>::unit_;

 public:
  // From `left` on over `length`. No mean velocity is taken off, since walls do not conserve momentum.
  Gas(ParticleIndex count, T left, T length, T deviation, const VelocityDraw& draw, Displacement displacement,
      MassPattern<T> masses = {})
      : GasOnLength<T>("gas", count, length, deviation, draw, std::move(displacement), std::move(masses)),
        left_(std::move(left)) {
    require_finite(left_, "left end of the gas");
    this->add_up(0, count);
  }

  T velocity(ParticleIndex particle) const override { return T(this->pace(particle)) * this->velocity_unit_; }
  T position(ParticleIndex particle) const override { return left_ + T(this->place_from_end(particle)) * unit_; }
  // Between the particle at an end and that end of the gas.
  T gap_to(End end) const {
    const std::int64_t half = displacement_unit / 2;
    return T(end == End::left ? half + displacement_(0) : half - displacement_(this->count_ - 1)) * unit_;
  }
  T closing_speed(ParticleIndex particle) const override { return this->closing_between(particle, particle + 1); }

 private:
  T left_;
};

// Free cooling: on a ring (a periodic line), with zero total momentum. For identical masses the mean is subtracted from
// the integers, and its remainder, less than one per particle, from the first particles. For masses that differ the
// velocity of the centre of mass, sum m_b n_b / sum m_b of the integers n_b, is a fraction: it is subtracted in the
// working precision; closing speeds do not contain it.
template <Real T> class Ring final : public GasOnLength<T> {
  using GasOnLength<T>::count_, GasOnLength<T>::masses_, GasOnLength<T>::pace, GasOnLength<T>::pace_;

 public:
  // Throws std::invalid_argument also for a pattern of masses that does not divide the ring.
  Ring(ParticleIndex count, T length, T deviation, const VelocityDraw& draw, Displacement displacement,
       MassPattern<T> masses = {})
      : GasOnLength<T>("ring", count, length, deviation, draw, std::move(displacement), std::move(masses)),
        length_(std::move(length)) {
    require(count % masses_.period() == 0, "a pattern of ", masses_.period(), " masses does not divide a ring of ",
            count, " particles: give a multiple of it");
    if (masses_.identical())
      take_off_mean();
    else
      take_off_drift();
    this->add_up(0, count);
    this->momentum_ = T(0);
  }

  T circumference() const override { return length_; }
  T velocity(ParticleIndex particle) const override {
    return (masses_.identical() ? T(pace(particle)) : T(T(pace(particle)) - drift_)) * this->velocity_unit_;
  }
  T position(ParticleIndex particle) const override { return T(this->place_from_end(particle)) * this->unit_; }
  T gap(ParticleIndex particle) const override { return this->distance(particle, next(particle)); }
  T closing_speed(ParticleIndex particle) const override { return this->closing_between(particle, next(particle)); }
  GapRange gaps_in_motion() const override { return {0, count_ - 1}; }

 private:
  ParticleIndex next(ParticleIndex particle) const { return particle + 1 < count_ ? particle + 1 : 0; }

  void take_off_mean() {
    std::int64_t sum = 0;
    for (const std::int64_t each : pace_) sum += each;
    const std::int64_t mean = sum / count_ - (sum % count_ < 0 ? 1 : 0);
    std::int64_t more = sum - mean * count_;  // so many particles lose one more
    for (std::int64_t& each : pace_) each -= mean + (more-- > 0 ? 1 : 0);
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
  T drift_{0};  // of the centre of mass, if masses differ
};

}  // namespace cradle
