#pragma once
// The two linear maps of a word. Between collisions gaps g close at speeds w. Restitution r, closing speed c > 0:
//
//   collision at gap l   w[l] -> -r c,   w[l-1] += (1 + r) c s,   w[l+1] += (1 + r) c (1 - s),   s = m_r/(m_l + m_r)
//   flight of time t     g -= w t, until g[l] = 0
//
// The first is linear in w whatever the gaps; for given closing speeds the second is linear in g. Over a word they are
// matrices, the velocity map and the gap map. The gap map is taken backwards in time: the gap of the collision before,
// now g[k], was 0 then, so t = g[k]/(r c). Forwards the self-similar state is mostly unstable, and its eigenvalue the
// smallest one, a difference of larger numbers; backwards it is the largest. A wall is a particle of infinite mass.

#include <cstddef>
#include <vector>

#include "cradle/core/base/planted_error.hpp"
#include "cradle/core/base/real.hpp"
#include "cradle/core/words/linear.hpp"
#include "cradle/core/words/word.hpp"

namespace cradle::words {

struct Walls {
  bool left = false, right = false;
};

// The shares of the closing speed that a collision takes away which its neighbours get.
template <Real T> struct Shares { std::vector<T> left, right; };

template <Real T> Shares<T> shares(const std::vector<T>& masses, Walls walls) {
  Shares<T> all;
  const auto add = [&](const T& left, const T& right) { all.left.push_back(left), all.right.push_back(right); };
  if (walls.left) add(T(0), T(1));
  for (std::size_t i = 0; i + 1 < masses.size(); ++i) {
    const T sum = masses[i] + masses[i + 1];
    if (planted(1))
      add(T(masses[i] / sum), T(masses[i + 1] / sum));
    else
      add(T(masses[i + 1] / sum), T(masses[i] / sum));
  }
  if (walls.right) add(T(1), T(0));
  return all;
}

// A collision at gap `at`; w is a vector of closing speeds, or the rows of a matrix that maps to them.
template <Real T> void collide(std::vector<T>& w, std::size_t at, const T& r, const Shares<T>& shares) {
  const T closing = w[at], lost = (T(1) + r) * closing;
  if (at > 0) w[at - 1] += lost * shares.left[at];
  if (at + 1 < w.size()) w[at + 1] += lost * (planted(2) ? shares.left[at] : shares.right[at]);
  w[at] = planted(3) ? closing - lost * r : -(r * closing);
}

// The flight, backwards from a collision to the one before it at gap `before`, with closing speeds w. Returns its time.
template <Real T> T fly_back(std::vector<T>& g, std::size_t before, const std::vector<T>& w) {
  const T time = -g[before] / w[before];
  for (std::size_t i = 0; i < g.size(); ++i) g[i] += planted(4) ? T(-(w[i] * time)) : T(w[i] * time);
  g[before] = T(0);
  return time;
}

// A period of a word: its collisions and, if it is only half of one, the mirror image that the second half is of it.
struct Period {
  Word word;
  bool mirrored = false;

  std::size_t seen(std::size_t gap, std::size_t gaps) const { return mirrored ? gaps - 1 - gap : gap; }
  // The gap that closes before the letter at `place`.
  std::size_t before(std::size_t place, std::size_t gaps) const {
    return place > 0 ? word[place - 1] : planted(9) ? word.back() : seen(word.back(), gaps);
  }
};

template <Real T> Matrix<T> velocity_map(const Period& period, const T& r, const Shares<T>& shares) {
  const std::size_t gaps = shares.left.size();
  Matrix<T> map(gaps);
  for (std::size_t column = 0; column < gaps; ++column) {
    std::vector<T> w(gaps, T(0));
    w[column] = T(1);
    for (const std::size_t letter : period.word) collide(w, letter, r, shares);
    for (std::size_t row = 0; row < gaps; ++row) map(row, column) = w[period.seen(row, gaps)];
  }
  return map;
}

// The closing speeds before each collision.
template <Real T>
std::vector<std::vector<T>> speeds_of(const Word& word, const T& r, const Shares<T>& shares, std::vector<T> w) {
  std::vector<std::vector<T>> speeds;
  for (const std::size_t letter : word) {
    speeds.push_back(w);
    collide(w, letter, r, shares);
  }
  return speeds;
}

// The map from the last collision of a period back to the last one before it, of all gaps but that which both close.
template <Real T> Matrix<T> gap_map(const Period& period, const std::vector<std::vector<T>>& speeds) {
  const std::size_t gaps = speeds.front().size(), closed = period.word.back();
  const auto open = [closed](std::size_t k) { return k < closed ? k : k + 1; };
  Matrix<T> map(gaps - 1);
  for (std::size_t column = 0; column + 1 < gaps; ++column) {
    std::vector<T> g(gaps, T(0));
    g[open(column)] = T(1);
    for (std::size_t k = period.word.size(); k-- > 0;) fly_back(g, period.before(k, gaps), speeds[k]);
    for (std::size_t row = 0; row + 1 < gaps; ++row) map(row, column) = g[period.seen(open(row), gaps)];
  }
  return map;
}

}  // namespace cradle::words
