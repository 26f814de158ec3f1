// A file to which records are appended during the work, so that none is lost when the program or the machine stops at
// any moment: every record carries its length and a checksum. After a kill the last one may be torn; a reader stops
// there and says how much it left out, and whoever continues to write cuts it off. The first record is the header.
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tools {

/// What its records are of: the replicas of an ensemble, or one run.
enum class JournalOf { replicas, run };

/// Reads record after record. Throws Error (Exit::io) for what is no such journal.
class JournalReader {
 public:
  JournalReader(const std::string& path, JournalOf kind);

  const std::string& header() const { return header_; }
  /// False at the end, or at the first record that is not whole.
  bool next(std::string& record);

  std::uint64_t whole_bytes() const { return whole_; }         // up to where records were read
  std::uint64_t torn_bytes() const { return size_ - whole_; }  // what is left when next() has said false

  /// What a file is a journal of, by how it begins; nothing for other files. Throws Error for one of version 1.
  static std::optional<JournalOf> kind(const std::string& path);

 private:
  std::string path_, header_;
  std::ifstream file_;
  std::uint64_t size_ = 0, whole_ = 0;
};

/// Appends records. All functions throw Error (Exit::io). One thread at a time may append; another may sync meanwhile.
class JournalWriter {
 public:
  using Put = std::function<void(std::string_view record)>;

  /// A new journal in place of what is there. It appears under its name only when it is whole: with the header, and
  /// the records that `records` puts, on the disk if that is to be waited for.
  JournalWriter(const std::string& path, JournalOf kind, std::string_view header,
                const std::function<void(const Put&)>& records = {}, Sync sync = Sync::yes);
  /// The journal that is there: nobody else may write it from now on.
  explicit JournalWriter(const std::string& path);
  /// Cuts off what is behind the first `whole_bytes` and continues there.
  void continue_after(std::uint64_t whole_bytes);

  /// The record is the system's when this returns: it survives the end of the program; that of the machine, only after
  /// a sync. One that could not be written is not there in part either.
  void append(std::string_view record);
  void sync() const;
  std::uint64_t bytes() const { return bytes_; }

 private:
  void claim(int file) const;

  std::string path_;
  Descriptor file_;
  std::uint64_t bytes_ = 0;
};

}  // namespace cradle::tools
