// Double-double arithmetic against 120 digits of MPFR. Proves the bounds of Joldes, Muller, Popescu, ACM TOMS 44
// (2017), doi 10.1145/3121432, and for the root of Lefevre, Louvet, Muller, Picot, Rideau, ACM TOMS 49 (2023),
// doi 10.1145/3568672 (25/8 u^2; ours forms the remainder more accurately), over random operands of equal, different
// and cancelling sizes. Bounds hold from both sides: operands that never come near one would not be testing it. The
// largest errors these papers report are 2.25, 3.9 and 8.5 u^2 for sum, product and quotient; by chance alone errors
// must be found beyond half the bound, a quarter for the quotient. u = 2^-53.
#ifdef CRADLE_WITH_MPFR

#include <gtest/gtest.h>

#include <boost/multiprecision/mpfr.hpp>

#include <algorithm>
#include <functional>
#include <random>

#include "cradle/precision/double_double.hpp"

namespace cradle::test::double_double_test {

using Limits = std::numeric_limits<double_double>;
__extension__ using Wide = __int128;

constexpr double u = 0x1p-53;

using Exact =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<120>, boost::multiprecision::et_off>;
Exact exact(const double_double& x) { return Exact(x.high()) + Exact(x.low()); }

class RandomOperands {
 public:
  explicit RandomOperands(std::uint64_t seed) : random_(seed) {}

  double significand() { return 1 + static_cast<double>(random_() >> 12) * 0x1p-52; }
  double sign() { return random_() & 1 ? 1 : -1; }
  int between(int low, int high) { return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1)); }

  // The low part fills its half unit, or is smaller by up to 60 bits, or is not there.
  double_double number(int exponent) {
    const double high = std::ldexp(sign() * significand(), exponent);
    const int smaller = random_() & 1 ? 0 : between(0, 60);
    const double low = between(0, 9) == 0 ? 0 : std::ldexp(sign() * significand(), exponent - 54 - smaller);
    return double_double::sum(high, low);
  }
  // Equal up to the last bits of the high part, or of the low one.
  double_double nearly(const double_double& x) {
    const double unit = std::ldexp(x.high(), random_() & 1 ? -52 : -100);
    return x + double_double(unit * between(-8, 8)) + double_double(std::ldexp(sign() * significand() * unit, -40));
  }

 private:
  std::mt19937_64 random_;
};

// In units of u^2 relative to the exact result.
double error_of(const double_double& result, const Exact& expected) {
  EXPECT_LE(std::abs(result.low()), std::abs(result.high()) * u) << "not normalised";
  EXPECT_EQ(result.high() + result.low(), result.high()) << "not normalised";
  EXPECT_TRUE(expected != 0 || result.high() == 0);
  return expected == 0 ? 0 : std::abs(static_cast<double>(Exact((exact(result) - expected) / expected))) / (u * u);
}

constexpr int pairs = 200000;

// `operation` is the same for exact numbers. Exponents are the same for both operands, or independent where they are
// wide; or the second one is within the width of the significands of the first, where parts overlap.
enum class Operands { alike, wide, overlapping, cancelling };
template <class Operation> double worst_of(std::uint64_t seed, int spread, Operands kind, Operation operation) {
  RandomOperands random(seed);
  double worst = 0;
  for (int k = 0; k < pairs && !testing::Test::HasFailure(); ++k) {
    const int exponent = random.between(-spread, spread);
    const double_double x = random.number(exponent);
    const double_double y = kind == Operands::cancelling    ? random.nearly(x)
                            : kind == Operands::wide        ? random.number(random.between(-spread, spread))
                            : kind == Operands::overlapping ? random.number(random.between(-110, 110))
                                                            : random.number(exponent);
    worst = std::max(worst, error_of(operation(x, y), operation(exact(x), exact(y))));
  }
  testing::Test::RecordProperty("largest error in u^2", std::to_string(worst));
  return worst;
}

constexpr std::plus<> plus;
constexpr std::minus<> minus;
constexpr std::multiplies<> times;
constexpr std::divides<> over;
const auto root = []<class T>(const T& x, const T&) { return sqrt(x < T(0) ? T(-x) : x); };

// Over operands of like and of any size; by chance alone errors reach so much.
template <class Operation>
void expect_within(double bound, double reached, std::uint64_t seed, const Operation& operation) {
  const double near = worst_of(seed, 3, Operands::alike, operation);
  EXPECT_LE(near, bound);
  EXPECT_GE(near, reached);
  EXPECT_LE(worst_of(seed + 1, 450, Operands::wide, operation), bound) << "wide exponents";
}

TEST(DoubleDouble, SumIsWithinThreeSquaredUnits) {
  const double near = worst_of(1, 3, Operands::alike, plus);
  EXPECT_LE(near, 3 + 13 * u);
  EXPECT_LE(worst_of(2, 450, Operands::wide, plus), 3 + 13 * u) << "wide exponents";
  const double overlapping = worst_of(3, 0, Operands::overlapping, plus);
  EXPECT_LE(overlapping, 3 + 13 * u);
  EXPECT_GE(std::max(near, overlapping), 1.5);
}

TEST(DoubleDouble, CancellingDifferenceIsWithinTheBoundToo) {
  EXPECT_LE(worst_of(4, 400, Operands::cancelling, minus), 3 + 13 * u);
}

TEST(DoubleDouble, ProductIsWithinFourSquaredUnits) { expect_within(4, 2, 5, times); }

TEST(DoubleDouble, QuotientIsWithinFifteenSquaredUnits) {
  expect_within(15 + 56 * u, 15. / 4, 7, over);
  EXPECT_LE(worst_of(9, 400, Operands::cancelling, over), 15 + 56 * u) << "quotients near 1";
}

TEST(DoubleDouble, RootIsWithinThreeSquaredUnits) {
  expect_within(25. / 8, 25. / 16, 10, root);
  EXPECT_EQ(sqrt(double_double(0)), double_double(0));
  EXPECT_EQ(sqrt(double_double(9)), double_double(3));
  EXPECT_TRUE(std::isnan(sqrt(double_double(-1)).high()));
}

// Down to min() no part of a product that matters underflows.
TEST(DoubleDouble, BoundsHoldDownToTheLeastNormalNumber) {
  RandomOperands random(12);
  double of_products = 0, of_quotients = 0;
  for (int k = 0; k < 100000 && !HasFailure(); ++k) {
    const int exponent = random.between(-400, 400);
    const double_double x = random.number(exponent), y = random.number(-968 - exponent),
                        z = random.number(968 + exponent);
    of_products = std::max(of_products, error_of(x * y, exact(x) * exact(y)));
    const Exact quotient = exact(x) / exact(z);
    if (!(abs(quotient) >= 0x1p-969)) continue;  // or a quotient by more than there is
    of_quotients = std::max(of_quotients, error_of(x / z, quotient));
  }
  EXPECT_LE(of_products, 4 + 1);  // and what the error term itself loses below 2^-1074
  EXPECT_LE(of_quotients, 15 + 1);
}

TEST(DoubleDouble, IntegersAreExact) {
  std::mt19937_64 random(13);
  const auto wide = [](const double_double& x) { return static_cast<Wide>(x.high()) + static_cast<Wide>(x.low()); };
  for (int k = 0; k < 200000; ++k) {
    const auto i = static_cast<std::int64_t>(random()) >> (random() % 60), j = static_cast<std::int64_t>(random());
    const double_double x(i), y(j);
    ASSERT_TRUE(wide(x) == i && wide(y) == j) << i << ' ' << j;
    ASSERT_TRUE(wide(x + y) == Wide{i} + j) << i << ' ' << j;
    ASSERT_TRUE(wide(x - y) == Wide{i} - j) << i << ' ' << j;
    const std::int64_t a = i >> 12, b = j >> 12;  // 52 bits each: the product has 104
    ASSERT_TRUE(wide(double_double(a) * double_double(b)) == Wide{a} * b) << a << ' ' << b;
  }
  for (const std::int64_t i : {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(),
                               (std::int64_t{1} << 53) + 1, std::int64_t{0}})
    EXPECT_TRUE(wide(double_double(i)) == i) << i;
}

TEST(DoubleDouble, OrderIsThatOfTheNumbers) {
  RandomOperands random(14);
  for (int k = 0; k < 200000; ++k) {
    const double_double x = random.number(0);
    const double_double y = k % 3 == 0 ? random.nearly(x) : k % 3 == 1 ? random.number(0) : x;
    const int order = exact(x).compare(exact(y));
    ASSERT_EQ(x < y, order < 0);
    ASSERT_EQ(x == y, order == 0);
    ASSERT_EQ(x > y, order > 0);
    ASSERT_EQ(x <= y, order <= 0);
    ASSERT_EQ(y<x, order> 0);
    ASSERT_EQ(is_negative(x - y), order < 0);
    ASSERT_EQ(is_positive(x - y), order > 0);
  }
  EXPECT_EQ(double_double(0), -double_double(0));
  EXPECT_FALSE(is_negative(-double_double(0)) || is_positive(-double_double(0)));
  EXPECT_FALSE(Limits::quiet_NaN() == Limits::quiet_NaN());
  EXPECT_GT(Limits::infinity(), Limits::max());
}

// As in every type: scalars_test.cpp.
TEST(DoubleDouble, LimitsAreWhatOperationsKeep) {
  EXPECT_EQ(Limits::epsilon().high(), 4 * u * u);  // a quotient may be off by 15/4 of it
  EXPECT_EQ(Limits::max().high() + Limits::max().low(), Limits::max().high());
  EXPECT_EQ(Limits::max().high(), std::numeric_limits<double>::max());
  EXPECT_TRUE(std::isinf(Limits::max().high() + std::ldexp(1, 970))) << "there is a larger one";
}

}  // namespace cradle::test::double_double_test

#endif
