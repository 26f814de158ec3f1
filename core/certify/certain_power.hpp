#pragma once
// exp(-y) and y exp(-y), y = x^s, of numbers with enclosures: what the restitution of the closing speed is made of
// (certain_law.hpp). It shares no code with the engine's own functions (base/elementary.hpp).
//
//   exp(-y)   in the middle of y, h = y 2^-k <= 1/8: Taylor's series, whose terms alternate and fall, so that what is
//             left out is less than the first term left out; then k squares. Elsewhere in y, up to r away, it differs
//             by at most exp(-y) (exp(r) - 1), and exp(r) - 1 <= r + r^2 for r <= 1. Where y is certainly above n,
//             2^-n the epsilon of the numbers, 0 <= exp(-y) < 2^-n and 0 <= y exp(-y) < n 2^-n.
//   x^s       whole s: products. Else exp(s ln x), ln x = n ln 2 + 2 artanh((m - 1)/(m + 1)) in the middle of x, m =
//             2^-n x between 0.7 and 1.5, and up to r/(least x) more or less in all of x. Of the series for artanh z,
//             |z| <= 1/3, less than 9^-j |z| is left out after j terms.

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "cradle/core/certify/enclosing.hpp"

namespace cradle {

template <Enclosing N> class CertainFall {
  using Radius = decltype(std::declval<const N&>().radius());

 public:
  // exp(-y), and times y.
  struct Values {
    N fall, weighted;
  };

  // s > 0.
  explicit CertainFall(const N& exponent) : exponent_(exponent), epsilon_(N(std::numeric_limits<N>::epsilon()).size()) {
    for (int n = 1; n <= most_products; ++n)
      if (exponent == N(n)) whole_ = n;
    far_ = -std::ilogb(epsilon_);
    left_out_ = 1;
    for (int n = 1; !(left_out_ < epsilon_); ++n) {
      reciprocals_.push_back(N(1) / N(n));
      left_out_ /= 7 * static_cast<Radius>(n);
    }
    if (whole_ > 0) return;
    Radius left_out = 1;
    for (int n = 0; !(left_out < epsilon_); ++n, left_out /= 9) odd_.push_back(N(1) / N(2 * n + 1));
    ln2_ = artanh(N(1) / N(3)) * N(2);
  }

  // x > 0, certainly.
  Values operator()(const N& x) const {
    if (!is_finite(x)) return {open(), open()};
    const Values beyond{N::widened(N(0), epsilon_), N::widened(N(0), epsilon_ * static_cast<Radius>(far_))};
    N y(0);
    if (whole_ > 0) {
      if (N(far_) < x) return beyond;
      y = product(x);
    } else {
      const N power = exponent_ * logarithm(x);
      if (N(static_cast<int>(std::log(far_)) + 2) < power) return beyond;
      y = below_zero(power) ? fall(-power) : N(1) / fall(power);
    }
    if (N(far_) < y) return beyond;
    const N falling = fall(y);
    return {falling, y * falling};
  }

 private:
  static constexpr int most_products = 64;

  static N open() { return N::widened(N(0), std::numeric_limits<Radius>::infinity()); }
  static bool below_zero(const N& x) { return is_negative(N(x.middle(), 0)); }

  N product(N base) const {
    N result(1);
    for (int n = whole_; n > 0; n /= 2) {
      if (n % 2 != 0) result *= base;
      if (n > 1) base *= base;
    }
    return result;
  }

  // exp(-y); what is infinitely uncertain where y is by more than 1.
  N fall(const N& y) const {
    if (N(far_) < y) return N::widened(N(0), epsilon_);
    const N middle = below_zero(y) ? N(0) : N(y.middle(), 0);
    const Radius off = below_zero(y) ? y.size() : y.radius();
    double size = to_double(middle);
    if (!(off <= 1 && size < 2. * far_)) return open();
    int squares = 0;
    for (; size > 0.125; size /= 2) ++squares;
    const N h = middle * N(std::ldexp(1., -squares));
    N value(1);  // 1 - h (1 - h/2 (1 - h/3 (...)))
    for (std::size_t n = reciprocals_.size() - 1; n-- > 0;) value = N(1) - h * reciprocals_[n] * value;
    value = N::widened(value, left_out_);
    for (; squares > 0; --squares) value *= value;
    return N::widened(value, value.size() * (off + off * off));
  }

  N logarithm(const N& x) const {
    N mantissa(x.middle(), 0);
    int exponent = 0, of_near = 0;
    double near = to_double(mantissa);
    for (; near < 0x1p-900; near = to_double(mantissa)) mantissa *= N(0x1p900), exponent -= 900;
    for (; near > 0x1p900; near = to_double(mantissa)) mantissa *= N(0x1p-900), exponent += 900;
    if (std::frexp(near, &of_near) < 0.7) --of_near;
    mantissa *= N(std::ldexp(1., -of_near));
    const N value = N(exponent + of_near) * ln2_ + artanh((mantissa - N(1)) / (mantissa + N(1))) * N(2);
    return N::widened(value, x.radius() / x.least_size());
  }
  N artanh(const N& z) const {
    const N square = z * z;
    N sum(0);
    for (std::size_t n = odd_.size(); n-- > 0;) sum = sum * square + odd_[n];
    return N::widened(z * sum, epsilon_);
  }

  N exponent_;
  int whole_ = 0;  // s, if it is a whole number and not too large
  Radius epsilon_;
  int far_ = 0;                 // n: beyond it exp(-y) is less than epsilon
  std::vector<N> reciprocals_;  // 1, 1/2, ...
  Radius left_out_ = 0;         // of the series for exp(-h)
  std::vector<N> odd_;          // 1, 1/3, ...
  N ln2_{0};
};

}  // namespace cradle
