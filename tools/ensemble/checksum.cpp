#include "cradle/tools/ensemble/checksum.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace cradle::tools {

namespace {

static_assert(std::endian::native == std::endian::little);

// Row 0 is the usual table; row k advances a byte by k more bytes.
constexpr auto tables = [] {
  std::array<std::array<std::uint64_t, 256>, 16> t{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xC96C5795D7870F42 : 0);
    t[0][byte] = crc;
  }
  for (std::size_t k = 1; k < t.size(); ++k)
    for (std::size_t byte = 0; byte < 256; ++byte) t[k][byte] = (t[k - 1][byte] >> 8) ^ t[0][t[k - 1][byte] & 0xFF];
  return t;
}();

}  // namespace

std::uint64_t crc64(std::string_view bytes, std::uint64_t of_bytes_before) {
  std::uint64_t crc = ~of_bytes_before;
  while (bytes.size() >= 16) {
    std::array<std::uint64_t, 2> words{};
    std::memcpy(words.data(), bytes.data(), 16);
    words[0] ^= crc;
    crc = 0;
    for (std::size_t k = 0; k < 8; ++k)
      crc ^= tables[15 - k][(words[0] >> (8 * k)) & 0xFF] ^ tables[7 - k][(words[1] >> (8 * k)) & 0xFF];
    bytes.remove_prefix(16);
  }
  for (const char c : bytes) crc = (crc >> 8) ^ tables[0][(crc ^ static_cast<unsigned char>(c)) & 0xFF];
  return ~crc;
}

}  // namespace cradle::tools
