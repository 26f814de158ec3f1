#pragma once
// Two rows of particles that run into each other (the paper's Riemann problem, section II): the left one with velocity
// u_l and spacing l_l = 1/n_l, the right one with u_r and l_r; a scene may have a particle of any mass between them.
// The masses of the rows are 1, or repeat by a pattern from particle 0 on (the particle between the rows takes a place
// in the pattern but not its mass). The first particles are half a spacing from the origin. Every particle of a row is
// displaced by a random multiple of 2^-28 of the spacing, so that every scalar type and both representations start from
// the same positions.

#include <cmath>
#include <functional>
#include <utility>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/initial/mass_pattern.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

template <Real T> struct Row {
  ParticleIndex count;
  T velocity, spacing;
};

template <Real T> struct CentralParticle { T mass, velocity; };

// Velocities of the rows and of the particle between them, without a velocity that they have in common.
template <Real T> struct RowSpeeds { T left, centre, right; };

// Displacement of a particle in units of 2^-28 of the spacing: particles stay in order, since its magnitude is below
// 2^27 or since it gives them other places in order (poisson.hpp).
using Displacement = std::function<std::int64_t(ParticleIndex)>;

inline constexpr std::int64_t displacement_unit = std::int64_t{1} << 28;

// The position of a displaced particle, a number of half spacings from the origin, in units of 2^-28 of the spacing. 64
// bits hold it up to 3e10 spacings; beyond, both factors are exact in any type of 53 bits, and so is the product.
template <Real T> T place_of(std::int64_t half_steps, std::int64_t displacement) {
  constexpr std::int64_t half = displacement_unit / 2, most = std::numeric_limits<std::int64_t>::max() / half - 1;
  if (-most <= half_steps && half_steps <= most) return T(half_steps * half + displacement);
  return T(half_steps) * T(half) + T(displacement);
}

// Uniform in plus/minus `perturbation` spacings, 0 <= perturbation < 1/2.
inline Displacement uniform_displacement(double perturbation, std::uint64_t seed, std::uint64_t replica) {
  require(perturbation >= 0 && perturbation < 0.5, "perturbation out of range (", perturbation,
          "): give a number from 0 to below 0.5 (in spacings)");
  const auto bound = static_cast<std::int64_t>(std::floor(perturbation * static_cast<double>(displacement_unit)));
  if (bound == 0) return [](ParticleIndex) { return std::int64_t{0}; };
  return [=](ParticleIndex particle) {
    return uniform_integer(random_bits(seed, replica, static_cast<std::uint64_t>(particle)), bound);
  };
}

// Particles about the places of a lattice, with masses of a pattern and velocities of their own.
template <Real T> class OnLattice : public Particles<T> {
 public:
  ParticleIndex count() const override { return count_; }
  T mass(ParticleIndex particle) const override { return masses_.of(particle); }
  bool identical_masses() const override { return masses_.identical(); }
  T gap(ParticleIndex particle) const override { return distance(particle, particle + 1); }
  T kinetic_energy() const override { return energy_; }
  T momentum() const override { return momentum_; }
  T total_mass() const override { return masses_.total(0, count_); }
  T mass_between(ParticleIndex from, ParticleIndex to) const override { return masses_.total(from, to); }
  T least_mass() const override { return masses_.least(); }
  T greatest_mass() const override { return masses_.greatest(); }

 protected:
  // `unit`: 2^-28 of the spacing.
  OnLattice(ParticleIndex count, T unit, Displacement displacement, MassPattern<T> masses)
      : count_(count), unit_(std::move(unit)), displacement_(std::move(displacement)), masses_(std::move(masses)) {}

  // From a particle to the next one.
  T distance(ParticleIndex particle, ParticleIndex next) const {
    return T(displacement_unit + displacement_(next) - displacement_(particle)) * unit_;
  }
  // In units of 2^-28 of the spacing, from the end of a lattice that begins half a spacing before its first particle.
  std::int64_t place_from_end(ParticleIndex particle) const {
    return (2 * particle + 1) * (displacement_unit / 2) + displacement_(particle);
  }
  // Sums energy and momentum over particles [from, to); the others are at rest.
  void add_up(ParticleIndex from, ParticleIndex to) {
    CompensatedSum<T> twice, momentum;
    for (ParticleIndex particle = from; particle < to; ++particle) {
      const T v = this->velocity(particle), m = mass(particle);
      twice.add(m * v * v);
      momentum.add(m * v);
    }
    energy_ = twice.value() / T(2);
    momentum_ = momentum.value();
  }

  ParticleIndex count_;
  T unit_;
  Displacement displacement_;
  MassPattern<T> masses_;
  T energy_{0}, momentum_{0};
};

template <Real T> class Rows final : public Particles<T> {
 public:
  // Throws std::invalid_argument for rows that are empty or do not approach each other, spacings or masses that are not
  // positive, a central particle that no row reaches, and numbers that are not finite. `differences`: of nearly equal
  // velocities, from one of them, if they are known more precisely.
  Rows(Row<T> left, Row<T> right, std::optional<CentralParticle<T>> centre, Displacement displacement,
       MassPattern<T> masses = {}, const std::optional<RowSpeeds<T>>& differences = {})
      : left_(std::move(left)), right_(std::move(right)), centre_(std::move(centre)), drifts_(differences.has_value()),
        own_(drifts_ ? *differences : given()), displacement_(std::move(displacement)), masses_(std::move(masses)),
        left_unit_(left_.spacing / T(displacement_unit)), right_unit_(right_.spacing / T(displacement_unit)) {
    for (const auto& [row, name] : {std::pair{&left_, "left row"}, {&right_, "right row"}}) {
      require_finite(row->velocity, "velocity of the ", name);
      require_finite(row->spacing, "spacing of the ", name);
      require(row->count >= 1, "a row without particles (the ", name, " has ", row->count, "): give each at least one");
      require(row->spacing > T(0), "a row's spacing is not positive (", row->spacing, ", the ", name,
              "): give a positive number");
    }
    require(own_.left > own_.right, "the rows do not approach each other (left ", left_.velocity, ", right ",
            right_.velocity, "): make the left one faster");
    if (drifts_) own_mean_ = total_momentum(own_) / total_mass();
    if (!centre_) return;
    require_finite(centre_->mass, "mass of the central particle");
    require_finite(centre_->velocity, "velocity of the central particle");
    require(!(own_.centre > own_.left) && !(own_.centre < own_.right), "the central particle runs away from a row (",
            centre_->velocity, "): give it a speed between those of the rows");
    require(centre_->mass > T(0), "central mass is not positive (", centre_->mass, "): give a positive one");
  }

  ParticleIndex count() const override { return left_.count + right_.count + (centre_ ? 1 : 0); }
  T mass(ParticleIndex particle) const override { return is_centre(particle) ? centre_->mass : masses_.of(particle); }
  bool identical_masses() const override { return masses_.identical() && (!centre_ || centre_->mass == masses_.of(0)); }

  T velocity(ParticleIndex particle) const override {
    return particle < left_.count ? left_.velocity : is_centre(particle) ? centre_->velocity : right_.velocity;
  }
  T common_velocity() const override { return drifts_ ? T(left_.velocity + (own_mean_ - own_.left)) : T(0); }
  T relative_velocity(ParticleIndex particle, const T& of_centre) const override {
    return drifts_ ? T(own(particle) - own_mean_) : Particles<T>::relative_velocity(particle, of_centre);
  }

  T position(ParticleIndex particle) const override {
    if (is_centre(particle)) return T(0);
    return place_of<T>(half_steps(particle), displacement_(particle)) *
           (particle < left_.count ? left_unit_ : right_unit_);
  }

  T gap(ParticleIndex particle) const override {
    const bool from_left = particle < left_.count, to_left = particle + 1 < left_.count;
    const bool in_a_row = from_left == to_left && !is_centre(particle);
    if (in_a_row || (left_.spacing == right_.spacing && !centre_)) {
      const std::int64_t units = displacement_unit + displacement_(particle + 1) - displacement_(particle);
      return T(units) * (from_left ? left_unit_ : right_unit_);
    }
    // The distances of both particles from the origin are positive: their sum does not cancel.
    return position(particle + 1) - position(particle);
  }

  T closing_speed(ParticleIndex particle) const override { return own(particle) - own(particle + 1); }

  GapRange gaps_in_motion() const override { return {left_.count - 1, left_.count - (centre_ ? 0 : 1)}; }

  T kinetic_energy() const override { return energy(given()); }
  T energy_to_lose() const override {
    if (!drifts_) return Particles<T>::energy_to_lose();
    return energy({own_.left - own_mean_, own_.centre - own_mean_, own_.right - own_mean_});
  }
  T momentum() const override { return total_momentum(given()); }
  T total_mass() const override {
    const T rows = left_mass() + right_mass();
    return centre_ ? T(rows + centre_->mass) : rows;
  }
  T mass_between(ParticleIndex from, ParticleIndex to) const override {
    const bool centre = centre_ && from <= left_.count && left_.count < to;
    return masses_.total(from, to) + (centre ? T(centre_->mass - masses_.of(left_.count)) : T(0));
  }
  T least_mass() const override {
    const T rows = masses_.least();
    return centre_ && centre_->mass < rows ? centre_->mass : rows;
  }
  T greatest_mass() const override {
    const T rows = masses_.greatest();
    return centre_ && rows < centre_->mass ? centre_->mass : rows;
  }

 private:
  T left_mass() const { return masses_.total(0, left_.count); }
  T right_mass() const { return masses_.total(count() - right_.count, count()); }
  RowSpeeds<T> given() const { return {left_.velocity, centre_ ? centre_->velocity : T(0), right_.velocity}; }
  const T& own(ParticleIndex particle) const {
    return particle < left_.count ? own_.left : is_centre(particle) ? own_.centre : own_.right;
  }
  T energy(const RowSpeeds<T>& v) const {
    const T rows = left_mass() * v.left * v.left + right_mass() * v.right * v.right;
    return (centre_ ? T(rows + centre_->mass * v.centre * v.centre) : rows) / T(2);
  }
  T total_momentum(const RowSpeeds<T>& v) const {
    const T rows = left_mass() * v.left + right_mass() * v.right;
    return centre_ ? T(rows + centre_->mass * v.centre) : rows;
  }
  bool is_centre(ParticleIndex particle) const { return centre_ && particle == left_.count; }

  // Half spacings from the origin.
  ParticleIndex half_steps(ParticleIndex particle) const {
    return particle < left_.count ? 2 * (particle - left_.count) + 1
                                  : 2 * (particle - left_.count - (centre_ ? 1 : 0)) + 1;
  }

  Row<T> left_, right_;
  std::optional<CentralParticle<T>> centre_;
  bool drifts_;
  RowSpeeds<T> own_;  // without a common velocity, if one has been left out
  T own_mean_{0};     // of the centre of mass
  Displacement displacement_;
  MassPattern<T> masses_;
  T left_unit_, right_unit_;
};

// The paper's symmetric shock: `particles` particles, half of them in each row, with velocities plus and minus `speed`.
// Throws std::invalid_argument also for an odd number of them.
template <Real T>
Rows<T> symmetric_rows(ParticleIndex particles, const T& speed, const T& spacing, Displacement displacement,
                       MassPattern<T> masses = {}) {
  require(particles % 2 == 0, "an odd number of particles for two equal rows (", particles,
          "): give an even one, or two rows of their own");
  return {{particles / 2, speed, spacing},
          {particles / 2, T(-speed), spacing},
          std::nullopt,
          std::move(displacement),
          std::move(masses)};
}

}  // namespace cradle
