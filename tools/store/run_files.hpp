// The files of an unfinished run of FILE, from which it continues after any interruption:
//
//   FILE.part        journal: the rows recorded so far, and the progress
//   FILE.checkpoint  the state of the run at one moment, and the number of records in the journal then
//
// The journal begins when there is something to lose: after two seconds or the time between two checkpoints (the
// shorter of the two), when the run is interrupted, or when its rows take much memory. A run that ends earlier has
// neither file.
//
// On resuming, the journal is cut to the records of the checkpoint; the rest is computed again, with the same bits.
// Without a checkpoint the run starts anew. When FILE is written, the journal is removed. The last checkpoint stays if
// the run needed more than ten seconds, or than the time between two checkpoints: a later `--until` continues from
// both, with a journal whose first record is the contents of FILE. A shorter run is extended by running it again.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/sink.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/store/unfinished.hpp"

namespace cradle::tools {

/// What FILE.part holds of a run: the rows that it has recorded, and its progress.
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

/// A result with more numbers than this is not held in memory as a whole.
inline constexpr std::uint64_t most_in_memory = std::uint64_t{1} << 25;

class RunFiles : public Sink {
 public:
  static std::string journal_of(const std::string& file) { return file + ".part"; }
  static std::string checkpoint_of(const std::string& file) { return file + ".checkpoint"; }

  /// A new run. The caller has claimed FILE. Throws Error (Exit::bad_input) if a long unfinished run would be lost,
  /// unless forced, else (Exit::io).
  RunFiles(std::string file, const Scene& scene, Force force = Force::no);
  /// Continues a run, up to `until` if given. Throws Error if there is none; a finished run gives a reason in `over`.
  RunFiles(std::string file, const std::optional<std::string>& until);

  const Scene& scene() const { return scene_; }
  /// Why there is nothing to continue, else empty; and the status with which that run ended.
  const std::string& over() const { return over_; }
  Exit over_status() const { return over_status_; }
  /// Where the run continues from: "t = 1200, 3.4e7 collisions"; empty: it begins again.
  const std::string& resumed_from() const { return from_; }
  /// Which lists of times and measurements a later end does not extend, lines for the user; empty: none.
  const std::string& not_extended() const { return not_extended_; }
  std::uint64_t collisions_before() const { return collisions_before_; }
  /// Whether the files have all that was computed up to the end of the run.
  bool up_to_date() const { return up_to_date_; }

  void add(Group&& rows) override;
  /// Writes FILE from all that was recorded, unless the run was interrupted; then removes the journal.
  void end(std::vector<Attribute>&& attributes, RunEnd how) override;
  void check_clock() override;
  bool due() const override { return due_; }
  void keep(const RunStatus& status, const std::function<void(StateSink&)>& save, RunIs run_is) override;
  StateSource* loaded_from() override { return state_.get(); }

 private:
  using Clock = std::chrono::steady_clock;

  static std::uint64_t drawn_number();
  void resume(const std::optional<std::string>& until);
  void resume_from_result(const std::optional<std::string>& until);
  void extend(const std::string& until, const std::string& path);
  void from(const CheckpointHeader& found);
  bool checkpoint_due(Clock::time_point now) const;
  bool saved(const std::function<void()>& what);
  void append(const RunRecord& record);
  void write_waiting();

  std::string file_;
  Scene scene_;
  JournalHeader header_;
  std::optional<JournalWriter> journal_;
  std::uint64_t records_ = 0, check_ = 0;
  GrowingTables waiting_;  // rows not in the journal yet: it has not begun, or the disk was full
  std::unique_ptr<StateReader> state_;
  std::string over_, not_extended_, from_;
  Exit over_status_ = Exit::done;
  std::uint64_t collisions_before_ = 0;  // made in earlier calls

  bool due_ = false, saved_here_ = false, complained_ = false;
  bool up_to_date_ = false;    // the checkpoint, since the last call of `keep` that was to write one
  double seconds_before_ = 0;  // of computing, in earlier calls
  double saving_ = 0;          // seconds, of the last checkpoint
  Clock::time_point started_ = Clock::now(), reported_ = started_, saved_ = started_;
};

}  // namespace cradle::tools
