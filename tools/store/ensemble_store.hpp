// The ensembles of one result file, and the journals that keep them safe while replicas are being run:
//
//   FILE         what was finished before: written at the end, in one go
//   FILE.part    journal: replicas since, each appended when it is done; survives the end of the program at any moment
//   FILE.part.R  the same by rank R of an MPI job
//
// Running the same scene on the same FILE continues from there. A journal that has grown large is written anew as the
// nodes of the tree of replicas. Journals can be read in any order: each is a set of replicas, and what is in two of
// them (the program was ended between writing one and removing the other) is in one of them whole.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/store/journal.hpp"

namespace cradle::tools {

/// What a journal of replicas is of. Throws Error (Exit::io) naming the journal.
Study study_in(const JournalHeader& journal, const std::string& path);

class EnsembleStore {
 public:
  /// Reads no files yet. Throws Error for a scene that no ensemble can be made of.
  EnsembleStore(Study study, std::string file);

  /// Claims FILE for as long as this lives, and reads it and all journals. Throws Error:
  /// Exit::bad_input where they belong to other scenes, Exit::io where they cannot be read or another program is at
  /// work on them. Returns what there is to report about journals.
  std::string load();
  /// Reads FILE alone, which must be there; to inspect it, or to merge it.
  void load_result();

  const Study& study() const { return study_; }
  const EnsembleStates& states() const { return states_; }
  EnsembleStates& states() { return states_; }
  bool result_there() const { return result_there_; }  // and holds all replicas that there are

  /// From now on replicas are journalled, those wanted: in FILE.part, which says so from the beginning, or in that of a
  /// rank other than 0, which appears with the first. It is written anew where it grows beyond so many bytes.
  void start_journal(unsigned rank, ReplicaRange wanted, std::uint64_t largest);
  /// Both may be called from several threads.
  void add(std::size_t point, const ReplicaRow& row, std::vector<double> values);
  void fail(std::size_t point, ReplicaIndex replica, const std::string& message);
  /// What was journalled survives the end of the machine, too.
  void sync();

  /// All of this set, and putting it into another.
  void put_records(const JournalWriter::Put& put) const;
  void apply(std::string_view record);

  /// Writes FILE, then removes the journals.
  void finish();
  /// Where FILE holds all that they do.
  void drop_journals();
  Result result() const;
  std::uint64_t replicas() const;  // of all points
  std::string outcome() const;     // how they ended: "990 reached the end, 10 inelastic collapse"

 private:
  EnsembleStates empty_states() const;
  std::string read_journal(const std::string& path, std::uint64_t& whole_bytes);
  void take(EnsembleStates& others, const std::string& from);
  void check_identity(std::uint64_t identity, const std::vector<std::string>& scenes, const std::string& path) const;
  JournalHeader header() const;
  std::vector<std::string> rank_journals() const;
  void journal(const EnsembleRecord& record);
  void keep_safe();
  void compact();

  Study study_;
  std::string file_, part_;
  std::uint64_t identity_;
  ReplicaRange wanted_ = {};
  EnsembleStates states_;
  bool result_there_ = false;

  std::optional<FileClaim> claim_;  // of FILE and all journals
  bool journalling_ = false;
  std::optional<JournalWriter> journal_;
  std::mutex appending_;        // to the journal
  std::shared_mutex changing_;  // shared by whoever adds; alone while the journal is written anew
  std::uint64_t largest_ = 0;   // bytes of the journal before that
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
};

}  // namespace cradle::tools
