#pragma once
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

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/certify/enclosing.hpp"
#include "cradle/core/words/linear.hpp"
#include "cradle/core/words/maps.hpp"

namespace cradle::words {

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
