// The files from which unfinished work continues.
//
// A journal is a file to which a run, or a study with replicas, appends records during the work, so that none is lost
// if the program or the machine stops: every record carries its length and a checksum. After a kill the last record may
// be incomplete: a reader stops there and reports how much it left out, and a writer that continues cuts it off. The
// first record is the header. Only the version of the program that wrote a journal reads it.
//
// A journal has one writer because the result beside it has one (FileClaim).
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/ensemble/statistics.hpp"
#include "cradle/core/ensemble/tree.hpp"
#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

/// Bins for the values of a quantity: "series/energy", "profiles/0000/velocity".
struct SpreadRequest {
  std::string name;
  FixedBins bins;

  bool bins_are_possible() const { return bins.from < bins.to && bins.bins >= 1 && bins.bins <= 1'000'000; }
  static auto state(auto& self) { return fields(self.name, self.bins); }
  void loaded() const { require_state(bins_are_possible(), "no bins"); }
  bool operator==(const SpreadRequest&) const = default;
};

/// The kind of a search for a threshold: only its own command continues it.
inline constexpr std::string_view threshold_kind = "threshold";

/// What the records of a journal, or a checkpoint, belong to.
struct JournalHeader {
  std::string kind;            // "run", "ensemble", "sweep" or "threshold"; "simulation": a checkpoint from Python
  std::uint64_t identity = 0;  // of a run: random; of a simulation: 0; of others: their own
  std::string scene, name;     // scene: effective, as TOML
  // Of a run:
  double every_seconds = 60;  // between checkpoints
  bool extends = false;       // a finished run is extended, from its result and its checkpoint
  // Of a study:
  ReplicaRange wanted = {};  // per ensemble
  std::vector<SpreadRequest> spreads = {};
  std::vector<std::pair<std::string, std::string>> points = {};  // ensembles: groups in the result, and scenes

  bool of_run() const { return kind == "run"; }
  static auto state(auto& self) {
    return fields(self.kind, self.identity, self.scene, self.name, self.every_seconds, self.extends, self.wanted,
                  self.spreads, self.points);
  }
  void loaded() const {
    constexpr std::uint64_t most = std::uint64_t{1} << 53;
    require_state(wanted.first <= most && wanted.count <= most, "too many replicas");
  }
};

/// The kind of a file, from its first bytes. Throws Error (Exit::io) for a journal or a checkpoint of another format.
enum class Stored { other, journal, checkpoint };
Stored stored_in(const std::string& path);
/// The first bytes of files of that kind.
constexpr std::string_view begin_of(Stored kind) { return kind == Stored::journal ? "CRADLEJ4" : "CRADLEC4"; }

/// Reads record after record. Throws Error (Exit::io) if the file is not such a journal.
class JournalReader {
 public:
  explicit JournalReader(const std::string& path);

  const JournalHeader& header() const { return header_; }
  /// False at the end, or at the first incomplete record.
  bool next(std::string& record);
  template <class Record> std::optional<Record> next() {
    std::string record;
    if (!next(record)) return {};
    try {
      return from_bytes<Record>(std::move(record));
    } catch (const Error& error) {
      throw Error(path_ + ": " + error.what(), Exit::io);
    }
  }

  std::uint64_t whole_bytes() const { return whole_; }         // the length of the records read so far
  std::uint64_t torn_bytes() const { return size_ - whole_; }  // the rest, when next() has returned false

 private:
  std::string path_;
  JournalHeader header_;
  std::ifstream file_;
  std::uint64_t size_ = 0, whole_ = 0;
};

/// The header of a journal; nothing for other files. Throws Error (Exit::io) as JournalReader does.
std::optional<JournalHeader> journal_header(const std::string& path);

/// Appends records. All functions throw Error (Exit::io). One thread at a time may append; another may sync meanwhile.
class JournalWriter {
 public:
  using Put = std::function<void(std::string_view record)>;

  /// A new journal, which replaces an existing one. It appears under its name when it is complete: with the header and
  /// the records that `records` puts, synced to the disk if requested.
  JournalWriter(const std::string& path, const JournalHeader& header,
                const std::function<void(const Put&)>& records = {}, Sync sync = Sync::yes);
  /// Continues an existing journal after its first `whole_bytes`; the rest is cut off.
  JournalWriter(const std::string& path, std::uint64_t whole_bytes);

  /// When this returns the record survives the end of the program; after a sync it also survives a crash of the
  /// machine. A record that cannot be written leaves no part in the file.
  void append(std::string_view record);
  void sync() const;
  std::uint64_t bytes() const { return bytes_; }

 private:
  void cut(std::uint64_t bytes);

  std::string path_;
  Descriptor file_;
  std::uint64_t bytes_ = 0;
};

// A checkpoint is a file that holds the state of a run at one moment (core/base/state.hpp). It is written and read as a
// stream, however large, and ends with a checksum over all of it. It is written whole or not at all (atomic_file.hpp),
// and nothing in it is used before its checksum has been verified.

struct CheckpointHeader {
  JournalHeader run;  // of a run: as its journal begins, with the same identity; a simulation in Python has no journal
  std::uint64_t records = 0, check = 0;  // of the journal at that time: number of records, checksum of the last one
  double seconds = 0, time = 0;          // of computing; simulated
  std::uint64_t collisions = 0;

  static auto state(auto& self) {
    return fields(self.run, self.records, self.check, self.seconds, self.time, self.collisions);
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
