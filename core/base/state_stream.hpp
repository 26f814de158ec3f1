#pragma once
// States (state.hpp) that are too large for memory are saved to and loaded from these streams of bytes, which have a
// buffer. What is behind the buffer, a file with its checksum for instance, is the business of who derives from them.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace cradle {

class StateSink {
 public:
  void put(const void* data, std::size_t size) {
    if (buffer_.size() + size > buffer_size) flush();
    buffer_.append(static_cast<const char*>(data), size);
  }

 protected:
  static constexpr std::size_t buffer_size = std::size_t{1} << 18;

  ~StateSink() = default;
  /// Passes the buffer on and empties it.
  virtual void flush() = 0;

  std::string buffer_;
};

class StateSource {
 public:
  void get(void* data, std::size_t size) {
    if (size > buffer_.size() - at_) return get_slowly(static_cast<char*>(data), size);
    std::memcpy(data, buffer_.data() + at_, size);
    at_ += size;
  }
  /// The number of bytes not read yet.
  std::uint64_t left() const { return after_buffer_ + (buffer_.size() - at_); }
  /// Throws if bytes are left: then the source has something else.
  virtual void end() const = 0;

 protected:
  ~StateSource() = default;
  /// Reads what the buffer does not have as a whole. Throws if the source ends before.
  virtual void get_slowly(char* data, std::size_t size) = 0;

  std::string buffer_;
  std::size_t at_ = 0;              // position in the buffer
  std::uint64_t after_buffer_ = 0;  // bytes of the state after the buffer
};

}  // namespace cradle
