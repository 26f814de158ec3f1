#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/listing.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/store/ensemble_journal.hpp"
#include "cradle/tools/store/journal.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/support/progress.hpp"

namespace cradle::tools {

namespace {

struct InfoArguments {
  std::string file;
  bool all = false, follow = false;
};

std::string file_of(const std::string& path, std::string_view ending) {
  return path.substr(0, path.size() - (path.ends_with(ending) ? ending.size() : 0));
}

Exit info_of_journal(const InfoArguments& options) {
  const JournalContents journal = read_journal_contents(options.file);
  fmt::print("journal of {} {}: `cradle resume {}` continues from here, as does the command that was interrupted\n",
             journal.kind == "ensemble" ? "an" : "a", journal.kind, file_of(options.file, ".part"));
  if (journal.torn_bytes > 0) fmt::print("{} bytes at its end are damaged\n", journal.torn_bytes);
  for (std::size_t k = 0; k < journal.scenes.size(); ++k) {
    const auto& [group, scene] = journal.scenes[k];
    fmt::print("{}{}{} replicas finished\n", group, group.empty() ? "" : ": ", journal.replicas[k]);
    if (k == 0 || options.all) fmt::print("{}", listing(parse_scene(scene, options.file), options.all));
  }
  return Exit::done;
}

std::string line(std::string_view name, const std::string& value) { return fmt::format("{:<24}{}\n", name, value); }

// Of one that is there and is this journal's.
std::string checkpoint_listing(const std::string& path, const RunHeader* journal) {
  if (!std::filesystem::exists(path)) return line("checkpoint", "none yet: `resume` starts anew");
  StateReader reader(path);
  const CheckpointHeader found = read_checkpoint(reader, path);
  if (journal != nullptr && found.run.number != journal->number) return line("checkpoint", "of a run before");
  return line("checkpoint", fmt::format("t = {:.10g}, {} collisions, {:.0f} s of computing, {} bytes", found.time,
                                        found.collisions, found.seconds, std::filesystem::file_size(path)));
}

Exit info_of_run(const InfoArguments& options) {
  RunJournal journal = read_run_journal(options.file, Reading::ends);
  const Scene scene = scene_of(journal.header, options.file);
  fmt::print("journal of a run: `cradle resume {}` continues it, if it is not running\n",
             file_of(options.file, ".part"));
  if (!journal.statuses.empty()) {
    const RunStatus& now = journal.statuses.back();
    const double start = scene.run.start.value, until = scene.run.until.value;
    const double left = now.time > start ? now.seconds * (until - now.time) / (now.time - start) : 0;
    fmt::print(
        "{}{}{}{}", line("time", fmt::format("{:.10g} of {:.10g}", now.time, until)),
        line("collisions", fmt::format("{}", now.collisions)),
        line("collisions/s", fmt::format("{:.3g} over the last minute", collisions_per_second(journal.statuses))),
        line("computing", fmt::format("{}, {} left at this pace", duration(now.seconds), duration(left))));
    for (const auto& [name, value] : {std::pair("smallest gap", now.gap_min), std::pair("closure gap", now.closure_gap),
                                      std::pair("closure speed", now.closure_speed)})
      if (!std::isnan(value)) fmt::print("{}", line(name, fmt::format("{:.6g}", value)));
  }
  fmt::print("{}", checkpoint_listing(RunFiles::checkpoint_of(file_of(options.file, ".part")), &journal.header));
  if (journal.torn_bytes > 0) fmt::print("{} bytes at its end are not whole\n", journal.torn_bytes);
  fmt::print("{}", listing(result_so_far(std::move(journal), options.file), options.file, options.all));
  return Exit::done;
}

Exit info_of_checkpoint(const InfoArguments& options) {
  StateReader reader(options.file);
  const CheckpointHeader found = read_checkpoint(reader, options.file);
  fmt::print("checkpoint of a run: `cradle resume {}` continues from it\n", file_of(options.file, ".checkpoint"));
  fmt::print("{}{}", line("cradle_version", found.run.version), checkpoint_listing(options.file, nullptr));
  fmt::print("{}", listing(scene_of(found.run, options.file), options.all));
  return Exit::done;
}

Exit info(const InfoArguments& options) {
  const auto kind = JournalReader::kind(options.file);
  if (kind == JournalOf::replicas) return info_of_journal(options);
  if (kind == JournalOf::run) return info_of_run(options);
  if (StateReader::is_state(options.file)) return info_of_checkpoint(options);
  fmt::print("{}", listing(read_result(options.file, Reading::ends), options.file, options.all));
  return Exit::done;
}

// As long as the run continues, its journal is there.
Exit follow(const InfoArguments& options) {
  using namespace std::chrono_literals;
  if (!JournalReader::kind(options.file)) return info(options);
  for (;;) {
    fmt::print("{}", ::isatty(STDOUT_FILENO) != 0 ? "\033[H\033[2J" : "");
    try {
      info(options);
    } catch (const Error&) {
      if (JournalReader::kind(options.file)) throw;  // else the run has ended meanwhile
    }
    std::fflush(stdout);
    std::this_thread::sleep_for(2s);
    if (JournalReader::kind(options.file)) continue;
    fmt::print("{} is gone: the run is over\n", options.file);
    return Exit::done;
  }
}

}  // namespace

void add_info(CommandLine& program) {
  Command command =
      program.add("info", "what a result file, journal or checkpoint holds: scene, precision, times, counts",
                  "cradle info fig2.h5");
  const auto options = std::make_shared<InfoArguments>();
  command.argument("FILE", options->file, "result file, FILE.part or FILE.checkpoint");
  command.flag("--all", options->all, "also what does not differ from the defaults");
  command.flag("--follow", options->follow, "of a run in progress: again every two seconds, until it is over");
  command.does([options] { return options->follow ? follow(*options) : info(*options); });
}

}  // namespace cradle::tools
