// What FILE.part holds of a run: the rows that it has recorded, and its progress.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "cradle/tools/result/growing_tables.hpp"
#include "cradle/tools/run/sink.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/journal.hpp"

namespace cradle::tools {

using RunRecord = std::variant<std::vector<Group>, RunStatus>;

struct RunJournal {
  JournalHeader header;
  std::vector<Group> tables;        // all rows recorded so far
  std::vector<RunStatus> statuses;  // one from time to time, the latest at the end
  std::uint64_t torn_bytes = 0;     // of an incomplete record at the end
};

/// Throws Error (Exit::io), also for a journal of replicas.
RunJournal read_run_journal(const std::string& path, Reading reading = Reading::everything);
/// Calls `each` with all rows, piece by piece. Returns the number of records after the header.
std::uint64_t for_each_piece(const std::string& path, const std::function<void(Group&& rows)>& each);

/// The scene of a journal. Throws Error naming the journal.
Scene scene_of(const JournalHeader& header, const std::string& path);
/// A result made of the journal of a run in progress.
Result result_so_far(RunJournal&& journal, const std::string& path);
/// Collisions per second over the last minute of computing, or over less if there is less; 0 if there is nothing yet.
double collisions_per_second(const std::vector<RunStatus>& statuses);

}  // namespace cradle::tools
