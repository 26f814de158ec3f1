#include "cradle/tools/result/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

constexpr std::string_view seal_begin = "CRADLES1";

Error unreadable(const std::string& path, const char* found) {
  return {{path}, "not a file that can be read", found, "give a result file that cradle wrote", Exit::io};
}

// The checksum of the first `size` bytes.
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

std::string seal_with(std::uint64_t size, std::uint64_t crc) {
  std::string seal(seal_begin);
  seal += to_bytes(size);
  return seal + to_bytes(crc64(seal, crc));
}

}  // namespace

std::string seal_of(std::string_view bytes) { return seal_with(bytes.size(), crc64(bytes)); }

std::string seal_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t size = std::filesystem::file_size(path);
  return seal_with(size, checksum(file, size, path));
}

void check_seal(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status) && path.ends_with(".part"))
    throw Error(
        {path}, "no run in progress", "no such file",
        fmt::format("give {}, which a run leaves when it is complete; if that is not there either, run the scene: "
                    "there is a journal after its first two seconds",
                    path.substr(0, path.size() - 5)),
        Exit::io);
  if (!std::filesystem::exists(status))
    throw Error({path}, "no such file", "", "give a result file that cradle wrote", Exit::io);
  // Opening a FIFO would wait for ever.
  if (!std::filesystem::is_regular_file(status)) throw unreadable(path, "a folder, FIFO or device");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw unreadable(path, std::strerror(errno));
  const std::uint64_t size = std::filesystem::file_size(path, error);
  const auto read = [&](std::uint64_t at, std::uint64_t bytes) {
    std::string part(bytes, '\0');
    file.seekg(static_cast<std::streamoff>(at));
    if (!file.read(part.data(), static_cast<std::streamsize>(bytes))) throw unreadable(path, "it ends early");
    return part;
  };
  const auto damaged = [&](const std::string& found) {
    return Error({path}, "damaged", found, "take it from a copy, or make it anew", Exit::io);
  };
  constexpr std::uint64_t superblock = 48;
  if (error || size < superblock) return;
  if (const std::string seal = read(size - seal_size, seal_size); seal.starts_with(seal_begin)) {
    const auto [length, crc] = from_bytes<std::pair<std::uint64_t, std::uint64_t>>(seal.substr(seal_begin.size()));
    file.seekg(0);
    if (length != size - seal_size || checksum(file, size - sizeof crc, path) != crc)
      throw damaged("its bytes are not those that were written");
    return;
  }
  // The length of the file according to HDF5: a superblock of version 0 with addresses of 8 bytes.
  const std::string begin = read(0, superblock);
  if (!begin.starts_with("\x89HDF") || begin[8] != 0 || begin[13] != sizeof size) return;
  if (const auto length = from_bytes<std::uint64_t>(begin.substr(40)); length != size)
    throw damaged(fmt::format("{} bytes, HDF5 wrote {}", size, length));
}

}  // namespace cradle::tools
