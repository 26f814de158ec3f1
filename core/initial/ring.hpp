#pragma once
// Free cooling: particles on a ring (a periodic line), of mass 1 or with other masses, at equal distances or
// displaced at random, with independent velocities of a given variance and zero total momentum. Velocities and
// displacements are whole numbers times a unit (README.md).
//
// Zero momentum: for identical masses the mean is subtracted from the integers, and its remainder, less than one per
// particle, from the first particles. For masses that differ the velocity of the centre of mass, sum m_b n_b / sum m_b
// of the integers n_b, is a fraction: it is subtracted from velocities in the working precision; closing speeds do not
// contain it.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/initial/mass_pattern.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/initial/rows.hpp"

namespace cradle {

// Velocity of a particle in units of 2^-28 standard deviations.
using VelocityDraw = std::function<std::int64_t(ParticleIndex)>;

namespace detail {

// Random bits that are independent of those of displacements, which use the indices 0, 1, ...
inline std::uint64_t velocity_bits(std::uint64_t seed, std::uint64_t replica, ParticleIndex particle,
                                   std::uint64_t attempt) {
  return random_bits(seed, replica, static_cast<std::uint64_t>(particle) | (attempt + 1) << 56);
}

}  // namespace detail

// Gaussian velocities, by Marsaglia's polar method (SIAM Rev. 6, 260, 1964, doi 10.1137/1006063).
inline VelocityDraw gaussian_velocity(std::uint64_t seed, std::uint64_t replica) {
  return [=](ParticleIndex particle) {
    for (std::uint64_t attempt = 0;; ++attempt) {
      const std::uint64_t bits = detail::velocity_bits(seed, replica, particle, attempt);
      const double u = (static_cast<double>(bits >> 32) + 0.5) * 0x1p-31 - 1;
      const double v = (static_cast<double>(bits & 0xFFFFFFFF) + 0.5) * 0x1p-31 - 1;
      const double square = u * u + v * v;
      if (square >= 1) continue;
      const double normal = u * std::sqrt(-2 * detail::portable_log(square) / square);
      return static_cast<std::int64_t>(std::floor(normal * static_cast<double>(displacement_unit) + 0.5));
    }
  };
}

// Uniform velocities between plus and minus sqrt(3) standard deviations.
inline VelocityDraw uniform_velocity(std::uint64_t seed, std::uint64_t replica) {
  constexpr std::int64_t bound = 464943848;  // sqrt(3) 2^28
  return
      [=](ParticleIndex particle) { return uniform_integer(detail::velocity_bits(seed, replica, particle, 0), bound); };
}

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
  // Draws every velocity once.
  Ring(ParticleIndex count, T length, T deviation, VelocityDraw velocity, Displacement displacement,
       MassPattern<T> masses = {})
      : OnLattice<T>(count, T(length / (T(count) * T(displacement_unit))), std::move(displacement), std::move(masses)),
        length_(std::move(length)), velocity_(std::move(velocity)), velocity_unit_(deviation / T(displacement_unit)) {
    detail::require_gas("ring", count, length_, deviation);
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
  std::int64_t pace(ParticleIndex particle) const {
    return velocity_(particle) - shift_ - (particle < shifted_more_ ? 1 : 0);
  }

  void take_off_mean() {
    std::int64_t sum = 0;
    for (ParticleIndex particle = 0; particle < count_; ++particle) sum += velocity_(particle);
    shift_ = sum / count_ - (sum % count_ < 0 ? 1 : 0);
    shifted_more_ = sum - shift_ * count_;
  }
  // The sums of integers, one for each entry of the pattern, are exact.
  void take_off_drift() {
    std::vector<std::int64_t> sums(static_cast<std::size_t>(masses_.period()), 0);
    for (ParticleIndex particle = 0; particle < count_; ++particle)
      sums[static_cast<std::size_t>(particle % masses_.period())] += velocity_(particle);
    CompensatedSum<T> momentum;
    for (ParticleIndex entry = 0; entry < masses_.period(); ++entry)
      momentum.add(masses_.of(entry) * T(sums[static_cast<std::size_t>(entry)]));
    drift_ = momentum.value() / this->total_mass();
  }

  T length_;
  VelocityDraw velocity_;
  T velocity_unit_;
  std::int64_t shift_ = 0, shifted_more_ = 0;
  T drift_{0};  // of the centre of mass, in units of velocities
};

}  // namespace cradle
