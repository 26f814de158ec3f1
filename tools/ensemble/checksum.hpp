// CRC-64/XZ: tells whether bytes on a disk are those that were written. Reflected polynomial of ECMA-182, eight bytes a
// step (slicing, Kounavis and Berry 2008, doi 10.1109/TC.2008.85): Boost's, one byte a step, would take as long as a
// short replica itself.
#pragma once

#include <cstdint>
#include <string_view>

namespace cradle::tools {

/// Of `bytes`; to go on from bytes before them, give their checksum.
std::uint64_t crc64(std::string_view bytes, std::uint64_t of_bytes_before = 0);

}  // namespace cradle::tools
