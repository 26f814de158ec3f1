// CRC-64/XZ (reflected polynomial of ECMA-182): shows whether bytes on a disk have changed.
#pragma once

#include <cstdint>
#include <string_view>

namespace cradle::tools {

/// The checksum of `bytes`. To continue after earlier bytes, give their checksum.
std::uint64_t crc64(std::string_view bytes, std::uint64_t of_bytes_before = 0);

}  // namespace cradle::tools
