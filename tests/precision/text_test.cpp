// Conversion from and to text in every scalar type. Proves: random, extreme and subnormal numbers are read back
// unchanged; a literal becomes the nearest number of the type, compared with 1300 digits of MPFR; exponents beyond
// double are kept if the type can hold them; anything but a finite decimal literal is refused.
#ifdef CRADLE_WITH_MPFR

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <random>

#include "cradle/tests/precision/every_scalar.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::text_test {

namespace bm = boost::multiprecision;

PRECISION_SUITE(EveryText, EveryPrecision);

template <class T> T power_of_ten(int exponent) {
  T power(1);
  for (int k = 0; k < std::abs(exponent); ++k) power *= T(10);
  return exponent < 0 ? T(T(1) / power) : power;
}

// All bits of the type random, exponents from 10^-250 to 10^250.
template <class T> T random_number(std::mt19937_64& random) {
  T x(0);
  for (int k = 0; k < 90; ++k) x = (x + T(static_cast<std::int64_t>(random() >> 24))) / T(std::int64_t{1} << 40);
  x *= power_of_ten<T>(static_cast<int>(random() % 501) - 250);
  return random() & 1 ? T(-x) : x;
}

template <class T> void expect_round_trip(const T& x) {
  const std::string text = to_text(x);
  EXPECT_TRUE(from_text<T>(text) == x) << text;
}

// The nearest number of the type: rounded once to its digits; a double-double rounds what its first double leaves.
template <class T> Reference nearest(const Reference& x) {
  if constexpr (std::same_as<T, double_double>) {
    const Reference high = rounded(x, 53);
    return high + rounded(x - high, 53);
  } else if constexpr (requires { std::numeric_limits<T>::digits; }) {
    return rounded(x, std::numeric_limits<T>::digits);
  } else {
    return rounded(x, MpfrPrecision::bits());
  }
}

template <class T> void expect_nearest(const char* literal) {
  EXPECT_EQ(reference(from_text<T>(literal)), nearest<T>(Reference(literal))) << literal;
}

PRECISION_TEST(EveryText, RandomNumbersComeBack) {
  std::mt19937_64 random(20);
  for (int k = 0; k < (TypeParam::digits == 1000 ? 50 : 500); ++k) expect_round_trip(random_number<T>(random));
}

PRECISION_TEST(EveryText, ExtremeNumbersComeBack) {
  using Limits = std::numeric_limits<T>;
  for (const T& x : {Limits::min(), T(-Limits::min()), Limits::max(), Limits::lowest(), Limits::epsilon(),
                     T(T(1) + Limits::epsilon()), T(0), T(std::numeric_limits<std::int64_t>::max()),
                     T(std::numeric_limits<std::int64_t>::min())})
    expect_round_trip(x);
}

PRECISION_TEST(EveryText, LiteralsAreRoundedOnceToTheNearest) {
  for (const char* literal : {"0.999", "0.999000000000000000000000000000000000000000000000000000000000", "1e-5", "0.05",
                              "-.0625", "+3.", "12", "0.717967697244908258902146339765104971034890271643501598719573",
                              "1.E+2", "2.5e-30", "123456789012345678901e-7",
                              // just above the middle between 1 and the next double, and just above that of float128
                              "1.00000000000000011102230246251565404236316680908203125000000000000000000000000000001",
                              "1.0000000000000000000000000000000000962964972193617926527988971292463659000000001"})
    expect_nearest<T>(literal);
}

PRECISION_TEST(EveryText, RandomLiteralsAreRoundedOnceToTheNearest) {
  std::mt19937_64 random(21);
  for (int k = 0; k < 300; ++k) {
    std::string literal = std::to_string(random() % 10) + ".";
    for (int j = 0; j < 4; ++j) literal += std::to_string(random());
    literal += "e" + std::to_string(static_cast<int>(random() % 401) - 200);
    expect_nearest<T>(literal.c_str());
  }
}

PRECISION_TEST(EveryText, ExponentsBeyondDoubleArriveWhereThereIsRoom) {
  if (std::same_as<T, double> || std::same_as<T, double_double>) {
    EXPECT_TRUE(from_text<T>("1e-400") == T(0));
    EXPECT_TRUE(from_text<T>("1e400") > std::numeric_limits<T>::max());
    EXPECT_TRUE(from_text<T>("-1e400") < std::numeric_limits<T>::lowest());
  } else {
    for (const char* literal : {"1e-400", "-1e400", "9.99e-4900", "1e4900"}) expect_nearest<T>(literal);
  }
}

// The size is in the digits and the exponent together.
PRECISION_TEST(EveryText, ManyZerosAndAnExponent) {
  const std::string zeros(600, '0');
  expect_nearest<T>(("0." + zeros + "25e600").c_str());
  expect_nearest<T>(("7" + zeros + "e-600").c_str());
  expect_nearest<T>(("0." + zeros + "0e10").c_str());
  if (std::same_as<T, double> || std::same_as<T, double_double>) {
    EXPECT_TRUE(from_text<T>("0." + zeros + "1e10") == T(0));
    EXPECT_TRUE(from_text<T>("1" + zeros + "e-10") > std::numeric_limits<T>::max());
    EXPECT_TRUE(from_text<T>("-1" + zeros) < std::numeric_limits<T>::lowest());
    EXPECT_TRUE(from_text<T>("0." + zeros + "1") == T(0));
  }
}

PRECISION_TEST(EveryText, WhatIsNoNumberHasTheSameNameInEveryType) {
  using Limits = std::numeric_limits<T>;
  EXPECT_EQ(to_text(Limits::infinity()), "inf");
  EXPECT_EQ(to_text(T(-Limits::infinity())), "-inf");
  EXPECT_EQ(to_text(Limits::quiet_NaN()), "nan");
  EXPECT_EQ(to_text(T(-Limits::quiet_NaN())), "nan");
}

PRECISION_TEST(EveryText, RefusesWhatIsNotAFiniteDecimalLiteral) {
  for (const char* text :
       {"",  "nan", "NaN", "inf", "-inf", "infinity", " 1",  "1 ",   "1x",  "x",  "0x10", "1e",  "1e+", ".",  "-.",
        "+", "-",   "--1", "+-1", "1..2", "1.2.3",    "1,5", "1e5.", "1_0", "1f", "1L",   "1/3", "1\n", "e5", "@Inf@"})
    EXPECT_THROW(from_text<T>(text), std::invalid_argument) << text;
  EXPECT_EQ(test::message_of([] { from_text<T>("1.5 apples"); }), "not a number (1.5 apples): give a decimal literal");
}

template <class T> void expect_subnormals_come_back(int powers) {
  T x = std::numeric_limits<T>::min() * (T(1) - std::numeric_limits<T>::epsilon());
  for (int k = 0; k < powers; ++k, x /= T(2)) {
    ASSERT_GT(x, T(0)) << k;
    expect_round_trip(x);
  }
}

TEST(SubnormalText, ComesBack) {
  expect_subnormals_come_back<double>(52);
  expect_subnormals_come_back<long double>(63);
#ifdef CRADLE_WITH_FLOAT128
  expect_subnormals_come_back<float128>(112);
#endif
  for (int exponent = -969; exponent >= -1074; --exponent) {
    const double high = std::ldexp(1, exponent);
    expect_round_trip(double_double::sum(high, high * 0x1.8p-54));
  }
}

#ifdef CRADLE_WITH_FLOAT128
// Numbers below min() are multiples of 2^-16494.
TEST(SubnormalText, Binary128IsTheNearest) {
  for (const char* literal : {"1e-4940", "3.3621e-4932", "7.77e-4960", "6.5e-4966"})
    EXPECT_LE(abs(reference(from_text<float128>(literal)) - Reference(literal)), ldexp(Reference(1), -16495))
        << literal;
}
#endif

TEST(DoubleDoubleText, PartsFarApartComeBack) {
  for (int exponent = -53; exponent >= -1074; exponent -= 7)
    expect_round_trip(double_double::sum(1, -std::ldexp(1, exponent)));
  expect_round_trip(double_double::sum(0x1.fffffffffffffp1023, 0x1p-1074));
}

// Most numbers are converted in fixed point (fixed_point.hpp): to the same texts, and back, as in numbers that hold any
// sum of two doubles. Few digits, middles, neighbours of integers and of powers of two, and sizes at both ends of what
// fixed point holds decide most there.
TEST(DoubleDoubleText, IsThatOfWideNumbers) {
  using Wide = bm::number<bm::cpp_bin_float<2200, bm::digit_base_2>, bm::et_off>;
  const auto rounded = [](const Wide& x) {
    const auto high = static_cast<double>(x);
    return double_double::sum(high, static_cast<double>(Wide(x - high)));
  };
  std::mt19937_64 random(22);
  const auto part = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int k = 0; k < 4000; ++k) {
    const int power = static_cast<int>(random() % 420) - 350;
    const double odd = std::ldexp(static_cast<double>(random() % 1000), power), any = std::ldexp(part(), power);
    const double_double numbers[] = {double_double(odd), double_double::sum(std::ldexp(1, power), any * 0x1p-60),
                                     double_double::sum(any, -any * part() * 0x1p-53),
                                     double_double::sum(std::floor(part() * 1e6), -part() * std::ldexp(1, power % 90))};
    // The first one's last digit is the least subnormal double.
    const double_double x = k == 0      ? double_double(0x1.1321f897fbbfp-277)
                            : k % 8 < 4 ? numbers[k % 4]
                                        : -numbers[k % 4];
    const Wide wide = Wide(x.high()) + x.low();
    int digits = 32;
    while (rounded(Wide(wide.str(digits))) != x) digits += 8;
    const std::string text = to_text(x);
    EXPECT_EQ(text, wide.str(digits));
    // And of decimals near it, and just beyond the middle between two doubles.
    std::string other = text.substr(0, text.find('e'));
    other[other.size() - 1 - random() % (other.size() / 2 + 1)] = static_cast<char>('0' + random() % 10);
    const double middle = std::ldexp(1 + std::floor(part() * 0x1p52) * 0x1p-52, power / 8);
    for (const std::string& literal :
         {other + "e" + std::to_string(power / 3), Wide(Wide(middle) + std::ldexp(1, power / 8 - 53)).str(90) + "1"})
      EXPECT_EQ(from_text<double_double>(literal), rounded(Wide(literal))) << literal;
  }
}

}  // namespace cradle::test::text_test

#endif
