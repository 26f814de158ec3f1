#pragma once
// The state of a chain at one time: positions and velocities computed from the chain's own coordinates, and the gaps
// and closing speeds themselves, since positions cannot resolve a collapsing core.
// Lengths, speeds and masses in units of the scene.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "cradle/core/initial/particles.hpp"

namespace cradle {

template <Real T> struct Configuration {
  T time{0};
  ParticleIndex from = 0, to = -1;  // range of particle numbers at the start; merged ones are included
  // The particles that have collided or are between such: [collided_from, collided_to) of the n.
  std::size_t collided_from = 0, collided_to = 0;
  std::vector<ParticleIndex> index;  // n particles from left to right, by their number at the start
  std::vector<T> x, v, m;            // n
  std::vector<T> gap;  // n - 1, between neighbours; n on a ring, the last one from the last particle to the first
  std::vector<T> closing_speed;  // as many, v_left - v_right

  // The sum of all gaps (closing speeds) subtracted from the distance (velocity difference) of the two outermost
  // particles; on a ring, from the circumference (from 0): the accumulated rounding of the run, where it is measured
  // (README.md, Closure). Chains with closing speeds distribute both errors over the positions and velocities given
  // here; the others compute positions from the left.
  std::optional<T> closure_gap, closure_speed;
  // Whether velocities are sums of closing speeds, so that the rounding errors of all of them add up.
  bool speeds_are_sums = false;

  void reserve(std::size_t n) {
    index.reserve(n);
    for (auto* values : {&x, &v, &m, &gap, &closing_speed}) values->reserve(n);
  }
};

// Removes walls, which chains number -1 and `count` (wall.hpp), and the gaps to them.
template <Real T> void leave_out_walls(Configuration<T>& c, ParticleIndex count) {
  if (c.to == count) {
    c.to -= 1;
    c.index.pop_back();
    for (auto* values : {&c.x, &c.v, &c.m, &c.gap, &c.closing_speed}) values->pop_back();
    c.collided_to = std::min(c.collided_to, c.x.size());
  }
  if (c.from == -1) {
    c.from = 0;
    c.index.erase(c.index.begin());
    for (auto* values : {&c.x, &c.v, &c.m, &c.gap, &c.closing_speed}) values->erase(values->begin());
    if (c.collided_from > 0) c.collided_from -= 1;
    if (c.collided_to > 0) c.collided_to -= 1;
  }
}

// Folds positions on a ring, increasing and spanning less than its circumference, to 0 <= x < circumference, the
// smallest first. Positions so many turns away that they have no digits within one turn are not changed.
template <Real T> void fold(Configuration<T>& c, const T& circumference) {
  if (c.x.empty()) return;
  const auto turns = [&] { return T(c.x.front() / circumference); };
  if (!(magnitude(turns()) * T(std::numeric_limits<T>::epsilon()) < T(1)) || !std::isfinite(to_double(turns()))) return;
  for (double whole = 0x1p52; std::abs(whole) >= 0x1p52;) {  // a double has not all digits of more turns than that
    whole = std::floor(to_double(turns()));
    const T all = exactly<T>(whole);
    for (T& x : c.x) x -= all * circumference;
  }
  std::size_t first = 0;
  const auto rotate = [&](auto& values) {
    std::rotate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first), values.end());
  };
  for (std::size_t j = c.x.size(); j-- > 0 && !(c.x[j] < circumference); first = j) c.x[j] -= circumference;
  rotate(c.index);
  for (auto* values : {&c.x, &c.v, &c.m, &c.gap, &c.closing_speed}) rotate(*values);
}

}  // namespace cradle
