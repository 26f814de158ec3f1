#pragma once
// The restitutions for which a word has a self-similar state are found approximately, then proved.
//
//   scan      at many restitutions (ranges.hpp): eigenvalues, signs of the margins. An interval narrower than the grid
//             is missed.
//   end       where a margin changes its sign, by the secant method in a long type
//   proof     balls of restitutions, one beside the other from the middle to the ends, in each of which all margins are
//             positive; and a ball around each end in which one margin is 0: it is positive on one side, negative on
//             the other, and continuous in between, since the eigenpairs in the ball are unique
//
// What is proved is existence inside and the equality at the ends. That there is nothing outside is only seen.

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/words/state.hpp"

namespace cradle::words {

template <Real T> T usual_error() { return std::numeric_limits<T>::epsilon() * T(1024); }

// The state near a known one at another restitution, by Newton's method, to an error of about `small`.
template <Real T>
Pairs<T> followed(const System<T>& system, const T& r, Pairs<T> pairs, const T& small = usual_error<T>()) {
  improve(system.velocities(r), pairs.speeds, small);
  improve(system.gaps(r, pairs.speeds.vector), pairs.gaps, T(small * pairs.gaps.value));
  return pairs;
}

// Both eigenpairs at all restitutions of a ball, near an approximation at its middle.
template <Enclosing B, Real T>
std::optional<Pairs<B>> enclosed(const System<B>& exact, const System<T>& system, const B& r, const Pairs<T>& near) {
  const T& middle = r.middle();
  const auto speeds = enclosed(exact.velocities(r), system.velocities(middle), near.speeds);
  if (!speeds) return {};
  const auto gaps = enclosed(exact.gaps(r, speeds->vector), system.gaps(middle, near.speeds.vector), near.gaps);
  if (!gaps) return {};
  return Pairs<B>{*speeds, *gaps};
}

// The ball of all numbers between two.
template <Enclosing B, Real T> B between(const T& a, const T& b) {
  const T middle = (a + b) / T(2);
  const B to_a = B(middle, 0) - B(a, 0), to_b = B(b, 0) - B(middle, 0);
  return B::widened(B(middle, 0), to_a.size() < to_b.size() ? to_b.size() : to_a.size());
}

// An end of an interval of restitutions.
template <Real T> struct End {
  // A margin is 0; two eigenvalues of the velocity map meet, and are complex beyond; r = 0.
  enum class Is { equality, meeting, zero, unresolved } is = Is::unresolved;
  T at{0};
  std::size_t margin = 0;  // equality: which one; of several the first
  Pairs<T> pairs{};        // equality: the state at the end
  T lambda{0};             // meeting: the double eigenvalue
};

template <Enclosing B, Real T> class Prover {
 public:
  static constexpr int most_tries = 20'000;

  Prover(const Word& word, Shares<T> shares, Shares<B> exact_shares, bool mirrored = false)
      : system(word, std::move(shares), mirrored), exact(word, std::move(exact_shares), mirrored) {}

  System<T> system;
  System<B> exact;

  // Whether all margins are positive at all restitutions of the ball; the approximation is followed to its middle.
  bool holds(const B& r, Pairs<T>& near, const T& width) const {
    Pairs<T> here = followed(system, r.middle(), near, T(width / T(1000)));
    const auto pairs = enclosed(exact, system, r, here);
    if (!pairs) return false;
    for (const Margin<B>& margin : margins(exact, r, *pairs))
      if (!is_positive(margin.value)) return false;
    near = std::move(here);
    return true;
  }

  // Proves existence from a restitution on towards another one, in steps that grow after one that succeeds and shrink
  // after one that fails. Returns how far it came.
  T march(T from, const T& to, Pairs<T> near) const {
    const bool up = from < to;
    T step = (to - from) / T(64);
    for (int tries = 0; tries < most_tries && (up ? from < to : to < from); ++tries) {
      T next = from + step;
      if (up ? !(next < to) : !(to < next)) next = to;
      if (holds(between<B>(from, next), near, magnitude(T(next - from)))) {
        from = next;
        step = step * T(9) / T(8);
      } else {
        step = (next - from) * T(2) / T(3);
        if (magnitude(step) < magnitude(T(to - from)) / T(1'000'000)) break;
      }
    }
    return from;
  }

  // Proves what the end is, between two restitutions: the state ceases to exist in between.
  bool ends(const End<T>& end, const T& low, const T& high) const {
    if (end.is == End<T>::Is::equality) return is_equality(end, low, high);
    return end.is == End<T>::Is::meeting && is_meeting(end, low, high);
  }

 private:
  // Whether a number is certainly negative at one of two restitutions and positive at the other; `value_at` returns
  // nothing where it is not known.
  template <class F> static bool changes_sign(const T& low, const T& high, F value_at) {
    bool negative = false, positive = false;
    for (const T& side : {low, high}) {
      const std::optional<B> value = value_at(B(side, 0));
      if (!value) return false;
      negative = negative || is_negative(*value);
      positive = positive || is_positive(*value);
    }
    return negative && positive;
  }
  // The same, of a number of eigenpairs that are those of the ball in between.
  template <class At, class F> static bool vanishes(const T& low, const T& high, At eigenpairs_at, F value_of) {
    const auto around = eigenpairs_at(between<B>(low, high));
    return around && changes_sign(low, high, [&](const B& r) {
             const auto at = eigenpairs_at(r);
             return at && within(*at, *around) ? std::optional<B>(value_of(r, *at)) : std::nullopt;
           });
  }

  // A closing speed depends on one eigenpair only; where it is 0, the other one has no enclosure, since times are
  // quotients by it.
  bool is_equality(const End<T>& end, const T& low, const T& high) const {
    if (end.margin < exact.word.size()) {
      const auto speeds_at = [&](const B& r) {
        Eigenpair<T> near = end.pairs.speeds;
        improve(system.velocities(r.middle()), near, usual_error<T>());
        return enclosed(exact.velocities(r), system.velocities(r.middle()), near);
      };
      return vanishes(low, high, speeds_at, [&](const B& r, const Eigenpair<B>& speeds) {
        return speeds_of(exact.word, r, exact.shares, speeds.vector)[end.margin][exact.word[end.margin]];
      });
    }
    const auto pairs_at = [&](const B& r) {
      return enclosed(exact, system, r, followed(system, r.middle(), end.pairs));
    };
    return vanishes(low, high, pairs_at,
                    [&](const B& r, const Pairs<B>& pairs) { return margins(exact, r, pairs)[end.margin].value; });
  }

  // Let x(r) be the root of the derivative of the characteristic polynomial p near the double eigenvalue: unique in a
  // ball, since the second derivative has one sign there and the first one two. Then p(x(r)), which is 0 where two
  // eigenvalues meet, has different signs on both sides. With x within h of x0, p(x) is p(x0) + p'(ball) (x - x0).
  bool is_meeting(const End<T>& end, const T& low, const T& high) const {
    const T width = magnitude(T(high - low)) * T(1'000'000);
    const B near = between<B>(T(end.lambda - width), T(end.lambda + width));
    const auto at = [&](const B& r) { return characteristic_polynomial(exact.velocities(r)); };
    const Polynomial<B> first = derivative(at(between<B>(low, high))), second = derivative(first);
    const B bend = value_at(second, near);
    const B left = value_at(first, B(T(end.lambda - width), 0)), right = value_at(first, B(T(end.lambda + width), 0));
    if (!(is_positive(bend) && is_negative(left) && is_positive(right)) &&
        !(is_negative(bend) && is_positive(left) && is_negative(right)))
      return false;
    return changes_sign(low, high, [&](const B& r) {
      const Polynomial<B> p = at(r);
      return value_at(p, B(end.lambda, 0)) + value_at(derivative(p), near) * (near - B(end.lambda, 0));
    });
  }

  static bool within(const B& inner, const B& outer) { return (inner - B(outer.middle(), 0)).size() <= outer.radius(); }
  static bool within(const Eigenpair<B>& inner, const Eigenpair<B>& outer) {
    bool all = inner.fixed == outer.fixed && within(inner.value, outer.value);
    for (std::size_t i = 0; i < inner.vector.size(); ++i)
      all = all && (i == inner.fixed || within(inner.vector[i], outer.vector[i]));
    return all;
  }
  static bool within(const Pairs<B>& inner, const Pairs<B>& outer) {
    return within(inner.speeds, outer.speeds) && within(inner.gaps, outer.gaps);
  }
};

// The root of f between two places where its signs differ, by the secant method; none if that leaves them.
template <Real T, class F> std::optional<T> root_between(const T& a, const T& b, F f) {
  T x0 = a, x1 = b, f0 = f(a), f1 = f(b);
  const T small = magnitude(T(b - a)) * std::numeric_limits<T>::epsilon();
  for (int step = 0; step < 60 && magnitude(T(x1 - x0)) > small && !(f1 == f0); ++step) {
    const T next = x1 - f1 * (x1 - x0) / (f1 - f0);
    x0 = std::exchange(x1, next);
    f0 = std::exchange(f1, f(next));
  }
  const bool inside = a < b ? a < x1 && x1 < b : b < x1 && x1 < a;  // not if it is no number
  if (!inside) return {};
  return x1;
}

// Where the state's eigenvalue meets another one, between restitutions with and without the state; else unresolved.
template <Real T> End<T> meeting_near(const System<T>& system, const T& yes, const T& no, const Pairs<T>& known) {
  const auto p_at = [&](const T& r) { return characteristic_polynomial(system.velocities(r)); };
  const T& near = known.speeds.value;
  T lambda(0);
  for (const T& turn : real_roots(derivative(p_at(yes)), T(0), T(1)))
    if (!is_positive(lambda) || magnitude(T(turn - near)) < magnitude(T(lambda - near))) lambda = turn;
  const auto extreme = [&](const T& r) {
    const Polynomial<T> p = p_at(r), first = derivative(p), second = derivative(first);
    for (int step = 0; step < 12; ++step) lambda -= value_at(first, lambda) / value_at(second, lambda);
    return value_at(p, lambda);
  };
  if (!is_positive(lambda) || is_negative(extreme(yes)) == is_negative(extreme(no))) return {};
  const auto root = root_between(yes, no, extreme);
  if (!root) return {};
  extreme(*root);
  return {.is = End<T>::Is::meeting, .at = *root, .lambda = lambda};
}

// Where a margin of the state becomes 0.
template <Real T> End<T> equality_near(const System<T>& system, const T& yes, const T& no, const Pairs<T>& known) {
  Pairs<T> pairs = followed(system, yes, known);
  const auto values = [&](const T& r) {
    pairs = followed(system, r, std::move(pairs));
    return margins(system, r, pairs);
  };
  const std::vector<Margin<T>> at_yes = values(yes), at_no = values(no);
  std::size_t margin = 0;
  std::optional<T> nearest;  // as a share of the way
  for (std::size_t k = 0; k < at_yes.size(); ++k) {
    const T a = at_yes[k].value, b = at_no[k].value;
    if (!is_positive(a) || !is_negative(b)) continue;
    const T share = a / (a - b);
    // Where several are 0 at once, the first one, which may be a closing speed: then gaps need not be enclosed.
    if (!nearest || share < *nearest * (T(1) - T(1) / T(1'000'000))) nearest = share, margin = k;
  }
  if (!nearest) return {};
  const auto root = root_between(yes, no, [&](const T& r) { return values(r)[margin].value; });
  if (!root) return {};
  return {.is = End<T>::Is::equality, .at = *root, .margin = margin, .pairs = std::move(pairs)};
}

template <Real T> End<T> end_near(const System<T>& system, const T& yes, const T& no, const Pairs<T>& known) {
  const End<T> meeting = meeting_near(system, yes, no, known);
  return meeting.is == End<T>::Is::meeting ? meeting : equality_near(system, yes, no, known);
}

}  // namespace cradle::words
