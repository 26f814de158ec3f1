// The conversion of the name of a precision to a type. Proves: every name gives its type; digits give the smallest MPFR
// type that can hold them, which then works in that many bits; an unknown name is refused with advice.
#include <concepts>

#include <gtest/gtest.h>

#include "cradle/precision/scalars.hpp"
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

}  // namespace cradle::test::scalars_test
