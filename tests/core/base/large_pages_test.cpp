// Long arrays (large_pages.hpp). Proves: they keep their numbers as they move to large pages and back, and long ones
// lie where large pages begin.
#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

#include "cradle/core/base/large_pages.hpp"

namespace cradle::test::large_pages_test {

TEST(LongArray, KeepsItsNumbersAsItGrowsAndShrinksAcrossTheLimit) {
  constexpr std::size_t page = std::size_t{1} << 21, limit = 2 * page / sizeof(std::uint64_t);
  const auto counted = [](LongArray<std::uint64_t> numbers, std::size_t size) {
    numbers.resize(size);
    std::iota(numbers.begin(), numbers.end(), std::uint64_t{0});
    return numbers;
  };
  const auto expect_counted = [](const LongArray<std::uint64_t>& numbers, std::size_t size) {
    ASSERT_EQ(numbers.size(), size);
    for (std::size_t k = 0; k < size; k += 509) ASSERT_EQ(numbers[k], k);
  };
  LongArray<std::uint64_t> numbers = counted({}, limit - 1);
  numbers.push_back(limit - 1);  // moves to large pages
  expect_counted(numbers, limit);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(numbers.data()) % page, 0U);
  numbers.pop_back();
  numbers.shrink_to_fit();
  expect_counted(numbers, limit - 1);
  LongArray<std::uint64_t> longer = counted(numbers, 3 * limit);
  longer.swap(numbers);
  expect_counted(numbers, 3 * limit);
  expect_counted(longer, limit - 1);
}

}  // namespace cradle::test::large_pages_test
