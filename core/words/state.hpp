#pragma once
// Self-similar states of a word: closing speeds w and gaps g that a period of collisions maps to lambda w and gamma g.
// Every period then takes gamma/lambda times as long as the one before: the collapse is complete in finite time.
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

#include "cradle/core/words/eigenpair.hpp"
#include "cradle/core/words/maps.hpp"
#include "cradle/core/words/word.hpp"

namespace cradle::words {

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
