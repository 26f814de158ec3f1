// A file that holds the state of a run (core/engine/state.hpp): written and read as a stream, however large, with a
// checksum over all of it at the end. It is there whole or not at all (atomic_file.hpp), and nothing in it is used
// before its checksum has been found right.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

/// Throws Error (Exit::io), as does the reader.
class StateWriter {
 public:
  /// What is to become the file at `path`.
  explicit StateWriter(const std::string& path);

  void put(const void* data, std::size_t size) {
    if (buffer_.size() + size > buffer_size) flush();
    buffer_.append(static_cast<const char*>(data), size);
  }
  void put(std::uint64_t number) { put(&number, sizeof number); }
  void put(std::string_view text) {
    put(std::uint64_t{text.size()});
    put(text.data(), text.size());
  }
  /// To the disk, and in place of what was there before.
  void finish();

 private:
  static constexpr std::size_t buffer_size = std::size_t{1} << 18;
  void flush();

  NewFile file_;
  std::string buffer_;
  std::uint64_t check_ = 0;
};

class StateReader {
 public:
  /// Whether a file begins like one of a state.
  static bool is_state(const std::string& path);

  /// Reads all of the file once, to see that it is whole.
  explicit StateReader(const std::string& path);

  void get(void* data, std::size_t size) {
    if (size > buffer_.size() - at_) return get_slowly(static_cast<char*>(data), size);
    std::memcpy(data, buffer_.data() + at_, size);
    at_ += size;
  }
  std::uint64_t integer() {
    std::uint64_t number = 0;
    get(&number, sizeof number);
    return number;
  }
  std::string text();
  /// Bytes that are still to come.
  std::uint64_t left() const { return after_buffer_ + (buffer_.size() - at_); }
  /// Throws where bytes are left: the file is of something else.
  void end() const;

 private:
  void get_slowly(char* data, std::size_t size);
  void fill();
  Error damaged(const std::string& what) const;

  std::string path_;
  Descriptor file_;
  std::string buffer_;
  std::size_t at_ = 0;              // in the buffer
  std::uint64_t after_buffer_ = 0;  // bytes of the state that are not in it yet
};

}  // namespace cradle::tools
