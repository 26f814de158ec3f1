// Numbers and text as bytes come back as they were; the checksum against Boost's, bit by bit.

#include "cradle/tools/support/bytes.hpp"

#include <boost/crc.hpp>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "cradle/tools/support/checksum.hpp"

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

TEST(Bytes, ComeBackAsTheyWere) {
  const std::vector<double> numbers{1.5, -0.0, 1e-310, std::numeric_limits<double>::infinity()};
  tools::ByteWriter writer;
  writer.put(std::uint64_t{7}).put("text").put(numbers).put(std::vector<std::uint64_t>{}).put(2.5);
  tools::ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.integer(), 7U);
  EXPECT_EQ(reader.text(), "text");
  EXPECT_EQ(reader.numbers<double>(), numbers);
  EXPECT_TRUE(reader.numbers<std::uint64_t>().empty());
  EXPECT_EQ(reader.number<double>(), 2.5);
  EXPECT_TRUE(reader.empty());
  EXPECT_THROW(reader.integer(), tools::Error);
}

TEST(Bytes, LengthsThatCannotBeAreRefused) {
  tools::ByteWriter writer;
  writer.put(~std::uint64_t{0});
  EXPECT_THROW(tools::ByteReader(writer.bytes()).numbers<double>(), tools::Error);
  EXPECT_THROW(tools::ByteReader(writer.bytes()).text(), tools::Error);
}

}  // namespace cradle::tests::bytes_test
