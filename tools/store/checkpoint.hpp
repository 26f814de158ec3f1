// A file that holds the state of a run at one moment (core/engine/state.hpp): written and read as a stream, however
// large, with a checksum over all of it at the end. It is there whole or not at all (atomic_file.hpp), and nothing in
// it is used before its checksum has been found right.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>

#include "cradle/tools/store/journal.hpp"
#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

/// What a checkpoint begins with.
struct CheckpointHeader {
  JournalHeader run;                     // of the journal that it belongs to, the one of the same identity
  std::uint64_t records = 0, check = 0;  // of the journal then: how many, and the checksum of the last one
  double seconds = 0, time = 0;          // of computing; simulated
  std::uint64_t collisions = 0;

  static auto state(auto& self) {
    return std::tie(self.run, self.records, self.check, self.seconds, self.time, self.collisions);
  }
};

/// Throws Error (Exit::io), as does the reader.
class StateWriter {
 public:
  /// What is to become the file at `path`, the state behind its header.
  StateWriter(const std::string& path, const CheckpointHeader& header);

  void put(const void* data, std::size_t size) {
    if (buffer_.size() + size > buffer_size) flush();
    buffer_.append(static_cast<const char*>(data), size);
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
  /// Reads all of the file once, to see that it is whole, then its header.
  explicit StateReader(const std::string& path);
  const CheckpointHeader& header() const { return header_; }

  void get(void* data, std::size_t size) {
    if (size > buffer_.size() - at_) return get_slowly(static_cast<char*>(data), size);
    std::memcpy(data, buffer_.data() + at_, size);
    at_ += size;
  }
  /// Bytes that are still to come.
  std::uint64_t left() const { return after_buffer_ + (buffer_.size() - at_); }
  /// Throws where bytes are left: the file is of something else.
  void end() const;

 private:
  void get_slowly(char* data, std::size_t size);
  void fill();
  Error damaged(const std::string& what) const;

  std::string path_;
  CheckpointHeader header_;
  Descriptor file_;
  std::string buffer_;
  std::size_t at_ = 0;              // in the buffer
  std::uint64_t after_buffer_ = 0;  // bytes of the state that are not in it yet
};

}  // namespace cradle::tools
