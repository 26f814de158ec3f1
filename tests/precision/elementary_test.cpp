// The exponential and the power that laws use, and the law made of them, in every scalar type. Proves: both have the
// digits of the type, against MPFR with 4400 bits, down to arguments at which 1 - exp(-y) would cancel; exact
// cases are exact; the law's loss is that of its restitution to all digits however elastic a collision is, its shares
// are exactly what the pair loses, and its limits are the plain law's.
#include "cradle/core/base/elementary.hpp"

#include "cradle/core/laws/law.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::elementary_test {

PRECISION_SUITE(Elementary, EveryPrecision);

template <class T> T epsilon() { return T(std::numeric_limits<T>::epsilon()); }
template <class T> void expect_close(const T& a, const T& b, double units, const char* what, double at) {
  EXPECT_TRUE(magnitude(T(a - b)) <= T(static_cast<int>(units)) * epsilon<T>() * magnitude(b))
      << what << " at " << at << ": " << to_double(a) << " against " << to_double(b) << ", off by "
      << to_double(T(magnitude(T(a / b - T(1))) / epsilon<T>())) << " units";
}

// Identities need no other library: E(a + b) = E(a) + E(b) - E(a) E(b), by terms that are all positive once written as
// E(a) (1 - E(b)) + E(b).
PRECISION_TEST(Elementary, RiseObeysItsAdditionTheorem) {
  const ExponentialRise<T> rise;
  T a = T(1) / T(1 << 30);
  for (int k = 0; k < 70; ++k, a *= T(3) / T(2)) {
    if (a > T(64)) break;
    const T b = a * T(7) / T(8);
    const T sum = rise(a) * (T(1) - rise(b)) + rise(b);
    expect_close<T>(rise(T(a + b)), sum, 64, "rise", to_double(a));
  }
  EXPECT_TRUE(rise(T(0)) == T(0));
  EXPECT_TRUE(rise(T(1000000)) == T(1));
}

// 1 - exp(-y) = y - y^2/2 + ..., at y = 2^-(p/2 + 8) to all digits of a type with p.
PRECISION_TEST(Elementary, RiseIsItsArgumentWhereThatIsSmall) {
  const ExponentialRise<T> rise;
  T y(1);
  while (y * y > epsilon<T>() / T(1 << 16)) y /= T(2);
  expect_close<T>(rise(y), T(y - y * y / T(2)), 4, "rise", to_double(y));
}

PRECISION_TEST(Elementary, PowersMultiplyAndInvert) {
  const Power<T> half(T(T(1) / T(2))), square(T(2)), odd(T(T(5) / T(2))), seventh(T(T(1) / T(7))),
      third(T(T(7) / T(2)));
  for (const int numerator : {1, 3, 17, 255, 4096, 1000003}) {
    for (const int denominator : {1, 7, 1024, 999983}) {
      const T x = T(numerator) / T(denominator);
      const double at = to_double(x);
      expect_close<T>(T(half(x) * half(x)), x, 128, "root", at);
      EXPECT_TRUE(square(x) == x * x);
      expect_close<T>(odd(x), T(x * x * half(x)), 256, "5/2", at);
      expect_close<T>(T(third(x) * odd(x)), T(x * x * x * x * x * x), 512, "7/2 + 5/2", at);
      T product(1);
      for (int k = 0; k < 7; ++k) product *= seventh(x);
      expect_close<T>(product, x, 512, "1/7", at);
    }
  }
  EXPECT_TRUE(odd(T(0)) == T(0));
  EXPECT_TRUE(odd(T(1)) == T(1));
}

#ifdef CRADLE_WITH_MPFR
// In units of the type's epsilon.
template <class T> double off(const T& x, const Reference& exact) {
  return static_cast<double>(abs((reference(x) - exact) / (exact * reference(epsilon<T>()))));
}

PRECISION_TEST(Elementary, IsMpfrsToTheDigitsOfTheType) {
  const ExponentialRise<T> rise;
  const T s = T(27) / T(10);
  const Power<T> power(s);
  double worst_rise = 0, worst_power = 0;
  T y = T(1) / T(std::int64_t{1} << 40);
  for (int k = 0; k < 46; ++k, y = y * T(2) + y * T(k) / T(1000)) {
    worst_rise = std::max(worst_rise, off<T>(rise(y), -expm1(Reference(-reference(y)))));
    worst_power = std::max(worst_power, off<T>(power(y), pow(reference(y), reference(s))));
  }
  EXPECT_GT(worst_power, 0);
  EXPECT_LT(worst_rise, 32);   // roundings of up to twenty doublings, damped
  EXPECT_LT(worst_power, 84);  // |u| <= 2.7 ln 2^40 = 75, and 8
}
#endif

PRECISION_TEST(Elementary, LawKeepsTheDigitsOfItsLoss) {
  const T eps = T(1) / T(4), delta = T(1) / T(8), mass(3), light(1);
  const SpeedDependent<T> law(eps, delta, T(3));
  const ExponentialRise<T> rise;
  T w = delta / T(1 << 20);
  for (int k = 0; k < 60; ++k, w *= T(3) / T(2)) {
    const Outcome<T> outcome = law(w, TwoMasses<T>{light, mass});
    const T ratio = w / delta, missing = (T(1) - eps) * rise(T(ratio * ratio * ratio));
    const T loss = missing * (T(2) - missing) / T(2) * (T(3) / T(4)) * w * w;
    expect_close<T>(outcome.energy_lost, loss, 16, "loss", to_double(w));
    EXPECT_TRUE(outcome.closing <= T(0));
    EXPECT_TRUE(outcome.below_cutoff == (w < delta));
    expect_close<T>(T(outcome.to_left + outcome.to_right), T(w - outcome.closing), 2, "shares", to_double(w));
    expect_close<T>(T(outcome.to_left), T(outcome.to_right * T(3)), 4, "momentum", to_double(w));
  }
}

// Very fast and very slow collisions, 2^9 and 2^-64 times the cut-off, are those of the plain law above and below it.
PRECISION_TEST(Elementary, LawHasThePlainOneAsItsLimits) {
  const T mass(1), half = mass / T(2), delta = T(1) / T(8);
  for (const T& eps : {T(T(1) / T(4)), T(T(7) / T(8)), T(0), T(1)}) {
    const Inelastic<T> plain(eps, delta);
    for (const T& w : {T(delta / T(std::int64_t{1} << 60) / T(16)), T(64)}) {
      const SpeedDependent<T> law(eps, delta, T(60));
      const Outcome<T> a = law(w, EqualMasses<T>{mass, half}), b = plain(w, EqualMasses<T>{mass, half});
      EXPECT_TRUE(magnitude(T(a.closing - b.closing)) <= T(2) * epsilon<T>() * w);
      EXPECT_TRUE(magnitude(T(a.energy_lost - b.energy_lost)) <= T(8) * epsilon<T>() * w * w);
      EXPECT_EQ(a.below_cutoff, b.below_cutoff);
    }
  }
}

}  // namespace cradle::test::elementary_test
