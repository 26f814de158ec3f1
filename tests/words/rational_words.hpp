#pragma once
// Whether a word has a self-similar state, decided in quotients of integers: nothing of core/words/ but its words is
// used. Velocities of particles instead of closing speeds, times forwards, eigenvectors as columns of adjugates at
// isolated roots of characteristic polynomials, all in intervals with rational ends.

#include <boost/math/tools/polynomial.hpp>

#include "cradle/core/words/word.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test {

// An interval; ends are rounded outwards to multiples of 2^-450, so that they do not grow without end.
struct Rationals {
  Rational low, high;

  Rationals(const Rational& a, const Rational& b) : low(rounded(a, false)), high(rounded(b, true)) {}
  Rationals(const Rational& exact = 0) : low(exact), high(exact) {}

  static Rational rounded(const Rational& x, bool up) {
    using boost::multiprecision::cpp_int;
    static const cpp_int unit = cpp_int(1) << 450;
    cpp_int whole, rest;
    divide_qr(cpp_int(numerator(x) * unit), cpp_int(denominator(x)), whole, rest);
    if (rest == 0) return x;
    if (up && rest > 0) ++whole;
    if (!up && rest < 0) --whole;
    return Rational(whole, unit);
  }
  bool positive() const { return low > 0; }
  bool negative() const { return high < 0; }

  friend Rationals operator+(const Rationals& a, const Rationals& b) { return {a.low + b.low, a.high + b.high}; }
  friend Rationals operator-(const Rationals& a, const Rationals& b) { return {a.low - b.high, a.high - b.low}; }
  friend Rationals operator*(const Rationals& a, const Rationals& b) {
    const auto [least, most] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
    return {least, most};
  }
  friend Rationals operator/(const Rationals& a, const Rationals& b) {
    if (!b.positive() && !b.negative()) throw std::runtime_error("division by what may be 0");
    return a * Rationals(1 / b.high, 1 / b.low);
  }
};

template <class N> using Square = std::vector<std::vector<N>>;

// The matrices N_k with adj(x - A) = sum x^k N_k, and the coefficients of det(x - A).
template <class N> struct Adjugate {
  std::vector<Square<N>> matrices;
  std::vector<N> polynomial;

  explicit Adjugate(const Square<N>& a) {
    const std::size_t n = a.size();
    matrices.assign(n, Square<N>(n, std::vector<N>(n, N(0))));
    polynomial.assign(n + 1, N(0));
    polynomial[n] = N(1);
    for (std::size_t k = n; k-- > 0;) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
          for (std::size_t m = 0; m < n && k + 1 < n; ++m)
            matrices[k][i][j] = matrices[k][i][j] + a[i][m] * matrices[k + 1][m][j];
        matrices[k][i][i] = matrices[k][i][i] + polynomial[k + 1];
      }
      N trace(0);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t m = 0; m < n; ++m) trace = trace + a[i][m] * matrices[k][m][i];
      polynomial[k] = N(0) - trace / N(Rational(static_cast<long>(n - k)));
    }
  }

  // A column of adj(x - A): the eigenvector of a root x. The one with a component that is certainly not 0 and largest.
  std::vector<Rationals> eigenvector(const Rationals& x) const {
    const std::size_t n = matrices.size();
    std::vector<Rationals> best;
    Rational size = 0;
    for (std::size_t column = 0; column < n; ++column) {
      std::vector<Rationals> v(n);
      Rational least = 0;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = n; k-- > 0;) v[i] = v[i] * x + Rationals(matrices[k][i][column]);
        if (v[i].positive() || v[i].negative()) least = std::max<Rational>(least, abs(Rational(v[i].low + v[i].high)));
      }
      if (least > size) size = least, best = v;
    }
    if (best.empty()) throw std::runtime_error("no eigenvector");
    return best;
  }
};

using RationalPolynomial = boost::math::tools::polynomial<Rational>;

// Sign changes of Sturm's chain at x.
inline int changes(const std::vector<RationalPolynomial>& chain, const Rational& x) {
  int count = 0, last = 0;
  for (const RationalPolynomial& p : chain) {
    const int sign = p(x).sign();
    if (sign != 0 && last != 0 && sign != last) ++count;
    if (sign != 0) last = sign;
  }
  return count;
}

// All real roots in (low, high), each in an interval of relative width 2^-250.
inline std::vector<Rationals> isolated_roots(const std::vector<Rational>& coefficients, const Rational& low,
                                             const Rational& high) {
  const RationalPolynomial p(coefficients);
  if (p.size() < 2) return {};
  std::vector<RationalPolynomial> chain{p, p.prime()};
  for (;;) {
    const RationalPolynomial rest = chain[chain.size() - 2] % chain.back();
    if (rest.is_zero()) break;
    chain.push_back(-rest);
  }
  std::vector<Rationals> found;
  std::vector<std::pair<Rational, Rational>> open{{low, high}};
  while (!open.empty()) {
    auto [a, b] = open.back();
    open.pop_back();
    const int count = changes(chain, a) - changes(chain, b);
    if (count == 0) continue;
    if (count > 1) {
      const Rational middle = (a + b) / 2;
      open.push_back({a, middle}), open.push_back({middle, b});
      continue;
    }
    while (b - a > b / (Rational(boost::multiprecision::cpp_int(1) << 250))) {
      const Rational middle = (a + b) / 2;
      (changes(chain, a) - changes(chain, middle) == 1 ? b : a) = middle;
    }
    found.push_back({a, b});
  }
  return found;
}

// One collision of particles l and l + 1.
template <class N>
void collide_particles(std::vector<N>& u, const std::vector<Rational>& m, std::size_t l, const Rational& r) {
  const N impulse = N(Rational((1 + r) * m[l] * m[l + 1] / (m[l] + m[l + 1]))) * (u[l] - u[l + 1]);
  u[l] = u[l] - impulse * N(Rational(1 / m[l]));
  u[l + 1] = u[l + 1] + impulse * N(Rational(1 / m[l + 1]));
}

// Whether the word has a self-similar state. Throws where intervals do not decide.
inline bool exists_rationally(const words::Word& word, const std::vector<Rational>& masses, const Rational& r) {
  const std::size_t n = word.size(), gaps = masses.size() - 1;
  const auto velocities = [&]<class N>(const std::vector<N>& w) {
    std::vector<N> u(gaps + 1, N(0));
    for (std::size_t i = 0; i < gaps; ++i) u[i + 1] = u[i] - w[i];
    return u;
  };
  Square<Rational> v(gaps, std::vector<Rational>(gaps));
  for (std::size_t column = 0; column < gaps; ++column) {
    std::vector<Rational> w(gaps, 0);
    w[column] = 1;
    std::vector<Rational> u = velocities(w);
    for (const std::size_t letter : word) collide_particles(u, masses, letter, r);
    for (std::size_t i = 0; i < gaps; ++i) v[i][column] = u[i] - u[i + 1];
  }
  const Adjugate<Rational> of_v(v);
  for (const Rationals& lambda : isolated_roots(of_v.polynomial, 0, 1)) {
    std::vector<Rationals> w = of_v.eigenvector(lambda);
    if (w[word[0]].negative())
      for (Rationals& x : w) x = Rationals(0) - x;
    // Forwards: gaps and times as linear functions of the gaps at the beginning.
    Square<Rationals> g(gaps, std::vector<Rationals>(gaps)), times;
    for (std::size_t i = 0; i < gaps; ++i)
      if (i != word.back()) g[i][i] = Rationals(1);
    std::vector<Rationals> u = velocities(w), time(gaps);
    bool closes = true;
    for (const std::size_t letter : word) {
      const Rationals closing = u[letter] - u[letter + 1];
      if (!closing.positive() && !closing.negative()) throw std::runtime_error("a closing speed that may be 0");
      closes = closes && closing.positive();
      if (!closes) break;
      std::vector<Rationals> flight(gaps);
      for (std::size_t k = 0; k < gaps; ++k) flight[k] = g[letter][k] / closing, time[k] = time[k] + flight[k];
      for (std::size_t i = 0; i < gaps; ++i)
        for (std::size_t k = 0; k < gaps; ++k)
          g[i][k] = i == letter ? Rationals(0) : g[i][k] - (u[i] - u[i + 1]) * flight[k];
      times.push_back(time);
      collide_particles(u, masses, letter, r);
    }
    if (!closes) continue;
    const Adjugate<Rationals> of_g(g);
    std::vector<Rational> middle;
    for (const Rationals& c : of_g.polynomial) middle.push_back((c.low + c.high) / 2);
    middle.erase(middle.begin());  // the gap that the last letter closes gives a root 0
    for (const Rationals& root : isolated_roots(middle, 0, lambda.low)) {
      // A little wider, the intervals' polynomial certainly changes its sign.
      const Rational room = root.high / Rational(boost::multiprecision::cpp_int(1) << 90);
      const Rationals gamma(root.low - room, root.high + room);
      const auto at = [&](const Rational& x) {
        Rationals sum(0);
        for (std::size_t k = of_g.polynomial.size(); k-- > 1;) sum = sum * Rationals(x) + of_g.polynomial[k];
        return sum;
      };
      const Rationals below = at(gamma.low), above = at(gamma.high);
      if (!(below.positive() && above.negative()) && !(below.negative() && above.positive()))
        throw std::runtime_error("an eigenvalue that is not isolated");
      const std::vector<Rationals> gap = of_g.eigenvector(gamma);
      const auto time_of = [&](std::size_t k) {
        Rationals sum(0);
        for (std::size_t i = 0; i < gaps; ++i) sum = sum + times[k % n][i] * gap[i];
        return sum;
      };
      Rationals period = time_of(n - 1);
      const Rationals sign(Rational(period.negative() ? -1 : 1));
      bool all = true;
      for (std::size_t k = 0; k < n && all; ++k) {
        for (std::size_t j = k + 1; j <= k + n && all; ++j) {
          if (!words::touch(word[k], word[j % n])) continue;
          const Rationals later = j < n ? time_of(j) : period + gamma / lambda * time_of(j);
          const Rationals between = sign * (later - time_of(k));
          if (!between.positive() && !between.negative()) throw std::runtime_error("times that may be the same");
          all = between.positive();
        }
      }
      if (all) return true;
    }
  }
  return false;
}

}  // namespace cradle::test
