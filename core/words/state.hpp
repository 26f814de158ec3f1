#pragma once
// The two linear maps of a word, and its self-similar states: closing speeds w and gaps g that a period of collisions
// maps to lambda w and gamma g. Every period then takes gamma/lambda times as long as the one before: the collapse is
// complete in finite time.
//
// The maps. Between collisions gaps g close at speeds w. Restitution r, closing speed c > 0:
//
//   collision at gap l   w[l] -> -r c,   w[l-1] += (1 + r) c s,   w[l+1] += (1 + r) c (1 - s),   s = m_r/(m_l + m_r)
//   flight of time t     g -= w t, until g[l] = 0
//
// The first is linear in w whatever the gaps; for given closing speeds the second is linear in g. Over a word they are
// matrices, the velocity map and the gap map. The gap map is taken backwards in time: the gap of the collision before,
// now g[k], was 0 then, so t = g[k]/(r c). Forwards the self-similar state is mostly unstable, and its eigenvalue the
// smallest one, a difference of larger numbers; backwards it is the largest. A wall is a particle of infinite mass.
//
// *Theorem.* Let a period map w to lambda w and g to gamma g, 0 < gamma < lambda, let every letter meet a positive
// closing speed, and let each collision be later than those of touching letters before it. Then the motion from (g, w)
// makes the collisions of the word, over and over, and no others. *Proof.* Between two of its own collisions a gap is 0
// at both ends, and its closing speed only grows, since collisions beside it push its particles together: it is concave
// in time, so positive in between. Thus no gap closes at other times than those of its letters; and these are in the
// order of the word, except that letters which do not touch may change places, which leaves both maps alone. The next
// period is the same, scaled.
//
// So finitely many strict inequalities (`margins`) decide whether a state exists. Where one of times becomes an
// equality, three particles meet.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "cradle/core/base/planted_error.hpp"
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

template <Real T> struct State {
  std::vector<T> w, g;     // after the last letter of a period; g after the one before it is g times `growth`
  T lambda{0}, growth{0};  // growth = 1/gamma
};

// An inequality of the theorem, by the places of letters in the word.
struct Condition {
  enum class Of { closing, order, period } of = Of::closing;
  std::size_t first = 0, second = 0;  // order: `second` is later than `first`,
  bool next_period = false;           // or is, in the period after it
};

inline std::vector<Condition> conditions(const Word& word, std::size_t gaps) {
  std::vector<Condition> all;
  for (std::size_t k = 0; k < word.size(); ++k) all.push_back({Condition::Of::closing, k, k, false});
  for (std::size_t low = 0; low + 1 < gaps; ++low) {
    const auto places = places_of(word, low);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const bool last = k + 1 == places.size();
      const std::size_t first = places[k], second = places[last ? 0 : k + 1];
      // A gap's own collisions have one beside them in between, whose two conditions imply theirs.
      if (word[first] != word[second]) all.push_back({Condition::Of::order, first, second, last});
    }
  }
  all.push_back({Condition::Of::period, 0, 0, false});
  return all;
}

// A number that must be positive, and the size of what it is a sum of.
template <Real T> struct Margin { T value, scale; };

// A period: closing speeds of its collisions, and the times of flight to them.
template <Real T> struct Course {
  std::vector<std::vector<T>> speeds;
  std::vector<T> flight;
};

template <Real T>
std::vector<Margin<T>> margins(const Word& word, const std::vector<Condition>& conditions, const Course<T>& course,
                               const State<T>& state) {
  std::vector<Margin<T>> all;
  const T rate = state.growth * state.lambda;  // of how a period is longer than the next one
  for (const Condition& condition : conditions) {
    if (condition.of == Condition::Of::closing) {
      const T& value = course.speeds[condition.first][word[condition.first]];
      all.push_back({planted(7) ? magnitude(value) : value, magnitude(value)});
    } else if (condition.of == Condition::Of::order) {
      // Flights only, not differences of times: these would cancel where a period is much longer than the next one.
      T value(0), scale(0);
      const auto add = [&](std::size_t from, std::size_t to, const T& unit) {
        for (std::size_t k = from; k <= to; ++k)
          value += course.flight[k] / unit, scale += magnitude(T(course.flight[k] / unit));
      };
      if (condition.next_period) {
        add(condition.first + 1, word.size() - 1, T(1));
        add(0, condition.second, planted(6) ? T(T(1) / rate) : rate);
      } else {
        add(condition.first + 1, condition.second, T(1));
      }
      all.push_back({planted(8) ? scale : value, scale});
    } else if (!planted(10)) {
      all.push_back({state.lambda, T(1)});
      all.push_back({rate - T(1), T(1)});
    }
  }
  return all;
}

// With the component that the last letter closes, which is 0.
template <Real T> std::vector<T> all_gaps(std::vector<T> open, const Word& word) {
  open.insert(open.begin() + static_cast<std::ptrdiff_t>(word.back()), T(0));
  return open;
}

// A word with its particles, in one type. If the period has a half whose mirror image is the other half, eigenpairs are
// those of the half: two of its eigenvalues can be equal when squared, though they are not.
template <Real T> struct System {
  Word word;
  Shares<T> shares;
  std::vector<Condition> conditions;
  Period period;

  System(Word word_, Shares<T> shares_, bool mirrored = false)
      : word(std::move(word_)), shares(std::move(shares_)),
        conditions(words::conditions(word, shares.left.size())), period{word, mirrored} {
    if (mirrored) period.word.resize(word.size() / 2);
  }

  Matrix<T> velocities(const T& r) const { return velocity_map(period, r, shares); }
  Matrix<T> gaps(const T& r, const std::vector<T>& w) const {
    return gap_map(period, speeds_of(period.word, r, shares, w));
  }
};

template <Real T> Course<T> course(const System<T>& system, const T& r, const State<T>& state) {
  const Word& word = system.word;
  Course<T> course{speeds_of(word, r, system.shares, state.w), std::vector<T>(word.size(), T(0))};
  std::vector<T> g = state.g;
  for (std::size_t k = word.size(); k-- > 0;)
    course.flight[k] = fly_back(g, k > 0 ? word[k - 1] : word.back(), course.speeds[k]);
  return course;
}

// Both eigenpairs of a period: that of the gap map depends on the closing speeds.
template <Real T> struct Pairs { Eigenpair<T> speeds, gaps; };

template <Real T> State<T> state_of(const System<T>& system, const Pairs<T>& pairs) {
  const auto whole = [&](const T& value) { return system.period.mirrored ? T(value * value) : value; };
  std::vector<T> g = all_gaps(pairs.gaps.vector, system.period.word);
  if (system.period.mirrored) std::reverse(g.begin(), g.end());  // from the end of the half to that of the whole
  return {pairs.speeds.vector, std::move(g), whole(pairs.speeds.value), whole(pairs.gaps.value)};
}

template <Real T> std::vector<Margin<T>> margins(const System<T>& system, const T& r, const Pairs<T>& pairs) {
  const State<T> state = state_of(system, pairs);
  return margins(system.word, system.conditions, course(system, r, state), state);
}

template <Real T> void negate(std::vector<T>& x) {
  for (T& component : x) component = -component;
}

// All pairs of eigenvalues, lambda in (0, 1) and growth above 1, at one restitution. They are approximations, with the
// signs for which the first collision and the period are forward. `keep` chooses among closing speeds.
template <Real T, class Keep> std::vector<Pairs<T>> all_pairs(const System<T>& system, const T& r, Keep keep) {
  std::vector<Pairs<T>> all;
  const Matrix<T> v = system.velocities(r);
  for (const T& lambda : real_roots(characteristic_polynomial(v), T(0), T(1))) {
    Pairs<T> pairs;
    pairs.speeds = eigenpair(null_vector(v, lambda), lambda);
    if (is_negative(pairs.speeds.vector[system.word.front()])) negate(pairs.speeds.vector);
    if (!keep(pairs.speeds.vector)) continue;
    const Matrix<T> back = system.gaps(r, pairs.speeds.vector);
    const Polynomial<T> p = characteristic_polynomial(back);
    T bound(1);
    for (const T& coefficient : p) bound += magnitude(coefficient);
    for (const T& growth : real_roots(p, T(1), bound)) {
      pairs.gaps = eigenpair(null_vector(back, growth), growth);
      T time(0);
      for (const T& flight : course(system, r, state_of(system, pairs)).flight) time += flight;
      if (is_negative(time)) negate(pairs.gaps.vector);
      all.push_back(pairs);
    }
  }
  return all;
}

}  // namespace cradle::words
