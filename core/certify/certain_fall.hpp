#pragma once
// A wall and a particle that falls, where all numbers are enclosed. With the gap g, the closing speed w and the pull p,
// the rate at which w grows, counted from any time,
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

#include <optional>

#include "cradle/core/certify/enclosing.hpp"

namespace cradle {

// sqrt(x), where x > 0 is certain. With the root m of its middle |sqrt(y) - m| = |y - x|/(sqrt(y) + m), and sqrt(y) is
// at least m (1 - q) if y is at least x (1 - q): this is half as wide as what a ball's own root allows for.
template <Enclosing N> N narrow_root(const N& x) {
  const N root = sqrt(N(x.middle(), 0));
  const auto share = x.radius() / N(x.middle(), 0).least_size();
  if (!(share < 1)) return sqrt(x);
  constexpr double of_its_rounding = 1 + 0x1p-40;
  return N::widened(root, x.radius() / (root.least_size() * (2 - share)) * of_its_rounding);
}

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
