// CRC-64/XZ (reflected polynomial of ECMA-182): shows whether bytes on a disk are those that were written.
#pragma once

#include <cstdint>
#include <string_view>

namespace cradle::tools {

/// Of `bytes`; to continue from bytes before them, give their checksum.
std::uint64_t crc64(std::string_view bytes, std::uint64_t of_bytes_before = 0);

}  // namespace cradle::tools
