// A file that holds the state of a run at one moment (core/engine/state.hpp). It is written and read as a stream,
// however large, and ends with a checksum over all of it. It is written whole or not at all (atomic_file.hpp), and
// nothing in it is used before its checksum has been verified.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>

#include "cradle/tools/store/journal.hpp"
#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

/// The beginning of a checkpoint.
struct CheckpointHeader {
  JournalHeader run;                     // of the journal that it belongs to, which has the same identity
  std::uint64_t records = 0, check = 0;  // of the journal at that time: number of records, checksum of the last one
  double seconds = 0, time = 0;          // of computing; simulated
  std::uint64_t collisions = 0;

  static auto state(auto& self) {
    return std::tie(self.run, self.records, self.check, self.seconds, self.time, self.collisions);
  }
};

/// Writes a checkpoint. Throws Error (Exit::io), as the reader does.
class StateWriter {
 public:
  /// Writes the header; the state follows. The file appears at `path` when it is finished.
  StateWriter(const std::string& path, const CheckpointHeader& header);

  void put(const void* data, std::size_t size) {
    if (buffer_.size() + size > buffer_size) flush();
    buffer_.append(static_cast<const char*>(data), size);
  }
  /// Syncs the file and replaces the one that was there before.
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
  /// Reads the whole file once to verify it, then its header.
  explicit StateReader(const std::string& path);
  const CheckpointHeader& header() const { return header_; }

  void get(void* data, std::size_t size) {
    if (size > buffer_.size() - at_) return get_slowly(static_cast<char*>(data), size);
    std::memcpy(data, buffer_.data() + at_, size);
    at_ += size;
  }
  /// The number of bytes not read yet.
  std::uint64_t left() const { return after_buffer_ + (buffer_.size() - at_); }
  /// Throws if bytes are left: then the file contains something else.
  void end() const;

 private:
  void get_slowly(char* data, std::size_t size);
  void fill();
  Error damaged(const std::string& what) const;

  std::string path_;
  CheckpointHeader header_;
  Descriptor file_;
  std::string buffer_;
  std::size_t at_ = 0;              // position in the buffer
  std::uint64_t after_buffer_ = 0;  // bytes of the state after the buffer
};

}  // namespace cradle::tools
