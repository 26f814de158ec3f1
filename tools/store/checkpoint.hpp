// A file that holds the state of a run at one moment (core/base/state.hpp). It is written and read as a stream,
// however large, and ends with a checksum over all of it. It is written whole or not at all (atomic_file.hpp), and
// nothing in it is used before its checksum has been verified.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <tuple>

#include "cradle/core/base/state.hpp"
#include "cradle/tools/store/journal.hpp"
#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

struct CheckpointHeader {
  JournalHeader run;  // of a run: as its journal begins, with the same identity; a simulation in Python has no journal
  std::uint64_t records = 0, check = 0;  // of the journal at that time: number of records, checksum of the last one
  double seconds = 0, time = 0;          // of computing; simulated
  std::uint64_t collisions = 0;

  static auto state(auto& self) {
    return std::tie(self.run, self.records, self.check, self.seconds, self.time, self.collisions);
  }
};

/// Writes a checkpoint. Throws Error (Exit::io), as the reader does.
class StateWriter final : public StateSink {
 public:
  /// Writes the header; the state follows. The file appears at `path` when it is finished.
  StateWriter(const std::string& path, const CheckpointHeader& header);

  /// Syncs the file and replaces the one that was there before.
  void finish();

 private:
  void flush() override;

  NewFile file_;
  std::uint64_t check_ = 0;
};

class StateReader final : public StateSource {
 public:
  /// Reads the whole file once to verify it, then its header.
  explicit StateReader(const std::string& path);
  const CheckpointHeader& header() const { return header_; }
  void end() const override;

 private:
  void get_slowly(char* data, std::size_t size) override;
  void fill();
  Error damaged(const std::string& what) const;

  std::string path_;
  CheckpointHeader header_;
  std::ifstream file_;
};

}  // namespace cradle::tools
