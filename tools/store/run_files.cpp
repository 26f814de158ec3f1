#include "cradle/tools/store/run_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <random>

#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/support/checksum.hpp"
#include "cradle/tools/support/notify.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

constexpr std::uint64_t collisions_between_checks = 1 << 13;  // at the clock
constexpr double status_seconds = 2;
constexpr double worth_keeping = 60;  // seconds of computing that nobody throws away unasked

std::uint64_t drawn_number() {
  std::random_device source;
  return std::uint64_t{source()} << 32 | source();
}

}  // namespace

RunFiles::RunFiles(std::string file, const Scene& scene) : file_(std::move(file)), scene_(scene) {
  const std::string path = journal_of(file_);
  if (JournalReader::kind(path) == JournalOf::run) {
    const RunJournal before = read_run_journal(path, Reading::ends);
    if (!before.statuses.empty() && before.statuses.back().seconds > worth_keeping)
      throw Error(
          {path, 0, ""}, "a run that is not finished",
          fmt::format("t = {:.6g}, {:.0f} s of computing", before.statuses.back().time, before.statuses.back().seconds),
          fmt::format("continue with `cradle resume {}`, or remove it, or give another -o FILE", file_));
  } else if (JournalReader::kind(path)) {
    throw Error({path, 0, ""}, "replicas of an ensemble that is not finished", "",
                fmt::format("continue with `cradle resume {}`, or remove it, or give another -o FILE", file_));
  }
  header_ = {std::string(version), effective_toml(scene), scene.name, scene.output.checkpoint.every_seconds.value,
             drawn_number()};
  journal_.emplace(path, JournalOf::run, header_.bytes(), nullptr, Sync::no);
}

// ---- during the run

double RunFiles::seconds() const {
  return seconds_before_ + std::chrono::duration<double>(Clock::now() - started_).count();
}

void RunFiles::complain(const Error& error) {
  if (!std::exchange(complained_, true))
    tools::notify(fmt::format("{}; what could not be written is kept in memory\n", error.what()));
}

void RunFiles::append(std::string_view record) {
  unwritten_.emplace_back(record);
  try {
    for (; !unwritten_.empty(); unwritten_.pop_front()) {
      journal_->append(unwritten_.front());
      check_ = crc64(unwritten_.front());
      ++records_;
    }
    complained_ = false;
  } catch (const Error& error) {
    complain(error);
  }
}

void RunFiles::add(Group&& rows) {
  const bool none =
      std::all_of(rows.columns.begin(), rows.columns.end(), [](const Column& c) { return c.rows() == 0; });
  if (!none || rows.columns.empty() || !rows.attributes.empty()) append(record_of({rows}));
}

void RunFiles::count(std::uint64_t collisions) {
  if (collisions < next_check_) return;
  next_check_ = collisions + collisions_between_checks;
  check_clock();
}

void RunFiles::check_clock() {
  if (due_) return;
  const Clock::time_point now = Clock::now();
  const auto passed = [&](Clock::time_point since) { return std::chrono::duration<double>(now - since).count(); };
  const double every = header_.every_seconds;
  due_ = passed(reported_) > status_seconds || (every > 0 && passed(saved_) > every);
}

void RunFiles::keep(const RunStatus& status, const std::function<void(StateWriter&)>& save, bool state_too) {
  state_.reset();  // has been loaded
  due_ = false;
  reported_ = Clock::now();
  RunStatus now = status;
  now.seconds = seconds();
  append(record_of(now));
  const double every = header_.every_seconds;
  if (!state_too && !(every > 0 && std::chrono::duration<double>(reported_ - saved_).count() > every)) return;
  saved_ = reported_;
  up_to_date_ = false;
  if (!unwritten_.empty()) return;
  try {
    write_checkpoint(now, save);
    up_to_date_ = saved_here_ = true;
  } catch (const Error& error) {
    complain(error);
  }
}

void RunFiles::write_checkpoint(const RunStatus& status, const std::function<void(StateWriter&)>& save) {
  journal_->sync();
  StateWriter writer(checkpoint_of(file_));
  writer.put(CheckpointHeader::format);
  writer.put(header_.bytes());
  writer.put(records_);
  writer.put(check_);
  writer.put(&status.seconds, sizeof status.seconds);
  writer.put(&status.time, sizeof status.time);
  writer.put(status.collisions);
  save(writer);
  writer.finish();
}

// ---- the end

void RunFiles::finish(Result&& end, RunEnd how) {
  const std::string path = journal_of(file_);
  const auto pieces = [&](const std::function<void(Group &&)>& each) {
    if (for_each_piece(path, each) != records_ - (header_.first_stands_for - 1))
      throw Error({path, 0, ""}, "not what was written", "records are missing",
                  "check the disk; `cradle resume` continues from the last checkpoint", Exit::io);
    for (const std::string& record : unwritten_)
      for (Group& rows : rows_in(record)) each(std::move(rows));
    for (const Group& table : end.groups) each(Group(table));
  };
  Result ends{end.attributes, {}};
  GrowingTables outline(Reading::ends);
  pieces([&](Group&& rows) { outline.add(std::move(rows)); });
  ends.groups = std::move(outline).in_order();
  std::uint64_t numbers = 0;
  for (const Group& table : ends.groups)
    for (const Column& column : table.columns) numbers += column.rows() * column.width;
  if (numbers > most_in_memory) {
    write_in_pieces(
        ends, [&](const auto& put) { pieces([&](Group&& rows) { put(rows); }); }, file_);
  } else {
    GrowingTables tables;
    pieces([&](Group&& rows) { tables.add(std::move(rows)); });
    write_or_keep({end.attributes, std::move(tables).in_order()}, file_);
  }
  journal_.reset();
  ::unlink(path.c_str());
  // What ended otherwise is over, and another run's is of no use here.
  if (how != RunEnd::reached || !saved_here_) ::unlink(checkpoint_of(file_).c_str());
}

}  // namespace cradle::tools
