#pragma once
// Where a word has a self-similar state, as far as rounding shows: at one restitution, and at those of a grid. What is
// found here is proved in existence.hpp.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cradle/core/words/state.hpp"

namespace cradle::words {

enum class Verdict { none, degenerate, exists };

// Degenerate: no margin is negative, but some are 0, as far as the type resolves.
template <Real T> Verdict verdict(const std::vector<Margin<T>>& margins, const T& tolerance) {
  Verdict found = Verdict::exists;
  for (const Margin<T>& margin : margins) {
    if (margin.value < -tolerance * margin.scale || !(margin.scale == margin.scale)) return Verdict::none;
    if (!(margin.value > tolerance * margin.scale)) found = Verdict::degenerate;
  }
  return found;
}

// The best state at one restitution.
template <Real T> struct BestState {
  Verdict verdict = Verdict::none;
  Pairs<T> pairs{};
};

template <Real T> BestState<T> find(const System<T>& system, const T& r, const T& tolerance) {
  BestState<T> best;
  const auto closing = [&](const std::vector<T>& speeds) {
    std::vector<T> w = speeds;
    for (const std::size_t letter : system.word) {
      if (!planted(7) && w[letter] < -tolerance) return false;
      collide(w, letter, r, system.shares);
    }
    return true;
  };
  for (Pairs<T>& pairs : all_pairs(system, r, closing)) {
    const Verdict of = verdict(margins(system, r, pairs), tolerance);
    if (best.verdict < of) best = {of, std::move(pairs)};
  }
  return best;
}

// Where a period begins: with the first letter to which there is a flight, or after the last collision before the
// longest flight, as a part of a period. The latter keeps most digits: a flight that vanishes at an end, and is a small
// difference there, is then not the last one of the way backwards. A half whose mirror image is the other one is used
// if it is allowed.
enum class Begin { first, longest, longest_or_half };

// The same motion with its collisions in the order of their times at one restitution: then flights are positive, and no
// margin is a difference of large ones.
template <Real T> System<T> in_order_of_time(System<T> system, const T& r, const T& tolerance, Begin where) {
  const std::size_t gaps = system.shares.left.size(), length = system.word.size();
  T rate(1);
  const auto flights = [&](const System<T>& of) {
    const BestState<T> found = find(of, r, tolerance);
    if (found.verdict == Verdict::none) return std::vector<T>();
    const State<T> state = state_of(of, found.pairs);
    rate = state.growth * state.lambda;
    return course(of, r, state).flight;
  };
  std::vector<T> times = flights(system);
  for (std::size_t swaps = 0; swaps < length * length && times.size() == length; ++swaps) {
    T scale(0);
    for (const T& time : times) scale += magnitude(time);
    std::size_t late = 0;
    while (late < length && !(times[late] < -tolerance * scale)) ++late;
    if (late == length) break;
    Word word = system.word;
    if (late == 0) word = rotated(std::move(word), length - 1), late = 1;
    if (touch(word[late - 1], word[late])) break;
    std::swap(word[late - 1], word[late]);
    system = System<T>(std::move(word), system.shares);
    times = flights(system);
  }
  if (times.size() != length) return system;
  std::size_t begin = length, half = length;
  T longest(0), longest_half(0);
  for (std::size_t k = 0; k < length; ++k) {
    // Letters that do not touch may close at the same time.
    if (!(times[k] > times[(k + 1) % length] / T(1000) / (k + 1 < length ? T(1) : rate))) continue;
    T period(0);
    for (std::size_t i = 0; i < length; ++i) period += times[(k + i) % length] / (k + i < length ? T(1) : rate);
    const T part = times[k] / period;
    if (begin == length || (where != Begin::first && part > longest)) begin = k, longest = part;
    if (has_mirrored_half(rotated(system.word, k), gaps) && part > longest_half) half = k, longest_half = part;
  }
  if (where == Begin::longest_or_half && half < length)
    return System<T>(rotated(system.word, half), system.shares, true);
  return begin == length ? system : System<T>(rotated(system.word, begin), system.shares);
}

template <Real T> struct Interval { T low, high; };

// Runs of restitutions with the same verdict on a grid in (0, 1).
struct Run {
  Verdict verdict;
  std::size_t first, last;  // points of the grid: (k + 1)/(points + 1)
};

template <Real T> T grid_point(std::size_t k, std::size_t points) {
  return T(static_cast<std::int64_t>(k + 1)) / T(static_cast<std::int64_t>(points + 1));
}

template <Real T> std::vector<Run> scan(const System<T>& system, std::size_t points, const T& tolerance) {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < points; ++k) {
    const Verdict here = find(system, grid_point<T>(k, points), tolerance).verdict;
    if (runs.empty() || runs.back().verdict != here)
      runs.push_back({here, k, k});
    else
      runs.back().last = k;
  }
  return runs;
}

// Between a restitution at which a state exists and one at which none does: nearer ones.
template <Real T> Interval<T> bisected(const System<T>& system, T yes, T no, const T& tolerance, int steps) {
  for (int i = 0; i < steps; ++i) {
    const T middle = (yes + no) / T(2);
    (find(system, middle, tolerance).verdict == Verdict::exists ? yes : no) = middle;
  }
  return {yes, no};
}

}  // namespace cradle::words
