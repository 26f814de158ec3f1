// Balls enclose: the result of every operation on random balls contains the exact results for the numbers in them,
// above all for their ends; comparisons are certain or open; decimals and doubles are rounded outwards.
#include <boost/multiprecision/cpp_bin_float.hpp>
#ifdef CRADLE_WITH_MPFR
#include <boost/multiprecision/mpfr.hpp>
#endif

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/precision/ball.hpp"
#include "cradle/precision/ball_text.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::ball_test {

template <std::floating_point T> Rational exact(T x) { return Rational(x); }
Rational exact(const double_double& x) { return exactly(x.high()) + exactly(x.low()); }

#ifdef CRADLE_WITH_MPFR
template <int Limbs> Rational exact(const Mpfr<Limbs>& x) {
  return Rational(boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<80>>(x.get()));
}
#endif

using Midpoints = Joined<testing::Types<Precision<double_double>>, Mpfr50>::Types;
PRECISION_SUITE(Balls, Midpoints);

template <class M> struct Draws {
  using B = Ball<M>;
  std::uint64_t next = 0;

  std::uint64_t bits() { return random_bits(17, 0, next++); }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  // Of any size between 2^-40 and 2^40, to the last digit of the midpoint.
  M number() {
    const auto scale = static_cast<int>(bits() % 81) - 40;
    const M x = M(std::ldexp(uniform() + 0.5, scale)) + M(std::ldexp(uniform() - 0.5, scale - 53));
    return bits() % 2 == 0 ? x : M(-x);
  }
  B ball() {
    const M middle = number();
    const double size = std::abs(to_double(middle));
    constexpr std::array<double, 5> widths{0, 0x1p-110, 0x1p-60, 0x1p-10, 0.75};
    return {middle, static_cast<typename B::Radius>(size * widths[bits() % widths.size()])};
  }
  // Numbers in it: the middle and both ends.
  static std::vector<Rational> numbers(const B& x) {
    return {exact(x.middle()), exact(x.middle()) - exact(x.radius()), exact(x.middle()) + exact(x.radius())};
  }
};

template <class M> void expect_holds(const Ball<M>& x, const Rational& number) {
  ASSERT_TRUE(abs(exact(x.middle()) - number) <= exact(x.radius()))
      << to_double(x.middle()) << ", radius " << x.radius();  // rationals may have thousands of digits
}

PRECISION_TEST(Balls, HoldWhatTheOperationsGive) {
  using B = Ball<T>;
  Draws<T> draws;
  std::size_t useful = 0;
  for (int k = 0; k < 1500; ++k) {
    const B x = draws.ball(), y = draws.ball();
    const B sum = x + y, difference = x - y, product = x * y, quotient = x / y;
    for (const Rational& a : draws.numbers(x))
      for (const Rational& b : draws.numbers(y)) {
        expect_holds(sum, a + b);
        expect_holds(difference, a - b);
        expect_holds(product, a * b);
        if (is_finite(quotient)) expect_holds(quotient, Rational(a / b));
      }
    useful += is_finite(quotient);
    // Not wider than they must be: a sum's radius is those of its terms and a rounding.
    EXPECT_LE(exact(sum.radius()), (exact(x.radius()) + exact(y.radius())) * (1 + exact(0x1p-40)) +
                                       abs(exact(sum.middle())) * exact(0x1p-100));
  }
  EXPECT_GT(useful, 1000U);
}

double_double scaled(const double_double& x, int exponent) {
  return double_double::sum(std::ldexp(x.high(), exponent), std::ldexp(x.low(), exponent));
}
#ifdef CRADLE_WITH_MPFR
template <int Limbs> Mpfr<Limbs> scaled(const Mpfr<Limbs>& x, int exponent) { return ldexp(x, exponent); }
#endif

// At the lower end of the range, where terms underflow and are divided by numbers as small.
PRECISION_TEST(Balls, HoldQuotientsAndSumsOfTheLeastNumbers) {
  using B = Ball<T>;
  const int least = std::same_as<T, double_double> ? -1018 : -16390;
  Draws<T> draws;
  for (int k = 0; k < 2000; ++k) {
    const auto exponent = [&] { return least + 41 + static_cast<int>(draws.bits() % 60); };
    const T number = draws.number();
    const int e = exponent();
    const B x(scaled(number, e), 0), y(scaled(draws.number(), exponent()), 0), quotient = x / y;
    if (is_finite(quotient)) expect_holds(quotient, Rational(exact(x.middle()) / exact(y.middle())));
    expect_holds(x + y, exact(x.middle()) + exact(y.middle()));
    expect_holds(x * y, exact(x.middle()) * exact(y.middle()));
    const B around(x.middle(), std::ldexp(static_cast<typename B::Radius>(2 * std::abs(to_double(number))), e));
    EXPECT_FALSE(is_positive(around));
    EXPECT_EQ(order_in_balls(x, x), Order::open);
  }
  EXPECT_EQ(order(B(1), B(1)), Order::open);
  EXPECT_EQ(order(B(0), B(0)), Order::open);
}

PRECISION_TEST(Balls, HoldRoots) {
  using B = Ball<T>;
  Draws<T> draws;
  for (int k = 0; k < 3000; ++k) {
    const B x = draws.ball();
    const B root = sqrt(x);
    if (!is_positive(x)) {
      EXPECT_FALSE(is_finite(root));
      continue;
    }
    const Rational low = exact(root.middle()) - exact(root.radius()),
                   high = exact(root.middle()) + exact(root.radius());
    for (const Rational& a : draws.numbers(x)) {
      ASSERT_TRUE(low < 0 || low * low <= a);
      ASSERT_LE(a, Rational(high * high));
    }
  }
}

PRECISION_TEST(Balls, CombinationsHoldAndDoNotGrow) {
  using B = Ball<T>;
  Draws<T> draws;
  for (int k = 0; k < 500; ++k) {
    const B x = draws.ball(), y = draws.ball();
    const B c(T(draws.uniform()), static_cast<typename B::Radius>(k % 2 == 0 ? 0 : 0x1p-70));
    const typename B::Share share(c);
    const auto [l, r] = B::combined(x, y, x - y, share, k % 4 < 2 ? share : typename B::Share(c));
    for (const Rational& a : draws.numbers(x))
      for (const Rational& b : draws.numbers(y))
        for (const Rational& of : draws.numbers(c)) {
          expect_holds(l, Rational(a - of * (a - b)));
          expect_holds(r, Rational(b + of * (a - b)));
        }
    if (k % 2 != 0) continue;
    // What doubly stochastic collisions rely on: together they are no wider than before, but for roundings.
    const Rational roundings = (abs(exact(x.middle())) + abs(exact(y.middle()))) * exact(0x1p-98);
    EXPECT_LE(exact(l.radius()) + exact(r.radius()),
              (exact(x.radius()) + exact(y.radius())) * (1 + exact(0x1p-40)) + roundings);
  }
}

// x - c(x - y) (x - y) with c(w) = w/8 and a derivative w/4 of c(w) w.
PRECISION_TEST(Balls, SharesThatDependOnADifferenceEnclose) {
  using B = Ball<T>;
  Draws<T> draws;
  const B eighth = B(1) / B(8);
  for (int k = 0; k < 500; ++k) {
    const B x = draws.ball(), y = draws.ball(), apart = x - y;
    const typename B::Share share(B(apart.middle(), 0) * eighth, apart * B(2) * eighth);
    const auto [l, r] = B::combined(x, y, apart, share, share);
    for (const Rational& a : draws.numbers(x))
      for (const Rational& b : draws.numbers(y)) {
        expect_holds(l, Rational(a - (a - b) * (a - b) / 8));
        expect_holds(r, Rational(b + (a - b) * (a - b) / 8));
      }
  }
}

PRECISION_TEST(Balls, ComparisonsAreCertainOrOpen) {
  using B = Ball<T>;
  Draws<T> draws;
  std::array<int, 3> counted{};
  for (int k = 0; k < 5000; ++k) {
    const B x = draws.ball();
    // Near it, so that all cases occur.
    const B y(x.middle() + T(to_double(x.middle()) * (draws.uniform() - 0.5) * std::ldexp(1., -(k % 60) * 2)),
              x.radius());
    const bool less = exact(x.middle()) + exact(x.radius()) < exact(y.middle()) - exact(y.radius());
    const bool greater = exact(x.middle()) - exact(x.radius()) > exact(y.middle()) + exact(y.radius());
    const Order order_of_both = order(x, y);
    ++counted[static_cast<std::size_t>(order_of_both)];
    EXPECT_TRUE(order_of_both != Order::less || less);
    EXPECT_TRUE(order_of_both != Order::greater || greater);
    EXPECT_TRUE(order_in_doubles(x, y) == Order::open || order_in_doubles(x, y) == order_of_both);
    EXPECT_FALSE(x < y && x >= y);
  }
  for (const int count : counted) EXPECT_GT(count, 300);
}

PRECISION_TEST(Balls, DecimalsAndDoublesAreRoundedOutwards) {
  using B = Ball<T>;
  Draws<T> draws;
  for (int k = 0; k < 500; ++k) {
    const B x = draws.ball();
    const auto text = in_decimals(x);
    const auto doubles = in_doubles(x);
    const Rational low = exact(x.middle()) - exact(x.radius()), high = exact(x.middle()) + exact(x.radius());
    EXPECT_LE(decimal<Rational>(text.low), low) << text.low;
    EXPECT_GE(decimal<Rational>(text.high), high) << text.high;
    EXPECT_LE(exact(doubles.low), low);
    EXPECT_GE(exact(doubles.high), high);
    // And not by much.
    if (x.radius() > 0) {
      EXPECT_LE(decimal<Rational>(text.high) - decimal<Rational>(text.low), Rational((high - low) * 2))
          << text.low << " " << text.high;
    }
  }
}

// A particle at rest has the velocity 0, exactly: to find doubles on either side of it must not take for ever.
PRECISION_TEST(Balls, DoublesAreFoundAroundZero) {
  using B = Ball<T>;
  for (const B& x : {B(0), B(T(0), 5e-324), B(T(0), 1e-300), B(T(0), 1e-30)}) {
    const auto doubles = in_doubles(x);
    EXPECT_LT(doubles.low, 0);
    EXPECT_GT(doubles.high, 0);
    EXPECT_TRUE(B(doubles.low) < x && x < B(doubles.high));
    EXPECT_LT(doubles.high - doubles.low, 3 * static_cast<double>(x.radius()) + 1e-280);
  }
}

PRECISION_TEST(Balls, LiteralsAreEnclosed) {
  using B = Ball<T>;
  for (const auto& [text, numerator, denominator] :
       {std::tuple{"0.999", 999, 1000}, {"1e-5", 1, 100000}, {"0.3333333", 3333333, 10000000}, {"-7", -7, 1}}) {
    const B x = from_text<B>(text);
    expect_holds(x, Rational(numerator) / denominator);
    EXPECT_LT(x.radius(), 1e-29);
  }
}

PRECISION_TEST(Balls, WhatMayBeZeroDividesNothing) {
  using B = Ball<T>;
  EXPECT_FALSE(is_finite(B(1) / B(T(1), 2)));
  EXPECT_EQ(order(B(1) / B(0), B(5)), Order::open);
  EXPECT_FALSE(is_positive(B(T(1), 1)));
}

// The next decimals outside, by a type that holds the ends exactly. Ends that would be rounded to the power of ten
// above them are in its units, which are ten times as large.
TEST(BallTest, DecimalsAreTheNextOnesOutside) {
  using Wide =
      boost::multiprecision::number<boost::multiprecision::cpp_bin_float<3300, boost::multiprecision::digit_base_2>,
                                    boost::multiprecision::et_off>;
  std::uint64_t quick = 0;
  for (std::uint64_t number = 0; number < 4000; ++number) {
    SCOPED_TRACE(number);
    std::uint64_t index = 0;
    const auto uniform = [&] { return static_cast<double>(random_bits(21, number, index++) >> 11) * 0x1p-52 - 1; };
    double high = std::ldexp(uniform(), static_cast<int>(random_bits(21, number, index++) % 60) - 30);
    double radius = std::abs(high) * std::exp(-10 - 40 * std::abs(uniform()));
    int digits = 3 + static_cast<int>(random_bits(21, number, index++) % 32);
    double low = high * uniform() * 0x1p-54;
    if (number % 8 == 0) high = std::round(high), low = 0;                                                // a decimal
    if (number % 8 == 1) high = 100.5 + static_cast<double>(number % 900), low = radius = 0, digits = 3;  // between two
    if (number % 8 == 2) high = std::pow(10, std::round(4 * high / (1 + std::abs(high)))), low = 0;  // a power of ten
    if (number % 8 == 3) high = 0, low = 0;
    if (number % 64 == 4) high *= 1e200, low *= 1e200;
    const double_double middle = double_double::sum(high, low);
    const auto [low_end, high_end] = detail::decimals(middle, radius, digits);
    for (const bool below : {true, false}) {
      const std::string& text = below ? low_end : high_end;
      const double by = below ? -radius : radius;
      const Wide end = Wide(middle.high()) + middle.low() + by;
      const Wide outside = below ? Wide(end - Wide(text)) : Wide(Wide(text) - end);
      EXPECT_GE(outside, 0) << text;
      const auto in_integers = detail::quick_decimal_beside({middle.high(), middle.low(), by}, digits, below);
      quick += in_integers.has_value();
      if (end == 0) continue;
      const int exponent = std::stoi(text.substr(text.find('e') + 1));
      const Wide unit = pow(Wide(10), exponent - digits + 1);
      const bool at_power = !in_integers && abs(end) + unit > pow(Wide(10), exponent + 1);
      EXPECT_LT(outside, at_power ? Wide(10 * unit) : unit) << text;
    }
  }
  EXPECT_GT(quick, 4000U);
}

}  // namespace cradle::test::ball_test
