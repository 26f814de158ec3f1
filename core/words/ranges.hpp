#pragma once
// All that is known of a word: the ranges of restitutions for which its self-similar state exists, what ends them, how
// much of them is proved, and whether the state is stable. Where there is a state is found first as far as rounding
// shows, at the restitutions of a grid.
//
// Stability: the return map of gaps and closing speeds, modulo the scales of both, has the other eigenvalues of the
// velocity map, divided by lambda, and of the gap map, divided by gamma. (The first do not depend on gaps, so the map's
// derivative is block-triangular.) The state is stable if all have moduli below 1; else a perturbation grows, in every
// period, by the largest one.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cradle/core/words/existence.hpp"

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

template <Real T> struct Range {
  End<T> low, high;
  T proved_low{0}, proved_high{0};           // existence is proved in between, both included; nowhere if they are equal
  bool low_ends = false, high_ends = false;  // whether it is proved that the end is one
  T middle{0};
  Pairs<T> pairs{};  // in the middle
};

// How a perturbation grows in a period, and whether its being below 1 is proved or refuted.
template <Real T> struct Stability {
  T factor{0};
  Within within = Within::open;
};

// The polynomial whose roots are the quotients of the others by the root `value`.
template <Real T> Polynomial<T> other_roots(const Polynomial<T>& p, const T& value) {
  return scaled(without_root(p, value), value);
}

// The polynomials of the other eigenvalues of both maps, divided by the state's own; those of the gap map forwards.
template <Real T>
std::pair<Polynomial<T>, Polynomial<T>> others(const System<T>& system, const T& r, const Pairs<T>& at) {
  const auto back = characteristic_polynomial(system.gaps(r, at.speeds.vector));
  const Polynomial<T> forwards(back.rbegin(), back.rend());  // its roots are the reciprocals
  return {other_roots(characteristic_polynomial(system.velocities(r)), at.speeds.value),
          other_roots(forwards, T(T(1) / at.gaps.value))};
}

template <Enclosing B, Real T> Stability<T> stability(const Prover<B, T>& prover, const T& r, const Pairs<T>& pairs) {
  const auto [speeds, gaps] = others(prover.system, r, pairs);
  const T a = largest_modulus(speeds), b = largest_modulus(gaps);
  T factor = a < b ? b : a;
  if (prover.system.period.mirrored) factor *= factor;
  Stability<T> found{factor, Within::open};
  const B ball(r, 0);
  const auto exact = enclosed(prover.exact, prover.system, ball, pairs);
  if (!exact) return found;
  const auto [of_speeds, of_gaps] = others(prover.exact, ball, *exact);
  const Within first = roots_within_unit_circle(of_speeds), second = roots_within_unit_circle(of_gaps);
  if (first == Within::no || second == Within::no)
    found.within = Within::no;
  else if (first == Within::yes && second == Within::yes)
    found.within = Within::yes;
  return found;
}

namespace detail {

// One end of a run of the grid: approximately, then whether it is proved, then existence from the middle up to it.
template <Enclosing B, Real T, Real Q>
void prove_end(const Prover<B, T>& prover, const System<Q>& quick, const Q& inside, const Q& outside,
               const Q& tolerance, const T& radius, Range<T>& range) {
  const bool up = inside < outside;
  End<T>& end = up ? range.high : range.low;
  bool& ends = up ? range.high_ends : range.low_ends;
  T& proved = up ? range.proved_high : range.proved_low;
  T goal;
  if (!up && !is_positive(outside)) {  // on the grid nothing is between it and 0
    end.is = End<T>::Is::zero;
    goal = radius;
  } else {
    const Interval<Q> close = bisected(quick, inside, outside, tolerance, 44);
    // A little apart, so that the long type sees what the short one saw.
    const T off = (T(to_double(outside)) - T(to_double(inside))) / T(1'000'000'000);
    const T yes = T(to_double(close.low)) - off, no = T(to_double(close.high)) + off;
    const BestState<T> at = find(prover.system, yes, T(0));
    end.at = yes;
    goal = yes;
    if (at.verdict == Verdict::exists) {
      if (End<T> found = end_near(prover.system, yes, no, at.pairs); found.is != End<T>::Is::unresolved) {
        end = std::move(found);
        ends = prover.ends(end, T(end.at - radius), T(end.at + radius));
        goal = up ? T(end.at - radius) : T(end.at + radius);
      }
    }
  }
  proved = prover.march(range.middle, goal, range.pairs);
  if (end.is == End<T>::Is::zero) ends = !(goal < proved);
}

}  // namespace detail

// The ranges seen on a grid, with their ends enclosed by `radius`. `quick` is the same system in a short type.
template <Enclosing B, Real T, Real Q>
std::vector<Range<T>> ranges(const Prover<B, T>& prover, const System<Q>& quick, const std::vector<Run>& runs,
                             std::size_t points, const Q& tolerance, const T& radius) {
  std::vector<Range<T>> all;
  for (std::size_t which = 0; which < runs.size(); ++which) {
    Run run = runs[which];
    if (run.verdict != Verdict::exists) continue;
    // Near 0 margins can be too small for the short type, which then takes them for 0.
    if (which == 1 && runs[0].verdict == Verdict::degenerate) run.first = 0;
    Range<T> range;
    range.middle = grid_point<T>((run.first + run.last) / 2, points);
    BestState<T> found = find(prover.system, range.middle, T(0));
    if (found.verdict != Verdict::exists) continue;
    range.pairs = std::move(found.pairs);
    const auto grid = [&](std::size_t k) { return grid_point<Q>(k, points); };
    detail::prove_end(prover, quick, grid(run.first), run.first > 0 ? grid(run.first - 1) : Q(0), tolerance, radius,
                      range);
    detail::prove_end(prover, quick, grid(run.last), grid(run.last + 1), tolerance, radius, range);
    all.push_back(std::move(range));
  }
  return all;
}

// The gaps and closing speeds half-way to the first collision of a period, when all gaps are open; and the time from
// then until the collapse is complete.
template <Real T> struct Start {
  std::vector<T> gaps, speeds;
  T collapse{0};
};

template <Real T> Start<T> start_of(const System<T>& system, const T& r, const Pairs<T>& pairs) {
  const State<T> state = state_of(system, pairs);
  const Course<T> one = course(system, r, state);
  Start<T> start{state.g, state.w, T(0)};
  T period(0);
  for (const T& flight : one.flight) period += flight;
  const T half = one.flight.front() / T(2);
  for (std::size_t i = 0; i < start.gaps.size(); ++i)
    start.gaps[i] = start.gaps[i] * state.growth - start.speeds[i] * half;
  const T rate = state.growth * state.lambda;
  start.collapse = period * rate / (rate - T(1)) - half;
  return start;
}

}  // namespace cradle::words
