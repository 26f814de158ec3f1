#pragma once
// A cold gas: bodies at rest, spacing l apart or displaced at random, of mass 1 or of masses that repeat, some of which
// move at the start: one that is kicked, or several with velocities drawn at random. The hot bodies stand in the middle
// of the others, about x = 0, or at the left end, the first one at x = 0. What they set in motion is a blast
// (arXiv:2010.15868), a splash (arXiv:2203.11097) or a row of dominoes (arXiv:2605.16125).
//
// Only the gaps beside hot bodies are held at the start; bodies at rest are taken in as the fronts reach them
// (window.hpp). Velocities are integers, less the velocity of their centre of mass, times a unit that gives them their
// energy: all scalar types start from the same state, each rounded for itself.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/bodies.hpp"
#include "cradle/core/mass_pattern.hpp"
#include "cradle/core/ring.hpp"
#include "cradle/core/rows.hpp"

namespace cradle {

enum class HotPlace { middle, left };

// The bodies of a cold gas that move: body first + j at the velocity (pace[j] - drift) unit.
template <Real T> struct HotBodies {
  BodyIndex first = 0;
  std::vector<std::int64_t> pace;
  T drift{0}, unit{1};

  BodyIndex count() const { return static_cast<BodyIndex>(pace.size()); }
  BodyIndex end() const { return first + count(); }
  bool holds(BodyIndex body) const { return body >= first && body < end(); }
  T velocity(BodyIndex body) const {
    if (!holds(body)) return T(0);
    return (T(pace[static_cast<std::size_t>(body - first)]) - drift) * unit;
  }
};

// The first of so many hot bodies among all.
inline BodyIndex first_hot(HotPlace place, BodyIndex all, BodyIndex hot) {
  return place == HotPlace::left ? 0 : (all - hot) / 2;
}

// One body with a velocity.
template <Real T> HotBodies<T> kicked(BodyIndex body, const T& velocity) { return {body, {1}, T(0), velocity}; }

// Several bodies with independent Gaussian velocities, of one variance whatever their masses, less the velocity of
// their centre of mass; scaled to the energy given. Throws std::invalid_argument for fewer than two bodies or an energy
// that is not positive and finite.
template <Real T>
HotBodies<T> heated(BodyIndex first, BodyIndex count, const T& energy, const MassPattern<T>& masses, std::uint64_t seed,
                    std::uint64_t replica) {
  using std::sqrt;
  if (count < 2)
    throw std::invalid_argument("random velocities of " + std::to_string(count) +
                                " bodies without momentum: give it two or more, or a kick");
  require_finite(energy, "energy of the hot bodies");
  if (!(energy > T(0)))
    throw std::invalid_argument("energy of the hot bodies is not positive (" + in_message(energy) +
                                "): give a positive one");
  HotBodies<T> hot{first, {}, T(0), T(1)};
  const VelocityDraw draw = gaussian_velocity(seed, replica);
  CompensatedSum<T> momentum, twice;
  for (BodyIndex body = first; body < first + count; ++body) {
    hot.pace.push_back(draw(body));
    momentum.add(masses.of(body) * T(hot.pace.back()));
  }
  hot.drift = momentum.value() / masses.total(first, first + count);
  for (BodyIndex body = first; body < first + count; ++body) {
    const T v = hot.velocity(body);
    twice.add(masses.of(body) * v * v);
  }
  hot.unit = sqrt(T((energy + energy) / twice.value()));
  return hot;
}

template <Real T> class Cold final : public Bodies<T> {
 public:
  // Throws std::invalid_argument for no bodies, more hot ones than there are or none, or a spacing or velocity that
  // is not finite or, the spacing, not positive.
  Cold(BodyIndex count, const T& spacing, HotPlace place, HotBodies<T> hot, Displacement displacement,
       MassPattern<T> masses = {})
      : count_(count), left_(place == HotPlace::left), hot_(std::move(hot)), displacement_(std::move(displacement)),
        masses_(std::move(masses)), unit_(spacing / T(displacement_unit)) {
    if (hot_.count() < 1 || hot_.first < 0 || hot_.end() > count)
      throw std::invalid_argument("hot bodies " + std::to_string(hot_.first) + " to " + std::to_string(hot_.end() - 1) +
                                  " of " + std::to_string(count) + ": give at least one, and no more than there are");
    require_finite(spacing, "spacing of the bodies");
    if (!(spacing > T(0)))
      throw std::invalid_argument("spacing is not positive (" + in_message(spacing) + "): give a positive number");
    CompensatedSum<T> twice, momentum;
    for (BodyIndex body = hot_.first; body < hot_.end(); ++body) {
      const T v = hot_.velocity(body);
      require_finite(v, "velocity of body " + std::to_string(body));
      twice.add(mass(body) * v * v);
      momentum.add(mass(body) * v);
    }
    energy_ = twice.value() / T(2);
    momentum_ = hot_.count() > 1 ? T(0) : momentum.value();
  }

  BodyIndex count() const override { return count_; }
  T mass(BodyIndex body) const override { return masses_.of(body); }
  bool identical_masses() const override { return masses_.identical(); }
  T velocity(BodyIndex body) const override { return hot_.velocity(body); }
  T position(BodyIndex body) const override {
    const BodyIndex half_steps = left_ ? 2 * body : 2 * (body - hot_.first) + 1 - hot_.count();
    return place_of<T>(half_steps, displacement_(body)) * unit_;
  }
  T gap(BodyIndex body) const override {
    return T(displacement_unit + displacement_(body + 1) - displacement_(body)) * unit_;
  }
  T closing_speed(BodyIndex body) const override {
    if (!hot_.holds(body) || !hot_.holds(body + 1)) return velocity(body) - velocity(body + 1);
    const auto pace = hot_.pace.begin() + (body - hot_.first);
    return T(pace[0] - pace[1]) * hot_.unit;
  }
  GapRange gaps_in_motion() const override {
    return {std::max<BodyIndex>(hot_.first - 1, 0), std::min(hot_.end() - 1, count_ - 2)};
  }

  T kinetic_energy() const override { return energy_; }
  T momentum() const override { return momentum_; }
  T total_mass() const override { return masses_.total(0, count_); }
  T mass_between(BodyIndex from, BodyIndex to) const override { return masses_.total(from, to); }
  T least_mass() const override { return masses_.least(); }
  T greatest_mass() const override { return masses_.greatest(); }

 private:
  BodyIndex count_;
  bool left_;
  HotBodies<T> hot_;
  Displacement displacement_;
  MassPattern<T> masses_;
  T unit_, energy_{0}, momentum_{0};
};

}  // namespace cradle
