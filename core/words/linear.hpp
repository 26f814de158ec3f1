#pragma once
// Linear algebra of a few dimensions (as many as there are gaps) in any Real: characteristic polynomials, their real
// roots, solutions of linear equations, whether all roots lie within the unit circle, eigenpairs.

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/base/planted_error.hpp"
#include "cradle/core/base/real.hpp"
#include "cradle/core/certify/enclosing.hpp"

namespace cradle::words {

template <Real T> class Matrix {
 public:
  explicit Matrix(std::size_t size) : size_(size), entries_(size * size, T(0)) {}

  std::size_t size() const { return size_; }
  T& operator()(std::size_t row, std::size_t column) { return entries_[row * size_ + column]; }
  const T& operator()(std::size_t row, std::size_t column) const { return entries_[row * size_ + column]; }

  friend std::vector<T> operator*(const Matrix& a, const std::vector<T>& x) {
    std::vector<T> y(a.size_, T(0));
    for (std::size_t i = 0; i < a.size_; ++i)
      for (std::size_t k = 0; k < a.size_; ++k) y[i] += a(i, k) * x[k];
    return y;
  }
  friend Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix c(a.size_);
    for (std::size_t i = 0; i < a.size_; ++i)
      for (std::size_t j = 0; j < a.size_; ++j)
        for (std::size_t k = 0; k < a.size_; ++k) c(i, j) += a(i, k) * b(k, j);
    return c;
  }

 private:
  std::size_t size_;
  std::vector<T> entries_;
};

template <Real T> using Polynomial = std::vector<T>;  // from the constant on

template <Real T> T value_at(const Polynomial<T>& p, const T& x) {
  T value(0);
  for (std::size_t k = p.size(); k-- > 0;) value = value * x + p[k];
  return value;
}

// det(x - A), by Faddeev and LeVerrier: divisions by 1, 2, ... only.
template <Real T> Polynomial<T> characteristic_polynomial(const Matrix<T>& a) {
  const std::size_t n = a.size();
  Polynomial<T> p(n + 1, T(0));
  p[n] = T(1);
  Matrix<T> m(n);
  for (std::size_t k = 1; k <= n; ++k) {
    if (k > 1) m = a * m;
    for (std::size_t i = 0; i < n; ++i) m(i, i) += p[n - k + 1];
    const Matrix<T> product = a * m;
    T trace(0);
    for (std::size_t i = 0; i < n; ++i) trace += product(i, i);
    p[n - k] = -trace / T(static_cast<int>(k));
  }
  return p;
}

// p(z)/(z - root), for a root.
template <Real T> Polynomial<T> without_root(const Polynomial<T>& p, const T& root) {
  Polynomial<T> quotient(p.size() - 1, T(0));
  T carried(0);
  for (std::size_t k = p.size() - 1; k > 0; --k) quotient[k - 1] = carried = p[k] + root * carried;
  return quotient;
}

template <Real T> Polynomial<T> derivative(const Polynomial<T>& p) {
  Polynomial<T> result(p.size() - 1, T(0));
  for (std::size_t k = 1; k < p.size(); ++k) result[k - 1] = p[k] * T(static_cast<int>(k));
  return result;
}

// The roots in (low, high) where p changes its sign, in rising order: one lies between two that the derivative has.
template <Real T> std::vector<T> real_roots(const Polynomial<T>& p, const T& low, const T& high) {
  if (p.size() < 2) return {};
  std::vector<T> ends{low}, roots;
  for (const T& turn : real_roots(derivative(p), low, high)) ends.push_back(turn);
  ends.push_back(high);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    T a = ends[k], b = ends[k + 1];
    const bool below = is_negative(value_at(p, a));
    if (below == is_negative(value_at(p, b))) continue;
    for (T middle = (a + b) / T(2); a < middle && middle < b; middle = (a + b) / T(2))
      (is_negative(value_at(p, middle)) == below ? a : b) = middle;
    roots.push_back(b);
  }
  return roots;
}

// Where the largest number is, in rows and columns from `from` on.
template <Real T>
std::pair<std::size_t, std::size_t> largest(const Matrix<T>& a, std::size_t from, std::size_t columns) {
  std::pair<std::size_t, std::size_t> best{from, from};
  for (std::size_t i = from; i < a.size(); ++i)
    for (std::size_t k = from; k < from + columns; ++k)
      if (magnitude(a(best.first, best.second)) < magnitude(a(i, k))) best = {i, k};
  return best;
}

// The inverse, by elimination with pivots; of no use (infinite) if there is none.
template <Real T> Matrix<T> inverse(Matrix<T> a) {
  const std::size_t n = a.size();
  Matrix<T> result(n);
  for (std::size_t i = 0; i < n; ++i) result(i, i) = T(1);
  for (std::size_t at = 0; at < n; ++at) {
    const std::size_t pivot = largest(a, at, 1).first;
    for (std::size_t k = 0; k < n; ++k) std::swap(a(at, k), a(pivot, k)), std::swap(result(at, k), result(pivot, k));
    const T scale = T(1) / a(at, at);
    for (std::size_t k = 0; k < n; ++k) a(at, k) *= scale, result(at, k) *= scale;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == at) continue;
      const T factor = a(i, at);
      for (std::size_t k = 0; k < n; ++k) a(i, k) -= factor * a(at, k), result(i, k) -= factor * result(at, k);
    }
  }
  return result;
}

// A vector that A - root maps nearly to 0, for an eigenvalue known nearly: by elimination with full pivots.
template <Real T> std::vector<T> null_vector(Matrix<T> a, const T& root) {
  const std::size_t n = a.size();
  std::vector<std::size_t> column(n);
  for (std::size_t i = 0; i < n; ++i) column[i] = i, a(i, i) -= root;
  for (std::size_t at = 0; at + 1 < n; ++at) {
    const auto [row, place] = largest(a, at, n - at);
    for (std::size_t k = 0; k < n; ++k) std::swap(a(at, k), a(row, k));
    for (std::size_t i = 0; i < n; ++i) std::swap(a(i, at), a(i, place));
    std::swap(column[at], column[place]);
    if (a(at, at) == T(0)) break;
    for (std::size_t i = at + 1; i < n; ++i) {
      const T factor = a(i, at) / a(at, at);
      for (std::size_t k = at; k < n; ++k) a(i, k) -= factor * a(at, k);
    }
  }
  std::vector<T> x(n, T(0));
  x[column[n - 1]] = T(1);
  for (std::size_t at = n - 1; at-- > 0;) {
    T sum(0);
    for (std::size_t k = at + 1; k < n; ++k) sum += a(at, k) * x[column[k]];
    x[column[at]] = a(at, at) == T(0) ? T(0) : T(-sum / a(at, at));
  }
  return x;
}

enum class Within { yes, no, open };

// Whether all roots, also complex ones, lie within the unit circle: the recursion of Schur and Cohn.
template <Real T> Within roots_within_unit_circle(Polynomial<T> p) {
  while (p.size() > 1) {
    const std::size_t n = p.size() - 1;
    const T margin = (p[n] - p[0]) * (p[n] + p[0]);
    if (is_negative(margin)) return Within::no;
    if (!is_positive(margin)) return Within::open;
    Polynomial<T> next(n, T(0));
    for (std::size_t k = 1; k <= n; ++k) next[k - 1] = (p[n] * p[k] - p[0] * p[n - k]) / margin;
    p = std::move(next);
  }
  return Within::yes;
}

// p(scale z)
template <Real T> Polynomial<T> scaled(Polynomial<T> p, const T& scale) {
  T power(1);
  for (T& coefficient : p) coefficient *= power, power *= scale;
  return p;
}

// The largest modulus of a root, rounded up, to a relative error of 2^-60; 2^-400 of the bound below if it is smaller.
template <Real T> T largest_modulus(const Polynomial<T>& p) {
  if (p.size() < 2) return T(0);
  T low(0), high(0);
  for (const T& coefficient : p) high += magnitude(T(coefficient / p.back()));
  for (int i = 0; i < 400 && high < (high - low) * T(std::int64_t{1} << 60); ++i) {
    const T middle = (low + high) / T(2);
    (roots_within_unit_circle(scaled(p, middle)) == Within::yes ? high : low) = middle;
  }
  return high;
}

// Eigenpairs A x = mu x with one component of x held at 1: nearly, by Newton's method, and enclosed, by Krawczyk's
// (R. Krawczyk, Computing 4, 187, 1969; for eigenpairs S. M. Rump's survey, Acta Numerica 19, 287, 2010, section 13).
//
// The unknowns are mu and the other components. With F(y) = A x - mu x, its derivative J at an approximation y0, and
// any matrix C near the inverse of J, the differences e = y - y0 of solutions y satisfy, since F is quadratic,
//
//   e = -C F(y0) + (1 - C J) e + C e_mu e_x.
//
// If the right side maps a box into its interior, the box holds exactly one solution: for every matrix A within its
// enclosure, so for every restitution in a ball.
template <Real T> struct Eigenpair {
  std::vector<T> vector;
  T value{0};
  std::size_t fixed = 0;  // the component that is 1
};

// The unknowns in place of the fixed component: its place holds mu.
template <Real T> Matrix<T> derivative(Matrix<T> a, const Eigenpair<T>& pair) {
  for (std::size_t i = 0; i < a.size(); ++i) a(i, i) -= pair.value;
  for (std::size_t i = 0; i < a.size(); ++i) a(i, pair.fixed) = -pair.vector[i];
  return a;
}

template <Real T> std::vector<T> defect(const Matrix<T>& a, const Eigenpair<T>& pair) {
  std::vector<T> f = a * pair.vector;
  for (std::size_t i = 0; i < f.size(); ++i) f[i] -= pair.value * pair.vector[i];
  return f;
}

// Scaled so that the largest component is 1.
template <Real T> Eigenpair<T> eigenpair(std::vector<T> x, const T& value) {
  std::size_t largest = 0;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (magnitude(x[largest]) < magnitude(x[i])) largest = i;
  const T scale = T(1) / x[largest];
  for (T& component : x) component *= scale;
  x[largest] = T(1);
  return {std::move(x), value, largest};
}

// Improves an approximation until a step is smaller than `small`, or for a few steps.
template <Real T> void improve(const Matrix<T>& a, Eigenpair<T>& pair, const T& small) {
  for (int step = 0; step < 12; ++step) {
    const std::vector<T> by = inverse(derivative(a, pair)) * defect(a, pair);
    T size(0);
    for (std::size_t i = 0; i < by.size(); ++i) {
      (i == pair.fixed ? pair.value : pair.vector[i]) -= by[i];
      size += magnitude(by[i]);
    }
    if (!(size > small)) return;
  }
}

// Encloses the eigenpair near an approximation, for all matrices in `a`; none if that is not proved.
template <Enclosing B, Real T>
std::optional<Eigenpair<B>> enclosed(const Matrix<B>& a, const Matrix<T>& middle, const Eigenpair<T>& near) {
  const std::size_t n = a.size(), fixed = near.fixed;
  const auto ball = [](const T& x) { return B(x, 0); };
  Eigenpair<B> pair{std::vector<B>(n), ball(near.value), fixed};
  for (std::size_t i = 0; i < n; ++i) pair.vector[i] = ball(near.vector[i]);
  Matrix<B> c(n), rest(n);
  const Matrix<T> inverse_of_middle = inverse(derivative(middle, near));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) c(i, k) = ball(inverse_of_middle(i, k));
  const Matrix<B> product = c * derivative(a, pair);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) rest(i, k) = B(i == k ? 1 : 0) - product(i, k);
  const std::vector<B> first = c * defect(a, pair);

  // Balls around 0: from those of the first step, enlarged until they are mapped into themselves.
  std::vector<B> box(n);
  for (std::size_t i = 0; i < n; ++i) box[i] = B(T(0), first[i].size() * 2);
  const auto mapped = [&] {
    std::vector<B> quadratic(n, B(0));
    for (std::size_t i = 0; i < n; ++i)
      if (i != fixed) quadratic[i] = box[fixed] * box[i];
    const std::vector<B> linear = rest * box, bent = c * quadratic;
    std::vector<B> image(n);
    for (std::size_t i = 0; i < n; ++i) image[i] = linear[i] + bent[i] - first[i];
    return image;
  };
  for (int attempt = 0; attempt < 8; ++attempt) {
    std::vector<B> image = mapped();
    bool inside = true;
    for (std::size_t i = 0; i < n; ++i) inside = inside && image[i].size() < box[i].radius();
    if (inside || planted(5)) {
      // What the box is mapped into holds the solution too.
      for (int again = 0; again < 2; ++again) {
        for (std::size_t i = 0; i < n; ++i) box[i] = B(T(0), image[i].size());
        image = mapped();
      }
      for (std::size_t i = 0; i < n; ++i) (i == fixed ? pair.value : pair.vector[i]) += image[i];
      return pair;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const auto size = image[i].size() + image[i].size() / 4;
      if (!(size <= std::numeric_limits<decltype(size)>::max())) return {};
      if (box[i].radius() < size) box[i] = B(T(0), size);
    }
  }
  return {};
}

}  // namespace cradle::words
