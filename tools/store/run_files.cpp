#include "cradle/tools/store/run_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <random>

#include "cradle/tools/result/files.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/progress.hpp"

namespace cradle::tools {

namespace {

constexpr std::chrono::seconds between_statuses(2);
constexpr double worth_keeping = 60;  // seconds of computing that a new run must not overwrite
constexpr double least_between = 10;  // savings of a checkpoint: they take a tenth of the time at most
constexpr double soon_repeated = 10;  // seconds of computing for which no checkpoint stays
constexpr std::uint64_t most_waiting = std::uint64_t{1} << 22;  // numbers that are not in a journal that has begun

}  // namespace

std::uint64_t RunFiles::drawn_number() {
  std::random_device source;
  return std::uint64_t{source()} << 32 | source();
}

RunFiles::RunFiles(std::string file, const Scene& scene, Force force)
    : Sink(Tables::for_file), file_(std::move(file)), scene_(scene) {
  const std::string path = journal_of(file_);
  const auto refuse = [&](const char* what, const std::string& found) {
    throw Error({path}, what, found,
                fmt::format("continue with `cradle resume {}`, give another -o FILE, or --force to replace it", file_));
  };
  const auto header = force == Force::yes ? std::nullopt : journal_header(path);
  if (header && !header->of_run()) {
    refuse("work of another command that is not finished", header->kind);
  } else if (header) {
    const auto statuses = read_run_journal(path, Reading::ends).statuses;
    const bool same = header->scene == effective_toml(scene);  // whatever cannot change a result
    if (!statuses.empty() && (!same || statuses.back().seconds > worth_keeping))
      refuse(same ? "a run that is not finished" : "a run of other settings that is not finished",
             fmt::format("t = {:.6g}, {:.0f} s of computing", statuses.back().time, statuses.back().seconds));
  }
  ::unlink(path.c_str());  // of an earlier run, which this one replaces
  header_ = {"run", drawn_number(), effective_toml(scene), scene.name, scene.output.checkpoint.every_seconds.value};
}

// ---- during the run

// Does work that may fail on a full disk, which is reported once.
bool RunFiles::saved(const std::function<void()>& what) {
  try {
    what();
    return true;
  } catch (const Error& error) {
    if (!std::exchange(complained_, true))
      tools::notify(fmt::format("{}; what could not be written is kept in memory\n", error.what()));
    return false;
  }
}

void RunFiles::append(const RunRecord& record) {
  const std::string bytes = to_bytes(record);
  journal_->append(bytes);
  check_ = crc64(bytes);
  ++records_;
}

void RunFiles::write_waiting() {
  if (!journal_) journal_.emplace(journal_of(file_), header_, nullptr, Sync::no);
  if (waiting_.tables().empty()) return;
  RunRecord record(std::move(waiting_.tables()));
  try {
    append(record);
  } catch (...) {
    waiting_.tables() = std::move(std::get<std::vector<Group>>(record));
    throw;
  }
  waiting_ = GrowingTables();
}

void RunFiles::add(Group&& rows) {
  waiting_.add(std::move(rows));
  const std::uint64_t most = journal_ ? most_waiting : most_in_memory;
  if (!complained_ && waiting_.numbers() > most) saved([this] { write_waiting(); });
}

bool RunFiles::checkpoint_due(Clock::time_point now) const {
  const double least = std::max(header_.every_seconds, least_between * saving_);
  return header_.every_seconds > 0 && std::chrono::duration<double>(now - saved_).count() > least;
}

void RunFiles::check_clock() {
  if (due_) return;
  const Clock::time_point now = Clock::now();
  due_ = now - reported_ > between_statuses || checkpoint_due(now);
}

void RunFiles::keep(const RunStatus& status, const std::function<void(StateSink&)>& save, RunIs run_is) {
  state_.reset();  // the run has loaded it
  due_ = false;
  if (run_is == RunIs::over && !journal_ && seconds_before_ == 0) return;  // nothing to lose
  reported_ = Clock::now();
  RunStatus now = status;
  now.seconds = seconds_before_ + std::chrono::duration<double>(reported_ - started_).count();
  const bool written = saved([&] {
    write_waiting();
    append(now);
  });
  if (run_is == RunIs::in_progress && !checkpoint_due(reported_)) return;
  const double soon = header_.every_seconds > 0 ? std::min(header_.every_seconds, soon_repeated) : soon_repeated;
  if (run_is == RunIs::over && !(now.seconds > soon)) {  // computed again rather than extended
    saved_here_ = false;
    return;
  }
  saved_ = reported_;
  up_to_date_ =
      written && saved([&] {
        journal_->sync();
        StateWriter writer(checkpoint_of(file_), {header_, records_, check_, now.seconds, now.time, now.collisions});
        save(writer);
        writer.finish();
      });
  saving_ = std::chrono::duration<double>(Clock::now() - saved_).count();
  saved_here_ = saved_here_ || up_to_date_;
}

// ---- the end

void RunFiles::end(std::vector<Attribute>&& attributes, RunEnd how) {
  if (how == RunEnd::interrupted) return;  // what is to be continued is in the journal
  const std::string path = journal_of(file_);
  // Rows in memory are gone after the last time.
  const auto pieces = [&](bool last_time, const std::function<void(Group &&)>& each) {
    if (journal_ && for_each_piece(path, each) != records_)
      throw Error({path}, "not what was written", "records are missing",
                  "check the disk; `cradle resume` continues from the last checkpoint", Exit::io);
    for (Group& rows : waiting_.tables()) last_time ? each(std::move(rows)) : each(Group(rows));
  };
  const auto gathered = [&](Reading reading) {
    GrowingTables tables(reading);
    pieces(reading == Reading::everything, [&](Group&& rows) { tables.add(std::move(rows)); });
    return Result{attributes, in_order(std::move(tables))};
  };
  // A number takes at least eight bytes in the journal, so few journals must be read twice.
  const std::uint64_t most = (journal_ ? journal_->bytes() / 8 : 0) + numbers_in(waiting_.tables());
  Result whole = gathered(most > most_in_memory ? Reading::ends : Reading::everything);
  if (numbers_in(whole.groups) > most_in_memory) {
    write_in_pieces(
        whole, [&](const auto& put) { pieces(true, [&](Group&& rows) { put(rows); }); }, file_);
  } else {
    if (most > most_in_memory) whole = gathered(Reading::everything);
    write_or_keep(whole, file_);
  }
  journal_.reset();
  ::unlink(path.c_str());
  // A run that ended otherwise cannot be extended, and a checkpoint of another run is useless here.
  if (how != RunEnd::reached || !saved_here_) ::unlink(checkpoint_of(file_).c_str());
}

// ---- reading a journal

RunJournal read_run_journal(const std::string& path, Reading reading) {
  JournalReader records(path);
  if (records.header().kind == threshold_kind)
    throw Error({path}, "runs of a threshold that is not found yet", records.header().name,
                "repeat its command, which continues it", Exit::io);
  if (!records.header().of_run())
    throw Error({path}, "replicas that are not finished, no statistics yet", "",
                fmt::format("`cradle resume {}` continues with them, `cradle info {}` prints how many are finished",
                            path.substr(0, path.rfind(".part")), path),
                Exit::io);
  RunJournal journal{records.header(), {}, {}, 0};
  GrowingTables tables(reading);
  while (auto record = records.next<RunRecord>()) {
    if (const auto* status = std::get_if<RunStatus>(&*record)) {
      journal.statuses.push_back(*status);
      continue;
    }
    try {
      for (Group& rows : std::get<std::vector<Group>>(*record)) tables.add(std::move(rows));
    } catch (const Error& error) {
      throw Error(path + ": " + error.what(), Exit::io);
    }
  }
  journal.torn_bytes = records.torn_bytes();
  journal.tables = in_order(std::move(tables));
  return journal;
}

std::uint64_t for_each_piece(const std::string& path, const std::function<void(Group&& rows)>& each) {
  JournalReader records(path);
  std::uint64_t count = 0;
  for (; auto record = records.next<RunRecord>(); ++count)
    if (auto* pieces = std::get_if<std::vector<Group>>(&*record))
      for (Group& rows : *pieces) each(std::move(rows));
  return count;
}

Scene scene_of(const JournalHeader& header, const std::string& path) {
  Scene scene = parse_scene(header.scene, path);
  scene.name = header.name;
  return scene;
}

Result result_so_far(RunJournal&& journal, const std::string& path) {
  const Scene scene = scene_of(journal.header, path);
  return {provenance(scene, precision_name(scene.run), "in progress"), std::move(journal.tables)};
}

double collisions_per_second(const std::vector<RunStatus>& statuses) {
  constexpr double minute = 60;
  if (statuses.empty()) return 0;
  const RunStatus& now = statuses.back();
  RunStatus before;  // the start
  for (const RunStatus& status : statuses)
    if (status.seconds < now.seconds - minute) before = status;
  const double seconds = now.seconds - before.seconds;
  return seconds > 0 ? static_cast<double>(now.collisions - before.collisions) / seconds : 0;
}

}  // namespace cradle::tools
