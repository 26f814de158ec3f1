#pragma once
// What a wall (laws/wall.hpp, which has the accounts too) makes of a particle, where all numbers are enclosed.
// README.md (Walls) has the maps. The random speed of a thermal wall is a double, of the double next to the particle's
// mass, by definition and so exact.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "cradle/core/certify/enclosing.hpp"
#include "cradle/core/laws/wall.hpp"

namespace cradle {

template <Enclosing N> struct CertainAccount {
  std::uint64_t collisions = 0;
  N given{0}, momentum{0}, dissipated{0};
};
template <Enclosing N> using CertainAccounts = std::array<CertainAccount<N>, 2>;  // in the order of End

template <Enclosing N> class CertainWall {
 public:
  CertainWall(const Wall<N>& wall, End end) : wall_(wall), end_(end), share_(N(1) + wall.restitution) {}

  bool thermal() const { return wall_.temperature > 0; }
  // Of the speed x away from it.
  N away(const N& speed) const { return end_ == End::left ? speed : -speed; }

  // The particle's place, that of the wall at the same time, and their velocities; `in`: how long after that they meet.
  struct Meeting {
    N &place, &velocity;
    const N &wall_place, &wall_velocity;
    N closing, in;
  };
  // Makes the collision. False where it is open which double is next to the mass, on which a random speed depends.
  bool operator()(const Meeting& at, const N& mass, CertainAccount<N>& account) const {
    const N& w = at.closing;
    const std::optional<N> speed = speed_after(w, mass, false, account);
    if (!speed) return false;
    if (thermal()) {
      at.velocity = away(*speed) + at.wall_velocity;
      at.place = at.wall_place - away(*speed) * at.in;
    } else {
      at.place = N::combined(at.place, at.wall_place, at.place - at.wall_place, share_, share_).left;
      at.velocity = N::combined(at.velocity, at.wall_velocity, -away(w), share_, share_).left;
    }
    enter(w, *speed, mass, at.wall_velocity, false, account);
    return true;
  }

  // The speed of the next collision's particle afterwards, relative to the wall; nothing as above. `elastic`: a wall
  // that reflects acts as if it had the restitution 1.
  std::optional<N> speed_after(const N& w, const N& mass, bool elastic, const CertainAccount<N>& account) const {
    if (!thermal()) return elastic ? w : wall_.restitution * w;
    const std::optional<double> random = random_speed(mass, account.collisions);
    if (!random) return {};
    return N(*random);
  }
  // Enters that collision in the account.
  void enter(const N& w, const N& speed, const N& mass, const N& wall_velocity, bool elastic,
             CertainAccount<N>& account) const {
    const N kick = mass * away(w + speed), half = mass / N(2);
    account.collisions += 1;
    account.momentum += kick;
    account.given += kick * wall_velocity;
    if (thermal())
      account.given += half * (speed - w) * (speed + w);
    else if (!elastic)
      account.dissipated += half * (N(1) - wall_.restitution) * (N(1) + wall_.restitution) * (w * w);
  }

 private:
  std::optional<double> random_speed(const N& mass, std::uint64_t collision) const {
    constexpr double inf = std::numeric_limits<double>::infinity();
    const double near = to_double(mass), above = std::nextafter(near, inf) - near,
                 below = near - std::nextafter(near, 0);
    if (!((mass - N(near)).size() < std::min(above, below) / 2)) return {};
    return thermal_speed(wall_.seed, wall_.replica, end_, collision) * std::sqrt(wall_.temperature / near);
  }

  Wall<N> wall_;
  End end_;
  typename N::Share share_;
};

}  // namespace cradle
