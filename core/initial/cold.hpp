#pragma once
// A cold gas: particles at rest with spacing l, or displaced at random, of mass 1 or with other masses. Some move
// at the start: one that is kicked, or several with random velocities. These hot particles are in the middle of the
// others, about x = 0, or at the left end, the first one at x = 0. The result is a blast (arXiv:2010.15868), a splash
// (arXiv:2203.11097) or a row of dominoes (arXiv:2605.16125).
//
// The density may fall with the distance from the origin (arXiv:2504.03549): it is (1/l) (|x|/l)^-b, b < 1. A particle
// that would be s spacings from the origin is at x = l ((1 - b) s)^(1/(1 - b)), on the same side. These numbers of
// spacings are doubles, by definition: each scalar type starts from the same ones.
//
// Only the gaps beside hot particles are held at the start; particles at rest are taken in as the fronts reach them
// (held_range.hpp). Velocities are whole numbers (README.md) minus the velocity of their centre of mass, times a unit
// that gives them their energy.

#include "cradle/core/base/elementary.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/core/initial/velocities.hpp"

namespace cradle {

enum class HotPlace { middle, left };

// The moving particles of a cold gas: particle first + j has the velocity (pace[j] - drift) unit.
template <Real T> struct HotParticles {
  ParticleIndex first = 0;
  std::vector<std::int64_t> pace;
  T drift{0}, unit{1};

  ParticleIndex count() const { return static_cast<ParticleIndex>(pace.size()); }
  ParticleIndex end() const { return first + count(); }
  bool holds(ParticleIndex particle) const { return particle >= first && particle < end(); }
  T velocity(ParticleIndex particle) const {
    if (!holds(particle)) return T(0);
    return (T(pace[static_cast<std::size_t>(particle - first)]) - drift) * unit;
  }
};

// The index of the first hot particle.
inline ParticleIndex first_hot(HotPlace place, ParticleIndex all, ParticleIndex hot) {
  return place == HotPlace::left ? 0 : (all - hot) / 2;
}

// One particle with a velocity.
template <Real T> HotParticles<T> kicked(ParticleIndex particle, const T& velocity) {
  return {particle, {1}, T(0), velocity};
}

// Several particles with independent Gaussian velocities, of one variance for all masses, minus that of their centre of
// mass; scaled to the energy. Throws std::invalid_argument for fewer than two, or an energy not positive and finite.
template <Real T>
HotParticles<T> heated(ParticleIndex first, ParticleIndex count, const T& energy, const MassPattern<T>& masses,
                       std::uint64_t seed, std::uint64_t replica) {
  require(count >= 2, "random velocities of ", count, " particles without momentum: give it two or more, or a kick");
  require_finite(energy, "energy of the hot particles");
  require(energy > T(0), "energy of the hot particles is not positive (", energy, "): give a positive one");
  HotParticles<T> hot{first, drawn(gaussian_velocity(seed, replica), first, count), T(0), T(1)};
  CompensatedSum<T> momentum, twice;
  for (ParticleIndex particle = first; particle < first + count; ++particle)
    momentum.add(masses.of(particle) * T(hot.pace[static_cast<std::size_t>(particle - first)]));
  hot.drift = momentum.value() / masses.total(first, first + count);
  for (ParticleIndex particle = first; particle < first + count; ++particle) {
    const T v = hot.velocity(particle);
    twice.add(masses.of(particle) * v * v);
  }
  hot.unit = square_root(T((energy + energy) / twice.value()));
  return hot;
}

template <Real T> class Cold final : public OnLattice<T> {
  using OnLattice<T>::count_, OnLattice<T>::displacement_;

 public:
  // `falls`: the exponent b of the density, below 1. Throws std::invalid_argument if there are no particles, no hot
  // particles or more hot ones than particles, if the spacing or a velocity is not finite or the spacing is not
  // positive, or if particles are not apart.
  Cold(ParticleIndex count, const T& spacing, HotPlace place, HotParticles<T> hot, Displacement displacement,
       MassPattern<T> masses = {}, double falls = 0)
      : OnLattice<T>(count, T(spacing / T(displacement_unit)), std::move(displacement), std::move(masses)),
        left_(place == HotPlace::left), hot_(std::move(hot)), spacing_(spacing), falls_(falls) {
    require(hot_.count() >= 1 && hot_.first >= 0 && hot_.end() <= count, "hot particles ", hot_.first, " to ",
            hot_.end() - 1, " of ", count, ": give at least one, and no more than there are");
    require_finite(spacing, "spacing of the particles");
    require(spacing > T(0), "spacing is not positive (", spacing, "): give a positive number");
    require(falls < 1, "a density that falls with the power ", falls, " of the distance: give a number below 1");
    if (falls != 0) {
      power_ = std::make_shared<const Power<double>>(1 / (1 - falls));
      for (const ParticleIndex end : {ParticleIndex{0}, count - 1})
        require_finite(position(end), "position of particle ", end);
      if (count > 1) gap(0), gap(count - 2);
    }
    for (ParticleIndex particle = hot_.first; particle < hot_.end(); ++particle)
      require_finite(hot_.velocity(particle), "velocity of particle ", particle);
    this->add_up(hot_.first, hot_.end());
    if (hot_.count() > 1) this->momentum_ = T(0);
  }

  T velocity(ParticleIndex particle) const override { return hot_.velocity(particle); }
  T position(ParticleIndex particle) const override {
    if (power_) return exactly<T>(spacings(particle)) * spacing_;
    return place_of<T>(half_steps(particle), displacement_(particle)) * this->unit_;
  }
  T gap(ParticleIndex particle) const override { return power_ ? uneven_gap(particle) : OnLattice<T>::gap(particle); }
  T closing_speed(ParticleIndex particle) const override {
    if (!hot_.holds(particle) || !hot_.holds(particle + 1)) return velocity(particle) - velocity(particle + 1);
    const auto pace = hot_.pace.begin() + (particle - hot_.first);
    return T(pace[0] - pace[1]) * hot_.unit;
  }
  GapRange gaps_in_motion() const override {
    return {std::max<ParticleIndex>(hot_.first - 1, 0), std::min(hot_.end() - 1, count_ - 2)};
  }

 private:
  // Half spacings from the origin, in an even gas.
  ParticleIndex half_steps(ParticleIndex particle) const {
    return left_ ? 2 * particle : 2 * (particle - hot_.first) + 1 - hot_.count();
  }
  // Spacings from the origin where the density falls.
  double spacings(ParticleIndex particle) const {
    const double even = place_of<double>(half_steps(particle), displacement_(particle)) * 0x1p-28;
    const double uneven = (*power_)((1 - falls_) * (even < 0 ? -even : even));
    return even < 0 ? -uneven : uneven;
  }
  // Far out, where doubles are wide apart, particles may have the same place: that is found when they are taken in.
  T uneven_gap(ParticleIndex particle) const {
    const double from = spacings(particle), to = spacings(particle + 1);
    require(from < to, "particles ", particle, " and ", particle + 1, " have no distance (both ", from,
            " spacings from the origin, as doubles): give fewer particles, or an exponent of the density nearer to 0");
    return (exactly<T>(to) - exactly<T>(from)) * spacing_;
  }

  bool left_;
  HotParticles<T> hot_;
  T spacing_;
  double falls_;
  std::shared_ptr<const Power<double>> power_;  // null in an even gas
};

}  // namespace cradle
