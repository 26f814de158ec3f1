// What FILE.part holds of a run: the rows that it has recorded, and how far it is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/journal.hpp"
#include "cradle/tools/store/run_store.hpp"

namespace cradle::tools {

using RunRecord = std::variant<std::vector<Group>, RunStatus>;

/// Tables to which rows come piece by piece.
class GrowingTables {
 public:
  /// Of every table all rows, or the first and the last one and how many there are between.
  explicit GrowingTables(Reading reading = Reading::everything) : reading_(reading) {}

  /// Throws Error (Exit::io) for rows of other columns than the table has.
  void add(Group&& rows);
  const std::vector<Group>& tables() const { return tables_; }
  /// In the order in which results have them.
  std::vector<Group> in_order() &&;

 private:
  Reading reading_;
  std::vector<Group> tables_;
  std::unordered_map<std::string, std::size_t> by_name_;
};

/// How many numbers there are in tables, those that were not read included.
std::uint64_t numbers_in(const std::vector<Group>& tables);

struct RunJournal {
  JournalHeader header;
  std::vector<Group> tables;        // as far as they are recorded
  std::vector<RunStatus> statuses;  // one now and then, the latest at the end
  std::uint64_t torn_bytes = 0;     // at the end: not whole
};

/// Throws Error (Exit::io), also for a journal of replicas.
RunJournal read_run_journal(const std::string& path, Reading reading = Reading::everything);
/// Calls `each` with all rows, piece by piece. Returns how many records there are behind the header.
std::uint64_t for_each_piece(const std::string& path, const std::function<void(Group&& rows)>& each);

/// The scene that it is of. Throws Error naming the journal.
Scene scene_of(const JournalHeader& header, const std::string& path);
/// The same as a result of a run in progress.
Result result_so_far(RunJournal&& journal, const std::string& path);
/// Collisions per second over the last minute of computing, or what there is of it; 0 where there is nothing yet.
double collisions_per_second(const std::vector<RunStatus>& statuses);

}  // namespace cradle::tools
