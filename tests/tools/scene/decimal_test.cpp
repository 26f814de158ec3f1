// Decimal literals: canonical form, exact order against rational arithmetic done by hand, integers.
#include "cradle/tools/scene/decimal.hpp"

#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "cradle/tools/scene/rational.hpp"

namespace cradle::tools::decimal_test {

TEST(Decimal, CanonicalForm) {
  EXPECT_EQ(canonical_decimal("+1_000"), "1000");
  EXPECT_EQ(canonical_decimal(".5"), "0.5");
  EXPECT_EQ(canonical_decimal("5."), "5");
  EXPECT_EQ(canonical_decimal("-007.50E+05"), "-7.50e05");
  EXPECT_EQ(canonical_decimal("000"), "0");
  for (const char* bad : {"",   "+",    "-",    ".",   "e5",  "1e",  "1e+", "1e5.0", "1__0", "_1",
                          "1_", "1_.5", "0x10", "inf", "nan", "1 2", "--1", "1.2.3", "1,5",  "1e1234567890123456789"})
    EXPECT_FALSE(canonical_decimal(bad)) << bad;
  EXPECT_THROW(Decimal("nan"), std::invalid_argument);
}

TEST(Decimal, OrderIsExact) {
  // Strictly increasing; every pair is compared both ways.
  constexpr const char *least = "1e-999999999999999999", *most = "1e999999999999999999",
                       *above_a_tenth = "0.10000000000000000000000000000001", *above_1 = "1.00000000000000000000001";
  const char* increasing[] = {"-1e400", "-10",         "-9.99", "-1",    "-1e-400", "0",  least,   "1e-400", "0.09",
                              "0.1",    above_a_tenth, "1",     above_1, "9",       "10", "1e400", most};
  const auto n = std::size(increasing);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      EXPECT_EQ(compare_decimals(increasing[i], increasing[j]), i <=> j) << i << ' ' << j;
  EXPECT_EQ(Decimal("1"), Decimal("1.000"));
  EXPECT_EQ(Decimal("1000"), Decimal("0.001e6"));
  EXPECT_EQ(Decimal("-0.0e9"), Decimal("0"));
}

TEST(Decimal, Integers) {
  EXPECT_EQ(decimal_integer("2e7"), 20000000U);
  EXPECT_EQ(decimal_integer("8000.0"), 8000U);
  EXPECT_EQ(decimal_integer("0e5"), 0U);
  EXPECT_EQ(decimal_integer("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(decimal_integer("18446744073709551616"), std::nullopt);
  EXPECT_EQ(decimal_integer("1e999999999"), std::nullopt);
  EXPECT_EQ(decimal_integer("0.5"), std::nullopt);
  EXPECT_EQ(decimal_integer("-1"), std::nullopt);
  EXPECT_TRUE(is_whole("-120e-1"));
  EXPECT_FALSE(is_whole("-121e-1"));
}

using Texts = std::vector<std::string>;
Texts texts(const DecimalColumn& column) {
  Texts all;
  for (std::size_t k = 0; k < column.size(); ++k) all.emplace_back(column[k]);
  return all;
}

TEST(Decimal, Steps) {
  const auto steps = [](const char* from, const char* by, const char* until) {
    return decimals_by_step(Decimal(from), Decimal(by), Decimal(until));
  };
  EXPECT_EQ(texts(steps("0", "0.1", "0.3")), (Texts{"0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(texts(steps("-1", "0.25", "-0.3")), (Texts{"-1", "-0.75", "-0.5"}));
  EXPECT_EQ(texts(steps("1e21", "1e-21", "1e21")), (Texts{"1000000000000000000000"}));
  EXPECT_EQ(texts(steps("1e21", "7e-21", "1000000000000000000000.00000000000000000001")).back(),
            "1000000000000000000000.000000000000000000007");
  EXPECT_EQ(texts(steps("5", "2e3", "4005")), (Texts{"5", "2005", "4005"}));
  EXPECT_EQ(texts(steps("0", "1e-400", "2.5e-400")), (Texts{"0", "1e-400", "2e-400"}));
  EXPECT_EQ(texts(steps("0", "1e400", "2e400")), (Texts{"0", "1e400", "2e400"}));
  EXPECT_FALSE(of_one_scale(Decimal("1"), Decimal("1e-999999"), Decimal("2")));
  EXPECT_TRUE(of_one_scale(Decimal("0"), Decimal("1e-999999"), Decimal("2e-999999")));
}

TEST(Decimal, Parts) {
  const auto parts = [](const char* from, const char* to, std::uint64_t count, const char* until) {
    return decimals_by_parts(Decimal(from), Decimal(to), count, Decimal(until), 17);
  };
  EXPECT_EQ(texts(parts("0", "1", 8, "0.3")), (Texts{"0", "0.125", "0.25"}));
  EXPECT_EQ(texts(parts("-0.5", "1.5", 5, "2")), (Texts{"-0.5", "-0.1", "0.3", "0.7", "1.1", "1.5", "1.9"}));
  const Texts thirds = texts(parts("-1", "1", 3, "1"));
  EXPECT_EQ(thirds[1].substr(0, 20), "-0.33333333333333333");
  EXPECT_EQ(thirds[3], "1");
  // In the middle between two doubles, where the even one is the nearest, and very little above.
  const std::string middle = "1.00000000000000011102230246251565404236316680908203125", above = middle + "0000000003";
  const Texts near = texts(parts(middle.c_str(), above.c_str(), 7, above.c_str()));
  EXPECT_EQ(Decimal(near[0]).value, 1);
  EXPECT_EQ(Decimal(near[1]).value, 1 + 0x1p-52);
  EXPECT_EQ(decimal_between(Decimal("1"), Decimal("3"), Decimal("1e-3")), Decimal("1.002"));
}

// Against rationals: exact where the quotient is a finite decimal, else below it by less than 17 digits show.
TEST(Decimal, RandomParts) {
  std::mt19937_64 random(5);
  for (int k = 0; k < 2000; ++k) {
    const std::uint64_t count = 1 + random() % (k % 2 == 0 ? 1'000 : 10'000'000);
    const std::string to =
        std::to_string(1 + random() % 100'000) + "e" + std::to_string(static_cast<int>(random() % 40) - 20);
    const Rational step = *rational(to) / count;
    // Up to the third part at most, or all would be made.
    const Texts all =
        texts(decimals_by_parts(Decimal("0"), Decimal(to), count, Decimal(decimal_text(3 * step, 30)), 17));
    ASSERT_GE(all.size(), 3u);
    for (std::size_t n = 0; n < 3; ++n) {
      const Rational exact = n * step, off = exact - *rational(all[n]);
      Whole rest = denominator(exact);
      while (rest % 2 == 0) rest /= 2;
      while (rest % 5 == 0) rest /= 5;
      EXPECT_EQ(off == 0, rest == 1) << all[n];
      EXPECT_TRUE(off >= 0 && off * power_of_ten(17) <= exact) << all[n];
    }
  }
}

TEST(Decimal, NearestDouble) {
  EXPECT_EQ(Decimal("0.999").value, 0.999);
  EXPECT_EQ(Decimal("1e-400").value, 0.0);
  EXPECT_EQ(Decimal("-1e400").value, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(Decimal("4.9406564584124654e-324").value, std::numeric_limits<double>::denorm_min());
}

}  // namespace cradle::tools::decimal_test
