#include "cradle/tools/result/seal.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/checksum.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

constexpr std::string_view seal_begin = "CRADLES1";

Error unreadable(const std::string& path, const char* found) {
  return {{path, 0, ""}, "not a file that can be read", found, "give a result file that cradle wrote", Exit::io};
}

// Of the first `size` bytes.
std::uint64_t checksum(std::ifstream& file, std::uint64_t size, const std::string& path) {
  std::vector<char> buffer(std::min<std::uint64_t>(size, std::uint64_t{1} << 20));
  std::uint64_t crc = 0;
  while (size > 0) {
    const std::uint64_t part = std::min<std::uint64_t>(size, buffer.size());
    if (!file.read(buffer.data(), static_cast<std::streamsize>(part))) throw unreadable(path, "it ends early");
    crc = crc64({buffer.data(), part}, crc);
    size -= part;
  }
  return crc;
}

}  // namespace

namespace {

std::string seal_with(std::uint64_t size, std::uint64_t crc) {
  std::string seal(seal_begin);
  seal += ByteWriter().put(size).bytes();
  return seal + ByteWriter().put(crc64(seal, crc)).bytes();
}

}  // namespace

std::string seal_of(std::string_view bytes) { return seal_with(bytes.size(), crc64(bytes)); }

std::string seal_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t size = std::filesystem::file_size(path);
  return seal_with(size, checksum(file, size, path));
}

Seal check_seal(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw Error({path, 0, ""}, "no such file", "", "give a result file that cradle wrote", Exit::io);
  // A FIFO would make us wait for ever.
  if (!std::filesystem::is_regular_file(status)) throw unreadable(path, "a folder, FIFO or device");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw unreadable(path, std::strerror(errno));
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error || size < seal_size) return Seal::none;
  std::string seal(seal_size, '\0');
  file.seekg(static_cast<std::streamoff>(size - seal_size));
  if (!file.read(seal.data(), seal_size)) throw unreadable(path, "it ends early");
  if (!seal.starts_with(seal_begin)) return Seal::none;
  ByteReader numbers(std::string_view(seal).substr(seal_begin.size()));
  const std::uint64_t length = numbers.integer(), crc = numbers.integer();
  file.seekg(0);
  if (length != size - seal_size || checksum(file, size - sizeof crc, path) != crc)
    throw Error({path, 0, ""}, "damaged", "its bytes are not those that were written",
                "take it from a copy, or make it anew", Exit::io);
  return Seal::intact;
}

}  // namespace cradle::tools
