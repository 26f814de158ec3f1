#include "cradle/tools/support/bytes.hpp"

#include <lzma.h>

namespace cradle::tools {

std::uint64_t crc64(std::string_view bytes, std::uint64_t of_bytes_before) {
  return lzma_crc64(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), of_bytes_before);
}

}  // namespace cradle::tools
