// What FILE.part holds of a run: its scene, the rows that it has recorded, how far it is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/journal.hpp"
#include "cradle/tools/store/run_store.hpp"

namespace cradle::tools {

/// Of a run's journal, and of its checkpoints, which belong to the journal of the same number.
struct RunHeader {
  std::string version;  // of the program
  std::string scene;    // effective, as TOML
  std::string name;
  double every_seconds = 60;           // between checkpoints
  std::uint64_t number = 0;            // drawn anew for each run
  std::uint64_t first_stands_for = 1;  // so many records of the journal before: it is what that run's result holds

  std::string bytes() const;
  static RunHeader of(std::string_view bytes);
};

std::string record_of(const std::vector<Group>& rows);
std::string record_of(const RunStatus& status);
/// Of a record of rows; none in others.
std::vector<Group> rows_in(std::string_view record);

/// Tables to which rows come piece by piece.
class GrowingTables {
 public:
  /// Of every table all rows, or the first and the last one and how many there are between.
  explicit GrowingTables(Reading reading = Reading::everything) : reading_(reading) {}

  /// Throws Error (Exit::io) for rows of other columns than the table has.
  void add(Group&& rows);
  /// In the order in which results have them.
  std::vector<Group> in_order() &&;

 private:
  Reading reading_;
  std::vector<Group> tables_;
  std::unordered_map<std::string, std::size_t> by_name_;
};

struct RunJournal {
  RunHeader header;
  std::vector<Group> tables;        // as far as they are recorded
  std::vector<RunStatus> statuses;  // one now and then, the latest at the end
  std::uint64_t torn_bytes = 0;     // at the end: not whole
};

/// Throws Error (Exit::io).
RunJournal read_run_journal(const std::string& path, Reading reading = Reading::everything);
/// Calls `each` with all rows, piece by piece. Returns how many records there are behind the header.
std::uint64_t for_each_piece(const std::string& path, const std::function<void(Group&& rows)>& each);

/// The scene that it is of. Throws Error naming the journal.
Scene scene_of(const RunHeader& header, const std::string& path);
/// The same as a result of a run in progress.
Result result_so_far(RunJournal&& journal, const std::string& path);
/// Collisions per second over the last minute of computing, or what there is of it; 0 where there is nothing yet.
double collisions_per_second(const std::vector<RunStatus>& statuses);

}  // namespace cradle::tools
