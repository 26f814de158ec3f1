// The ensembles of one result file, and the journals that keep finished replicas safe during the work:
//
//   FILE         the result of earlier calls, written at the end, in one step
//   FILE.part    journal: replicas finished since then, appended in batches of about a hundredth of a second; it
//                survives any end of the program
//   FILE.part.R  the same by rank R of an MPI job
//
// Running the same scene on the same FILE continues from there. A journal that has become large is rewritten as nodes
// of the tree of replicas. Journals can be read in any order: each is a set of replicas. If two of them share replicas
// (the program was ended between writing one and removing the other), one contains the other.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/store/unfinished.hpp"

namespace cradle::tools {

class EnsembleStore {
 public:
  /// Reads no files yet. Throws Error if the scene cannot be run as an ensemble.
  EnsembleStore(Study study, std::string file);

  /// Claims FILE for the lifetime of this object, and reads it and all journals. Throws Error: Exit::bad_input if they
  /// belong to other scenes, Exit::io if they cannot be read or another program is writing them. Returns warnings about
  /// journals.
  /// Forced, it reads none of them and removes the journals at once: the study begins anew, with a journal of its own,
  /// and replaces FILE when it ends.
  std::string load(Force force = Force::no);
  /// Reads FILE alone, which must exist: to inspect or to merge it.
  /// `otherwise`: what to do where it holds something else.
  void load_result(const char* otherwise = another_file);
  /// Throws Error (Exit::bad_input) if `file` is there and holds more than replicas that are here too.
  void check_replaces(const std::string& file) const;

  const EnsembleStates& states() const { return states_; }
  EnsembleStates& states() { return states_; }
  bool result_there() const { return result_there_; }  // and holds all replicas

  /// Starts to write replicas to a journal. Rank 0 writes FILE.part, which states the wanted replicas from the
  /// beginning; another rank writes its own, which appears with its first replica. A journal larger than `largest`
  /// bytes is rewritten as statistics.
  void start_journal(unsigned rank, ReplicaRange wanted, std::uint64_t largest = std::uint64_t{1} << 26);
  /// Adds finished replicas. May be called from several threads.
  void add(EnsembleRecord&& replicas);
  /// Syncs the journal to the disk, so that it survives a crash of the machine.
  void sync();

  /// Puts all replicas as records, for another store.
  void put_records(const JournalWriter::Put& put) const;
  void apply(std::string_view record);

  /// Writes FILE, then removes the journals.
  void finish();
  /// Removes the journals: FILE holds their replicas, or the study begins anew.
  void drop_journals();
  Result result() const;
  std::uint64_t replicas() const;  // of all points
  std::string outcome() const;     // how they ended: "990 reached the end, 10 inelastic collapse"

 private:
  EnsembleStates empty_states() const;
  std::string read_journal(const std::string& path, std::uint64_t& whole_bytes);
  void take(EnsembleStates& others, const std::string& from);
  bool replaces_another() const;
  void check_identity(const JournalHeader& there, const std::string& path, const char* otherwise = another_file) const;
  static constexpr const char* another_file = "give another -o FILE, or --force to replace it";
  JournalHeader header() const;
  std::vector<std::string> rank_journals() const;
  void compact();

  Study study_;
  std::string file_, part_;
  std::uint64_t identity_;
  ReplicaRange wanted_ = {};
  EnsembleStates states_;
  bool result_there_ = false;

  std::optional<FileClaim> claim_;  // of FILE and all journals
  std::optional<JournalWriter> journal_;
  // Threads that add replicas share this; the one that rewrites the journal has it alone.
  std::shared_mutex changing_;
  std::uint64_t largest_ = 0;  // bytes of a journal before it is rewritten
  std::mutex appending_;       // to the journal, and for its length and the time of its last sync
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
};

/// Ensembles or sweeps of the same scene with different replicas, as one: all replicas of all files. Throws Error:
/// Exit::bad_input if the files have different scenes or share replicas; Exit::io if a file cannot be read or is
/// damaged.
std::unique_ptr<EnsembleStore> merged(const std::vector<std::string>& files);

}  // namespace cradle::tools
