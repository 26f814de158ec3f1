// MPFR held in place. Proves: operations of Mpfr<Limbs> give the bits of mpfr_t of the same precision, also where
// operands and result are one object; the leading digits read off the limbs are those of mpfr_get_d_2exp; copies are
// numbers of their own, however they are moved about in memory; zeros and signs are right; saved numbers come back.
#ifdef CRADLE_WITH_MPFR

#include <random>

#include "cradle/core/base/state.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::mpfr_test {

// An mpfr_t of the working precision, as the library's own functions know it.
class Plain {
 public:
  Plain() { mpfr_init2(value, MpfrPrecision::bits()); }
  Plain(const Plain&) = delete;
  Plain& operator=(const Plain&) = delete;
  ~Plain() { mpfr_clear(value); }
  mpfr_t value;
};

bool same(mpfr_srcptr a, mpfr_srcptr b) {
  if (mpfr_signbit(a) != mpfr_signbit(b)) return false;
  return (mpfr_nan_p(a) && mpfr_nan_p(b)) || mpfr_equal_p(a, b);
}

template <class T> class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : random_(seed) {}

  // All bits random, exponents of a few units (so that sums cancel) or far beyond double's.
  T operator()() {
    T x(0);
    for (long bits = 0; bits < MpfrPrecision::bits(); bits += 40)
      x = (x + T(static_cast<std::int64_t>(random_() >> 24))) / T(std::int64_t{1} << 40);
    const std::uint64_t spread = random_() % 4 == 0 ? 100000 : 3;
    x = ldexp(x, static_cast<long>(random_() % (2 * spread)) - static_cast<long>(spread));
    return random_() & 1 ? T(-x) : x;
  }

 private:
  std::mt19937_64 random_;
};

template <class P> using MpfrInPlace = InPrecision<P>;
using Sizes =
    Joined<EveryMpfr, testing::Types<Precision<Mpfr<4>, 76>, Precision<Mpfr<8>, 50>, Precision<Mpfr<8>, 100>>>::Types;
TYPED_TEST_SUITE(MpfrInPlace, Sizes);  // by number: two have 50 digits

PRECISION_TEST(MpfrInPlace, OperationsHaveTheBitsOfTheLibrary) {
  RandomNumbers<T> random(1);
  Plain expected;
  for (int k = 0; k < 5000; ++k) {
    const T x = random();
    const T y = k % 5 == 0 ? T(-x + x * std::numeric_limits<T>::epsilon()) : random();
    const auto check = [&](const T& result, const T& in_place, auto operation) {
      operation(expected.value, x.get(), y.get(), MPFR_RNDN);
      return same(result.get(), expected.value) && same(in_place.get(), expected.value);
    };
    T sum = x, difference = x, product = x, quotient = x;
    ASSERT_TRUE(check(x + y, sum += y, mpfr_add)) << k;
    ASSERT_TRUE(check(x - y, difference -= y, mpfr_sub)) << k;
    ASSERT_TRUE(check(x * y, product *= y, mpfr_mul)) << k;
    ASSERT_TRUE(check(x / y, quotient /= y, mpfr_div)) << k;
    mpfr_neg(expected.value, x.get(), MPFR_RNDN);
    ASSERT_TRUE(same((-x).get(), expected.value)) << k;
    mpfr_sqrt(expected.value, x.get(), MPFR_RNDN);
    ASSERT_TRUE(same(sqrt(x).get(), expected.value)) << k;
    const int order = mpfr_cmp(x.get(), y.get());
    ASSERT_TRUE((x < y) == (order < 0) && (x > y) == (order > 0) && (x == y) == (order == 0) &&
                (x <= y) == (order <= 0));
    ASSERT_TRUE(is_negative(x) == (mpfr_sgn(x.get()) < 0) && is_positive(x) == (mpfr_sgn(x.get()) > 0));
    ASSERT_EQ(static_cast<double>(x), mpfr_get_d(x.get(), MPFR_RNDN));
  }
}

PRECISION_TEST(MpfrInPlace, OperandAndResultMayBeOneObject) {
  RandomNumbers<T> random(2);
  for (int k = 0; k < 500; ++k) {
    const T x = random();
    T twice = x, nothing = x, square = x, one = x, itself = x;
    const T& alias = itself;
    EXPECT_TRUE((twice += twice) == x + x);
    EXPECT_TRUE((nothing -= nothing) == T(0));
    EXPECT_TRUE((square *= square) == x * x);
    EXPECT_TRUE((one /= one) == T(1));
    EXPECT_TRUE((itself = alias) == x);
  }
}

// A conversion rounds to nearest, the reading of the limbs cuts off at 2^-53 of 1: one unit apart at most.
PRECISION_TEST(MpfrInPlace, LeadingDigitsAreThoseOfTheLibrary) {
  RandomNumbers<T> random(3);
  for (int k = 0; k < 5000; ++k) {
    const T x = k == 0 ? T(1) : k == 1 ? T(T(1) - std::numeric_limits<T>::epsilon() / T(2)) : random();
    if (x == T(0)) continue;
    long exponent = 0, expected_exponent = 0;
    const double mantissa = split(x, exponent);
    const double expected = mpfr_get_d_2exp(&expected_exponent, x.get(), MPFR_RNDN);
    ASSERT_GE(std::abs(mantissa), 0.5);
    ASSERT_LE(std::abs(mantissa), 1);
    ASSERT_LE(std::abs(expected_exponent - exponent), 1);
    const double scaled = std::ldexp(expected, static_cast<int>(expected_exponent - exponent));
    ASSERT_LE(std::abs(mantissa - scaled), 0x1p-53) << k;
  }
  long exponent = 1;
  EXPECT_EQ(split(T(0), exponent), 0);
  EXPECT_EQ(exponent, 0);
  EXPECT_EQ(split(T(-T(0)), exponent), 0);
}

PRECISION_TEST(MpfrInPlace, CopiesAreNumbersOfTheirOwn) {
  RandomNumbers<T> random(4);
  const T x = random(), y = random();
  T copy = x, assigned;
  assigned = y;
  EXPECT_TRUE(copy == x && assigned == y);
  copy += x;
  EXPECT_TRUE(copy == x + x && copy != x);
  std::swap(copy, assigned);
  EXPECT_TRUE(copy == y && assigned == x + x);
  EXPECT_NE(copy.get()->_mpfr_d, y.get()->_mpfr_d);

  // A growing vector moves its elements, sorting swaps them.
  std::vector<T> numbers;
  for (int k = 0; k < 200; ++k) numbers.push_back(T(k) * x);
  std::sort(numbers.begin(), numbers.end());
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(numbers[static_cast<std::size_t>(k)] == T(x > T(0) ? k : 199 - k) * x) << k;
  const std::vector<T> others = numbers;
  numbers.assign(200, T(0));
  EXPECT_TRUE(others[x > T(0) ? 7 : 192] == T(7) * x);
}

PRECISION_TEST(MpfrInPlace, ZerosAndIntegers) {
  const T zero(0), minus_zero = -zero;
  EXPECT_TRUE(zero == T(0) && minus_zero == zero);
  EXPECT_FALSE(is_negative(minus_zero) || is_positive(minus_zero) || is_negative(zero) || is_positive(zero));
  EXPECT_TRUE(T(3) - T(3) == zero && zero * T(-5) == zero);
  for (const std::int64_t i : {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(),
                               std::int64_t{-1}, (std::int64_t{1} << 53) + 1}) {
    Plain expected;
    mpfr_set_sj(expected.value, i, MPFR_RNDN);
    EXPECT_TRUE(same(T(i).get(), expected.value)) << i;
    EXPECT_EQ(mpfr_get_sj(T(i).get(), MPFR_RNDN), i);
  }
  EXPECT_EQ(static_cast<double>(T(-0.1)), -0.1);
}

PRECISION_TEST(MpfrInPlace, SavedNumbersComeBackAndKindsThatThereAreNotAreRefused) {
  const T infinite = std::numeric_limits<T>::infinity(), none = std::numeric_limits<T>::quiet_NaN();
  T loaded;
  for (const T& x : {T(0), T(-T(0)), T(3), T(-0.1), infinite, T(-infinite), none}) {
    SavedState state = SavedState::of(x);
    load(state, loaded);
    EXPECT_TRUE(same(loaded.get(), x.get()) && state.left() == 0) << to_double(x);
  }
  std::string bytes = SavedState::of(T(0)).bytes();
  bytes[0] = 4;
  SavedState damaged(bytes);
  EXPECT_THROW(load(damaged, loaded), std::invalid_argument);
}

}  // namespace cradle::test::mpfr_test

#endif
