// The names and the limits of the scalar types. Proves: every name gives its type; digits give the smallest MPFR type
// that can hold them, which then works in that many bits; an unknown name is refused with advice. std::numeric_limits
// are those of the arithmetic: epsilon is the spacing for its digits; the least and the greatest number are those of
// its exponents; infinity and NaN, if they are claimed, exist and behave as such; and for any numeric_limits a run
// refuses to advance to an infinite time or to NaN, and can then continue. (In double-double a run to an infinite time
// used to make no collisions, without a message; in double NaN overwrote memory.)
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::scalars_test {

template <class T> bool leads_to(const char* name, unsigned digits = 0) {
  return with_scalar<bool>({name, digits}, [](auto type) { return std::same_as<typename decltype(type)::type, T>; });
}

std::string refusal(const char* name, unsigned digits) {
  return test::message_of([&] { with_scalar<int>({name, digits}, [](auto) { return 0; }); });
}

template <class T> void expect_name(const char* name) {
  EXPECT_TRUE(leads_to<T>(name));
  EXPECT_EQ(scalar_name<T>, name);
}
TEST(ScalarNames, LeadToTheirTypesAndAreSaidBackByThem) {
  expect_name<double>("double");
  expect_name<long double>("long double");
  expect_name<double_double>("double-double");
  expect_name<bin_float>("cpp_bin_float");
#ifdef CRADLE_WITH_FLOAT128
  expect_name<float128>("float128");
#else
  EXPECT_TRUE(has(refusal("float128", 0), "choose mpfr with 34 digits"));
#endif
}

TEST(ScalarNames, UnknownOnesAreRefused) {
  const std::string advice = " digits: choose one of those that --version lists, mpfr with at most 1000 digits";
  EXPECT_EQ(refusal("quad", 0), "no scalar type quad of 0" + advice);
  EXPECT_EQ(refusal("mpfr", 5000), "no scalar type mpfr of 5000" + advice);
  EXPECT_TRUE(has(refusal("", 0), "choose one of those"));
  EXPECT_TRUE(has(refusal("Double", 0), "no scalar type Double"));
}

#ifdef CRADLE_WITH_MPFR
TEST(ScalarNames, MpfrIsTheSmallestThatHoldsTheDigits) {
  for (const unsigned digits : {20U, 50U, 76U}) EXPECT_TRUE(leads_to<Mpfr<4>>("mpfr", digits)) << digits;
  for (const unsigned digits : {77U, 153U, 154U, 307U}) EXPECT_TRUE(leads_to<Mpfr<16>>("mpfr", digits)) << digits;
  for (const unsigned digits : {308U, 1000U}) EXPECT_TRUE(leads_to<Mpfr<56>>("mpfr", digits)) << digits;
}

// d digits need d log2(10) = 3.3219 d bits.
TEST(ScalarNames, MpfrWorksInTheBitsThatTheDigitsNeed) {
  for (const unsigned digits : {1U, 20U, 50U, 76U, 77U, 153U, 154U, 307U, 308U, 1000U}) {
    const auto bits = with_scalar<mpfr_prec_t>({"mpfr", digits}, [](auto type) {
      using T = typename decltype(type)::type;
      if constexpr (requires(const T& x) { x.get(); }) return mpfr_get_prec((T(1) / T(3)).get());
      return mpfr_prec_t{0};
    });
    EXPECT_EQ(bits, MpfrPrecision::bits()) << digits;
    EXPECT_GE(static_cast<double>(bits), digits * 3.321928095) << digits;
    EXPECT_LE(static_cast<double>(bits), digits * 3.321928095 + 3) << digits;
  }
}
#else
TEST(ScalarNames, MpfrIsNotInThisBuild) { EXPECT_TRUE(has(refusal("mpfr", 50), "install libmpfr-dev")); }
#endif

// ---- limits

PRECISION_SUITE(EveryLimit, EveryPrecision);

// 2^exponent, by squaring: exponents go to 2^30.
template <class T> T power_of_two(long exponent) {
  T power(1), base = exponent < 0 ? T(T(1) / T(2)) : T(2);
  for (long left = std::abs(exponent); left > 0; left /= 2) {
    if (left % 2 == 1) power *= base;
    if (left > 1) base *= base;
  }
  return power;
}

PRECISION_TEST(EveryLimit, EpsilonIsWhatTheDigitsSay) {
  using Limits = std::numeric_limits<T>;
  const T epsilon = Limits::epsilon();
  EXPECT_TRUE(T(1) + epsilon > T(1) && T(1) - epsilon < T(1));
  if constexpr (requires { Limits::digits; }) {
    EXPECT_TRUE(epsilon == power_of_two<T>(1 - Limits::digits));
    EXPECT_LE(Limits::digits10, (Limits::digits - 1) * std::log10(2));
    EXPECT_GE(Limits::max_digits10, 1 + Limits::digits * std::log10(2));
  }
  // A double-double may hold a one and something far smaller: its epsilon is what operations keep, 2^-104.
  if (!std::same_as<T, double_double>) {
    EXPECT_TRUE(T(1) + epsilon / T(4) == T(1));
  }
}

PRECISION_TEST(EveryLimit, LeastAndGreatestAreWhatTheExponentsSay) {
  using Limits = std::numeric_limits<T>;
  EXPECT_TRUE(Limits::lowest() == -Limits::max());
  const long above = std::same_as<T, bin_float> ? 1 : 0;  // Boost 1.74 counts exponents from 1 instead of from 1/2
  EXPECT_TRUE(Limits::min() == power_of_two<T>(Limits::min_exponent - 1 + above));
  // Scaled down, since 2^max_exponent is beyond the range: no number fits between it and 1. (A low part is at most half
  // a unit of the high one, and that is what a double-double lacks.)
  const T share = Limits::max() * power_of_two<T>(1 - Limits::max_exponent - above) / T(2);
  EXPECT_TRUE(share < T(1) && share >= T(1) - (std::same_as<T, double_double> ? T(0x1p-53) : Limits::epsilon()));
}

PRECISION_TEST(EveryLimit, InfinityIsBeyondEveryNumber) {
  using Limits = std::numeric_limits<T>;
  ASSERT_TRUE(Limits::has_infinity);
  const T infinity = Limits::infinity();
  EXPECT_TRUE(infinity > Limits::max() && -infinity < Limits::lowest());
  EXPECT_TRUE(infinity == infinity && infinity != -infinity);
  EXPECT_TRUE(is_positive(infinity) && is_negative(T(-infinity)));
  if (!std::same_as<T, double_double>) {  // its parts cancel: see double_double.hpp
    EXPECT_TRUE(T(1) / infinity == T(0));
  }
  EXPECT_EQ(to_double(infinity), std::numeric_limits<double>::infinity());
}

PRECISION_TEST(EveryLimit, NanIsUnlikeEveryNumberAndItself) {
  using Limits = std::numeric_limits<T>;
  ASSERT_TRUE(Limits::has_quiet_NaN);
  const T nan = Limits::quiet_NaN();
  EXPECT_FALSE(nan == nan);
  for (const T& x : {T(0), T(1), Limits::infinity(), nan})
    EXPECT_FALSE(nan == x || nan < x || nan > x || nan <= x || nan >= x);
  EXPECT_TRUE(std::isnan(to_double(nan)) && std::isnan(to_double(T(nan + T(1)))));
}

PRECISION_TEST(EveryLimit, OnlyNumbersAreTimes) {
  const T infinite = T(1) / T(0), undefined = T(0) / T(0), tiny = std::numeric_limits<T>::min();
  EXPECT_TRUE(is_finite(T(0)) && is_finite(T(-7)) && is_finite(tiny) && is_finite(far_away<T>()));
  auto run = gap_run<T>(list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}), Inelastic<T>(T(1)));
  for (const T& t : {infinite, T(-infinite), undefined}) {
    EXPECT_FALSE(is_finite(t));
    EXPECT_THROW(run.advance(t), std::invalid_argument);
  }
  EXPECT_EQ(run.advance(T(5)), Status::reached);
  EXPECT_EQ(run.counts().collisions, 3U);
}

}  // namespace cradle::test::scalars_test
