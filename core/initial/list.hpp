#pragma once
// Particles given one by one, on a line or a ring: positions, velocities and, where they differ, masses. Gaps and
// closing speeds are differences of these numbers, unless they are given too: a difference of rounded positions may
// have no correct digit.

#include <algorithm>
#include <utility>
#include <vector>

#include "cradle/core/initial/particles.hpp"

namespace cradle {

// Gaps and closing speeds of all neighbours, on a ring also those of the last particle and the first one. `from_first`:
// velocities less that of the first particle, which matter if all are `nearly_equal`.
template <Real T> struct Differences { std::vector<T> gaps, closing_speeds, from_first; };

// Whether velocities are nearer to each other than to 0: then what is left of them beside their mean has fewer digits.
template <Real T> bool nearly_equal(const std::vector<T>& velocities) {
  if (velocities.empty()) return false;
  const auto [least, greatest] = std::minmax_element(velocities.begin(), velocities.end());
  return T(*greatest - *least) < std::min(magnitude(*least), magnitude(*greatest));
}

template <Real T> class List final : public Particles<T> {
 public:
  // One velocity per position; as many masses, or none if all are 1. With a circumference the particles are on a ring.
  // `momentum`, `differences`: if they are known more precisely than as sums and differences; then positions may be
  // equal in the working precision. A gap is 0 only if its particles do not approach. Throws std::invalid_argument if
  // lengths differ, a number is not finite, particles are not in order or span the ring, or a mass is not positive.
  List(std::vector<T> positions, std::vector<T> velocities, std::vector<T> masses = {}, T circumference = T(0),
       std::optional<T> momentum = {}, Differences<T> differences = {})
      : x_(std::move(positions)), v_(std::move(velocities)), m_(std::move(masses)),
        differences_(std::move(differences)), circumference_(std::move(circumference)) {
    require(!x_.empty(), "no particles: list at least one");
    require(v_.size() == x_.size() && (m_.empty() || m_.size() == x_.size()), "lists of different lengths (", x_.size(),
            " positions, ", v_.size(), " velocities, ", m_.size(),
            " masses): give one velocity and one mass per position");
    for (const auto& [values, name] : {std::pair{&x_, "position"}, {&v_, "velocity"}, {&m_, "mass"}})
      for (std::size_t i = 0; i < values->size(); ++i) require_finite((*values)[i], name, " of particle ", i);
    require_finite(circumference_, "circumference");
    require(!is_negative(circumference_), "circumference is negative (", circumference_,
            "): give a positive one for a ring, 0 for a line");
    require_order();
    for (std::size_t i = 0; i < m_.size(); ++i) {
      require(m_[i] > T(0), "particle ", i, " has no positive mass (", m_[i], "): give it one");
      identical_ = identical_ && m_[i] == m_[0];
    }
    CompensatedSum<T> total, sum;
    for (ParticleIndex particle = 0; particle < count(); ++particle)
      total.add(mass(particle)), sum.add(mass(particle) * velocity(particle));
    total_mass_ = total.value(), momentum_ = sum.value();
    conserved_ = momentum ? *momentum : momentum_;
    if (nearly_equal(v_)) leave_out_common_velocity();
  }

  ParticleIndex count() const override { return static_cast<ParticleIndex>(x_.size()); }
  T position(ParticleIndex particle) const override { return x_[at(particle)]; }
  T velocity(ParticleIndex particle) const override { return v_[at(particle)]; }
  T mass(ParticleIndex particle) const override { return m_.empty() ? T(1) : m_[at(particle)]; }
  bool identical_masses() const override { return identical_; }
  T gap(ParticleIndex particle) const override {
    if (!differences_.gaps.empty()) return differences_.gaps[at(particle)];
    return is_last(particle) ? T(x_[0] + (circumference_ - x_[at(particle)]))
                             : T(x_[at(particle) + 1] - x_[at(particle)]);
  }
  T closing_speed(ParticleIndex particle) const override {
    if (!differences_.closing_speeds.empty()) return differences_.closing_speeds[at(particle)];
    return v_[at(particle)] - v_[is_last(particle) ? 0 : at(particle) + 1];
  }
  T common_velocity() const override { return common_; }
  T relative_velocity(ParticleIndex particle, const T& of_centre) const override {
    return relative_.empty() ? Particles<T>::relative_velocity(particle, of_centre) : relative_[at(particle)];
  }
  T circumference() const override { return circumference_; }
  GapRange gaps_in_motion() const override { return {0, count() - (this->on_ring() ? 1 : 2)}; }

  T kinetic_energy() const override { return energy_of(v_); }
  T energy_to_lose() const override {
    return relative_.empty() ? Particles<T>::energy_to_lose() : energy_of(relative_);
  }
  T momentum() const override { return momentum_; }
  T conserved_momentum() const override { return conserved_; }
  T total_mass() const override { return total_mass_; }
  T least_mass() const override { return m_.empty() ? T(1) : *std::min_element(m_.begin(), m_.end()); }
  T greatest_mass() const override { return m_.empty() ? T(1) : *std::max_element(m_.begin(), m_.end()); }
  T rounded_place(ParticleIndex particle) const override {
    return differences_.gaps.empty() ? position(particle) : T(0);
  }

 private:
  bool is_last(ParticleIndex particle) const { return particle + 1 == count(); }
  static std::size_t at(ParticleIndex particle) { return static_cast<std::size_t>(particle); }

  void require_order() const {
    const std::size_t gaps = x_.size() - (this->on_ring() ? 0 : 1);
    const auto& given = differences_.gaps;
    const auto& speeds = differences_.closing_speeds;
    require((given.empty() || given.size() == gaps) && (speeds.empty() || speeds.size() == gaps),
            "not one gap and closing speed for each pair of neighbours (", given.size(), " and ", speeds.size(),
            " for ", gaps, "): give all of them, or none");
    for (ParticleIndex i = 0; i + 1 < count(); ++i) {
      if (given.empty() ? x_[at(i)] < x_[at(i + 1)] : is_positive(given[at(i)])) continue;
      const bool touch = !given.empty() && !is_negative(given[at(i)]);
      require(touch && !is_positive(closing_speed(i)), "particles ", i, " and ", i + 1,
              touch ? " touch and approach" : " are not in order in the working precision", " (at ", x_[at(i)], " and ",
              x_[at(i + 1)],
              touch ? "): give them the velocities that they have after this collision, or a gap, 1e-300 for instance"
                    : "): sort them by position, give their gaps, or use more digits");
    }
    const auto apart = [&](const T& gap) {
      return is_positive(gap) || (gap == T(0) && !is_positive(closing_speed(count() - 1)));
    };
    require(!this->on_ring() || (given.empty() ? x_.back() - x_.front() < circumference_ : apart(given.back())),
            "the particles do not fit on the ring (from ", x_.front(), " to ", x_.back(), ", circumference ",
            circumference_, "): give it a larger circumference");
  }

  T energy_of(const std::vector<T>& velocities) const {
    CompensatedSum<T> twice;
    for (ParticleIndex particle = 0; particle < count(); ++particle)
      twice.add(mass(particle) * velocities[at(particle)] * velocities[at(particle)]);
    return twice.value() / T(2);
  }
  void leave_out_common_velocity() {
    relative_ = std::move(differences_.from_first);
    if (relative_.empty())
      for (const T& v : v_) relative_.push_back(v - v_.front());
    CompensatedSum<T> momentum;
    for (ParticleIndex particle = 0; particle < count(); ++particle)
      momentum.add(mass(particle) * relative_[at(particle)]);
    const T of_centre = momentum.value() / total_mass_;
    for (T& u : relative_) u -= of_centre;
    common_ = v_.front() + of_centre;
  }

  std::vector<T> x_, v_, m_;
  std::vector<T> relative_;  // velocities in the frame of the centre of mass, if they are nearly equal
  Differences<T> differences_;
  T circumference_, total_mass_{0}, momentum_{0}, conserved_{0}, common_{0};
  bool identical_ = true;
};

}  // namespace cradle
