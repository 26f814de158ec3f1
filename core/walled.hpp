#pragma once
// Bodies on a line with walls at one end or both (wall.hpp).

#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "cradle/core/bodies.hpp"

namespace cradle {

template <Real T> class Walled final : public Bodies<T> {
 public:
  // Throws std::invalid_argument for bodies on a ring, walls that are not outside the bodies, and numbers out of range.
  Walled(std::shared_ptr<const Bodies<T>> bodies, std::optional<Wall<T>> left, std::optional<Wall<T>> right)
      : bodies_(std::move(bodies)), left_(std::move(left)), right_(std::move(right)) {
    if (bodies_->on_ring())
      throw std::invalid_argument("walls on a ring (circumference " + in_message(bodies_->circumference()) +
                                  "): leave them out, or give bodies on a line");
    if (left_) require_wall(*left_, "left"), require_outside(gap(-1), "left", left_->position, 0);
    if (right_)
      require_wall(*right_, "right"), require_outside(gap(count() - 1), "right", right_->position, count() - 1);
  }

  BodyIndex count() const override { return bodies_->count(); }
  T position(BodyIndex body) const override { return is_wall(body) ? at(body).position : bodies_->position(body); }
  T velocity(BodyIndex body) const override { return is_wall(body) ? at(body).speed : bodies_->velocity(body); }
  T mass(BodyIndex body) const override { return bodies_->mass(is_wall(body) ? 0 : body); }
  bool identical_masses() const override { return bodies_->identical_masses(); }
  const Wall<T>* wall(End end) const override {
    const auto& wall = end == End::left ? left_ : right_;
    return wall ? &*wall : nullptr;
  }

  T gap(BodyIndex body) const override {
    return is_wall(body) || is_wall(body + 1) ? T(position(body + 1) - position(body)) : bodies_->gap(body);
  }
  T closing_speed(BodyIndex body) const override {
    return is_wall(body) || is_wall(body + 1) ? T(velocity(body) - velocity(body + 1)) : bodies_->closing_speed(body);
  }
  GapRange gaps_in_motion() const override {
    const GapRange inner = bodies_->gaps_in_motion(), all = this->gaps();
    return {left_ ? all.first : inner.first, right_ ? all.last : inner.last};
  }

  T kinetic_energy() const override { return bodies_->kinetic_energy(); }
  T momentum() const override { return bodies_->momentum(); }
  T conserved_momentum() const override { return bodies_->conserved_momentum(); }
  T total_mass() const override { return bodies_->total_mass(); }
  T mass_between(BodyIndex from, BodyIndex to) const override { return bodies_->mass_between(from, to); }
  T least_mass() const override { return bodies_->least_mass(); }
  T greatest_mass() const override { return bodies_->greatest_mass(); }
  T rounded_place(BodyIndex body) const override {
    return is_wall(body) ? at(body).position : bodies_->rounded_place(body);
  }
  // Walls give energy: a ledger for a million times as much as comes of them at once loses 20 of its spare bits.
  T energy_to_lose() const override {
    T twice_per_mass(0);
    for (const auto* wall : {&left_, &right_})
      if (*wall)
        twice_per_mass += (*wall)->speed * (*wall)->speed + exactly<T>((*wall)->temperature / to_double(least_mass()));
    return T(1 << 20) * (kinetic_energy() + total_mass() * twice_per_mass);
  }

 private:
  bool is_wall(BodyIndex body) const { return body < 0 || body >= count(); }
  const Wall<T>& at(BodyIndex body) const { return body < 0 ? *left_ : *right_; }

  static void require_wall(const Wall<T>& wall, const std::string& which) {
    require_finite(wall.position, "position of the " + which + " wall");
    require_finite(wall.speed, "speed of the " + which + " wall");
    if (is_negative(wall.restitution) || T(1) < wall.restitution)
      throw std::invalid_argument("restitution of the " + which + " wall is out of range (" +
                                  in_message(wall.restitution) + "): give a number from 0 to 1");
    if (!(wall.temperature >= 0 && wall.temperature <= std::numeric_limits<double>::max()))
      throw std::invalid_argument("temperature of the " + which + " wall is negative or not finite (" +
                                  std::to_string(wall.temperature) +
                                  "): give a positive one, or 0 for a reflecting wall");
  }
  void require_outside(const T& gap, const std::string& which, const T& wall, BodyIndex body) const {
    if (is_positive(gap)) return;
    throw std::invalid_argument("the " + which +
                                " wall is not outside the bodies, which would have met it before the start (wall at " +
                                in_message(wall) + ", body " + std::to_string(body) + " at " +
                                in_message(bodies_->position(body)) + "): move it outwards");
  }

  std::shared_ptr<const Bodies<T>> bodies_;
  std::optional<Wall<T>> left_, right_;
};

}  // namespace cradle
