// Values are read from their bytes unchanged; the checksum is compared with Boost's, bit by bit.
#include "cradle/core/base/fields.hpp"
#include "cradle/tools/support/bytes.hpp"

#include <boost/crc.hpp>
#include <gtest/gtest.h>

namespace cradle::tests::bytes_test {

TEST(Checksum, IsTheCrc64OfXz) {
  EXPECT_EQ(tools::crc64("123456789"), 0x995DC9BBDF1939FAU);  // the check value of the catalogue of CRC algorithms
  std::string text;
  for (int i = 0; i < 300; ++i) {
    boost::crc_optimal<64, 0x42F0E1EBA9EA3693, ~std::uint64_t{0}, ~std::uint64_t{0}, true, true> slow;
    slow.process_bytes(text.data(), text.size());
    ASSERT_EQ(tools::crc64(text), slow.checksum()) << i;
    ASSERT_EQ(tools::crc64(text.substr(text.size() / 3), tools::crc64(text.substr(0, text.size() / 3))),
              slow.checksum());
    text += static_cast<char>(37 * i * i + 11 * i);
  }
}

struct Listed {
  std::uint64_t number = 0;
  std::string text;
  std::vector<double> numbers;
  std::vector<std::string> texts;
  std::variant<double, std::string, std::vector<std::uint64_t>> either;
  static auto state(auto& self) { return fields(self.number, self.text, self.numbers, self.texts, self.either); }
  bool operator==(const Listed&) const = default;
};

TEST(Bytes, ComeBackAsTheyWere) {
  const double inf = std::numeric_limits<double>::infinity();
  const Listed all{7, "text", {1.5, -0.0, 1e-310, inf}, {"", "two\0three"}, std::string("either")};
  EXPECT_EQ(tools::from_bytes<Listed>(tools::to_bytes(all)), all);
  for (const auto& either : {decltype(all.either)(2.5), decltype(all.either)(std::vector<std::uint64_t>{1, 2})}) {
    Listed other = all;
    other.either = either;
    EXPECT_EQ(tools::from_bytes<Listed>(tools::to_bytes(other)), other);
  }
}

TEST(Bytes, OfSomethingElseAreRefused) {
  const std::string right = tools::to_bytes(Listed{7, "text", {1.5}, {"a"}, 2.5});
  for (std::size_t size = 0; size < right.size(); ++size)
    EXPECT_THROW(tools::from_bytes<Listed>(right.substr(0, size)), tools::Error) << size;
  EXPECT_THROW(tools::from_bytes<Listed>(right + '\0'), tools::Error) << "more than there is in it";
  const std::string longest = tools::to_bytes(~std::uint64_t{0}), third = tools::to_bytes(std::uint64_t{3});
  EXPECT_THROW(tools::from_bytes<std::string>(longest), tools::Error);
  EXPECT_THROW(tools::from_bytes<std::vector<double>>(longest), tools::Error);
  EXPECT_THROW(tools::from_bytes<decltype(Listed::either)>(third), tools::Error) << "no such alternative";
}

}  // namespace cradle::tests::bytes_test
