// The reading of doubles for libraries without std::from_chars gives what std::from_chars gives: the same number, the
// same error, the same end.

#include "cradle/precision/read_number.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <random>
#include <string>

namespace read_number_test {

using namespace cradle;

#ifdef __cpp_lib_to_chars

template <class T> void expect_the_same(const std::string& text) {
  T expected{7}, found{7};
  const char* const begin = text.data();
  const auto wanted = std::from_chars(begin, begin + text.size(), expected);
  const auto got = read_by_stream(begin, begin + text.size(), found);
  EXPECT_EQ(got.ec, wanted.ec) << text;
  EXPECT_EQ(got.ptr - begin, wanted.ptr - begin) << text;
  EXPECT_EQ(found, expected) << text;
}

TEST(ReadNumber, RandomBitsByStreamAreThoseOfFromChars) {
  std::mt19937_64 random(7);
  for (int k = 0; k < 2000; ++k) {
    const auto x = std::bit_cast<double>(random());
    if (!std::isnormal(x)) continue;
    std::array<char, 64> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
    expect_the_same<double>({text.data(), end});
    expect_the_same<long double>({text.data(), end});
  }
}

TEST(ReadNumber, EndsAndErrorsByStreamAreThoseOfFromChars) {
  for (const char* text : {"0", "-0.5", "12", "1.5e3", "1,5", "2 ", "1e400x", "1e400", "-1e400", "x", "", "-", "1:2"})
    expect_the_same<double>(text);
}

// Halfway between two doubles, and beside that: rounded once, to even.
TEST(ReadNumber, LiteralsByStreamAreRoundedOnce) {
  for (const char* text : {"9007199254740993", "9007199254740993.0000000000000000000000000000001",
                           "9007199254740992.9999999999999999999999999999999", "2.2250738585072011e-308"})
    expect_the_same<double>(text);
}

#endif

}  // namespace read_number_test
