#pragma once
// A particle and a wall (laws/wall.hpp, which has the accounts too), where all numbers are enclosed: what the wall
// makes of the particle, and when they meet where it falls. README.md (Walls) has the maps. The random speed of a
// thermal wall is a double, of the double next to the particle's mass, by definition and so exact.

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

// sqrt(x), where x > 0 is certain. With the root m of its middle |sqrt(y) - m| = |y - x|/(sqrt(y) + m), and sqrt(y) is
// at least m (1 - q) if y is at least x (1 - q): this is half as wide as what a ball's own root allows for.
template <Enclosing N> N narrow_root(const N& x) {
  const N root = sqrt(N(x.middle(), 0));
  const auto share = x.radius() / N(x.middle(), 0).least_size();
  if (!(share < 1)) return sqrt(x);
  constexpr double of_its_rounding = 1 + 0x1p-40;
  return N::widened(root, x.radius() / (root.least_size() * (2 - share)) * of_its_rounding);
}

// A wall and a particle that falls, with the gap g, the closing speed w and the pull p, the rate at which w grows,
// counted from any time,
//
//   g(t) = g - w t - p t^2/2,   w(t) = w + p t,   w(t)^2 + 2 p g(t) = w^2 + 2 p g = D.
//
// The particle is at the wall, and closes, at the speed s = sqrt(D) alone, and that once:
//
//   t = (s - w)/p = 2 g/(w + s),   of which the one is taken in which nothing cancels.
//
// At a floor, p > 0, the other root is before g; at a ceiling, p < 0, it comes after this one, where the gap opens.
//
// To a ceiling the gap is convex: README.md (Gravity) has the three cases in which it stays open. There is no other
// way: D >= 0 with w > 0 >= w(t) is a collision that is missing, or a touch.
template <Enclosing N> struct CertainApproach {
  N gap, closing, pull;

  N fall() const { return (pull + pull) * gap; }
  N square() const { return closing * closing + fall(); }
  N closing_after(const N& time) const { return closing + pull * time; }
  N gap_after(const N& time) const { return gap - (closing + pull * time / N(2)) * time; }

  struct Meeting {
    N speed, in;
  };
  // D > 0, certainly.
  Meeting meeting(const N& square) const {
    if (gap == N(0) && is_negative(closing)) return {-closing, -(closing + closing) / pull};  // thrown up from it
    const N speed = narrow_root(square);
    if (is_negative(N(closing.middle(), 0))) return {speed, (speed - closing) / pull};
    return {speed, (gap + gap) / (closing + speed)};
  }

  // Whether the gap to a ceiling stays open. It is known to be positive the time `before` after that of these numbers,
  // and is to be so until `until`. Returns nothing if it certainly is, else what is open: `second` should be larger.
  struct Open {
    N first, second;
    bool refuted;
  };
  std::optional<Open> closes(const N& before, const N& until) const {
    if (is_negative(closing_after(before))) return {};
    if (is_positive(closing_after(until))) {
      const N end = gap_after(until);
      if (is_positive(end)) return {};
      return Open{N(0), end, is_negative(end)};
    }
    if (is_negative(square())) return {};
    return Open{closing * closing, -fall(),
                is_positive(square()) && is_positive(closing_after(before)) && is_negative(closing_after(until))};
  }
};

}  // namespace cradle
