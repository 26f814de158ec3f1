#pragma once
// Particles given one by one, on a line or a ring: positions, velocities and, where they differ, masses.

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/initial/particles.hpp"

namespace cradle {

template <Real T> class List final : public Particles<T> {
 public:
  // One velocity per position; as many masses, or none if all are 1. With a circumference the particles are on a ring.
  // `momentum`: if it is known more precisely than as a sum. Throws std::invalid_argument if lengths differ, a number
  // is not finite, positions do not increase in the working precision or span the ring, or a mass is not positive.
  List(std::vector<T> positions, std::vector<T> velocities, std::vector<T> masses = {}, T circumference = T(0),
       std::optional<T> momentum = {})
      : x_(std::move(positions)), v_(std::move(velocities)), m_(std::move(masses)),
        circumference_(std::move(circumference)) {
    if (x_.empty()) throw std::invalid_argument("no particles: list at least one");
    if (v_.size() != x_.size() || (!m_.empty() && m_.size() != x_.size()))
      throw std::invalid_argument("lists of different lengths (" + std::to_string(x_.size()) + " positions, " +
                                  std::to_string(v_.size()) + " velocities, " + std::to_string(m_.size()) +
                                  " masses): give one velocity and one mass per position");
    for (const auto& [values, name] : {std::pair{&x_, "position"}, {&v_, "velocity"}, {&m_, "mass"}})
      for (std::size_t i = 0; i < values->size(); ++i)
        if (!is_finite((*values)[i]))
          require_finite((*values)[i], std::string(name) + " of particle " + std::to_string(i));
    require_finite(circumference_, "circumference");
    if (is_negative(circumference_))
      throw std::invalid_argument("circumference is negative (" + in_message(circumference_) +
                                  "): give a positive one for a ring, 0 for a line");
    for (std::size_t i = 0; i + 1 < x_.size(); ++i)
      if (!(x_[i] < x_[i + 1]))
        throw std::invalid_argument("particles " + std::to_string(i) + " and " + std::to_string(i + 1) +
                                    " are not in order in the working precision (at " + in_message(x_[i]) + " and " +
                                    in_message(x_[i + 1]) + "): sort them by position, or use more digits");
    for (std::size_t i = 0; i < m_.size(); ++i) {
      if (!(m_[i] > T(0)))
        throw std::invalid_argument("particle " + std::to_string(i) + " has no positive mass (" + in_message(m_[i]) +
                                    "): give it one");
      identical_ = identical_ && m_[i] == m_[0];
    }
    CompensatedSum<T> total, sum;
    for (ParticleIndex particle = 0; particle < count(); ++particle)
      total.add(mass(particle)), sum.add(mass(particle) * velocity(particle));
    total_mass_ = total.value(), momentum_ = sum.value();
    conserved_ = momentum ? *momentum : momentum_;
    if (this->on_ring() && !(x_.back() - x_.front() < circumference_))
      throw std::invalid_argument("the particles do not fit on the ring (from " + in_message(x_.front()) + " to " +
                                  in_message(x_.back()) + ", circumference " + in_message(circumference_) +
                                  "): give it a larger circumference");
  }

  ParticleIndex count() const override { return static_cast<ParticleIndex>(x_.size()); }
  T position(ParticleIndex particle) const override { return x_[at(particle)]; }
  T velocity(ParticleIndex particle) const override { return v_[at(particle)]; }
  T mass(ParticleIndex particle) const override { return m_.empty() ? T(1) : m_[at(particle)]; }
  bool identical_masses() const override { return identical_; }
  T gap(ParticleIndex particle) const override {
    return is_last(particle) ? T(x_[0] + (circumference_ - x_[at(particle)]))
                             : T(x_[at(particle) + 1] - x_[at(particle)]);
  }
  T closing_speed(ParticleIndex particle) const override {
    return v_[at(particle)] - v_[is_last(particle) ? 0 : at(particle) + 1];
  }
  T circumference() const override { return circumference_; }
  GapRange gaps_in_motion() const override { return {0, count() - (this->on_ring() ? 1 : 2)}; }

  T kinetic_energy() const override {
    CompensatedSum<T> twice;
    for (ParticleIndex particle = 0; particle < count(); ++particle)
      twice.add(mass(particle) * velocity(particle) * velocity(particle));
    return twice.value() / T(2);
  }
  T momentum() const override { return momentum_; }
  T conserved_momentum() const override { return conserved_; }
  T total_mass() const override { return total_mass_; }
  T least_mass() const override { return m_.empty() ? T(1) : *std::min_element(m_.begin(), m_.end()); }
  T greatest_mass() const override { return m_.empty() ? T(1) : *std::max_element(m_.begin(), m_.end()); }
  T rounded_place(ParticleIndex particle) const override { return position(particle); }

 private:
  bool is_last(ParticleIndex particle) const { return particle + 1 == count(); }
  static std::size_t at(ParticleIndex particle) { return static_cast<std::size_t>(particle); }

  std::vector<T> x_, v_, m_;
  T circumference_, total_mass_{0}, momentum_{0}, conserved_{0};
  bool identical_ = true;
};

}  // namespace cradle
