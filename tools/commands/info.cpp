#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string_view>
#include <thread>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/state.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/store/unfinished.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

std::string text(const std::variant<std::string, double, std::uint64_t>& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

// In ensembles: groups with the statistics of one quantity, and groups needed for merging.
bool is_detail(const Group& group) { return group.find("mean") != nullptr || group.name.ends_with("ensemble/nodes"); }

// The names of the quantities below a group that have statistics.
std::string quantities(const Result& result, const std::string& group) {
  std::string names;
  for (const Group& other : result.groups)
    if (other.name.starts_with(group + "/") && is_detail(other))
      names += (names.empty() ? "" : ", ") + other.name.substr(group.size() + 1);
  return names;
}

// Up to the number of a table: "snapshots/" of snapshots/0007.
std::string_view kind_of(const Group& group) {
  const std::string_view name = group.name;
  return name.substr(0, name.find_last_not_of("0123456789") + 1);
}

// NaN stands where there is no such thing, a front on a ring for instance.
template <class X> std::string shown(const X& x) {
  if constexpr (std::floating_point<X>)
    if (std::isnan(x)) return "none";
  return fmt::format("{}", x);
}

std::string first_and_last(const Column& column) {
  return std::visit(
      [&](const auto& v) {
        return v.empty() ? std::string()
                         : fmt::format("  {:<21} {} to {}\n", column.name, shown(v.front()), shown(v.back()));
      },
      column.values);
}

// A scene in lines "key = value"; `all`: also keys at their defaults.
std::string listing(const Scene& scene, bool all) {
  std::string lines = fmt::format("\nscene{}\n", all ? "" : ", where it differs from the defaults");
  for (const auto& [key, value] : values(scene, all)) lines += fmt::format("  {} = {}\n", key, shortened(value));
  return lines + '\n';
}

std::string listing(const Result& result, const Group& group) {
  std::size_t rows = 0;
  for (const auto& column : group.columns) rows = std::max(rows, column.rows());
  std::string lines =
      group.columns.empty() ? "/" + group.name : fmt::format("/{:<23} {} x {}", group.name, rows, group.columns.size());
  for (const auto& [name, value] : group.attributes)
    if (name != "scene") lines += fmt::format("  {} = {}", name, text(value));
  lines += '\n';
  const std::string below = group.columns.empty() ? std::string() : quantities(result, group.name);
  if (!below.empty()) lines += fmt::format("  mean, sem, min, max of {}\n", below);
  if (group.name == "series")
    for (const auto& column : group.columns) lines += first_and_last(column);
  return lines;
}

struct InfoArguments {
  std::string file;
  bool all = false, follow = false;
};

std::string file_of(const std::string& path, std::string_view ending) {
  return path.substr(0, path.size() - (path.ends_with(ending) ? ending.size() : 0));
}

// A record is a run.
Exit info_of_threshold(JournalReader& reader) {
  std::uint64_t runs = 0;
  for (std::string record; reader.next(record);) ++runs;
  fmt::print("journal of a threshold of {}: {} runs; the same command continues it\n", reader.header().name, runs);
  return Exit::done;
}

Exit info_of_study(const InfoArguments& options) {
  JournalReader reader(options.file);
  const JournalHeader& journal = reader.header();
  if (journal.kind == threshold_kind) return info_of_threshold(reader);
  std::vector<std::uint64_t> replicas(journal.points.size());
  while (const auto record = reader.next<EnsembleRecord>())
    if (record->point < replicas.size()) replicas[record->point] += record->rows.size();
  fmt::print("journal of {} {}: `cradle resume {}` continues from here, as does the command that was interrupted\n",
             journal.kind == "ensemble" ? "an" : "a", journal.kind, file_of(options.file, ".part"));
  if (reader.torn_bytes() > 0) fmt::print("{} bytes at its end are damaged\n", reader.torn_bytes());
  for (std::size_t k = 0; k < journal.points.size(); ++k) {
    const auto& [group, scene] = journal.points[k];
    fmt::print("{}{}{} replicas finished\n", group, group.empty() ? "" : ": ", replicas[k]);
    if (k == 0 || options.all) fmt::print("{}", listing(parse_scene(scene, options.file), options.all));
  }
  return Exit::done;
}

std::string line(std::string_view name, const std::string& value) { return fmt::format("{:<24}{}\n", name, value); }

std::string checkpoint_listing(const CheckpointHeader& found, const std::string& path) {
  return line("checkpoint", fmt::format("t = {:.10g}, {} collisions, {:.0f} s of computing, {} bytes", found.time,
                                        found.collisions, found.seconds, std::filesystem::file_size(path)));
}

// Describes the checkpoint, if it exists and belongs to this journal.
std::string checkpoint_listing(const JournalHeader& journal, const std::string& path) {
  if (!std::filesystem::exists(path)) return line("checkpoint", "none yet: `resume` starts anew");
  const StateReader reader(path);
  if (reader.header().run.identity != journal.identity) return line("checkpoint", "of an earlier run");
  return checkpoint_listing(reader.header(), path);
}

Exit info_of_run(const InfoArguments& options) {
  RunJournal journal = read_run_journal(options.file, Reading::ends);
  const Scene scene = scene_of(journal.header, options.file);
  fmt::print("journal of a run: `cradle resume {}` continues it, if it is not running\n",
             file_of(options.file, ".part"));
  if (!journal.statuses.empty()) {
    const RunStatus& now = journal.statuses.back();
    const double until = scene.run.until.value;
    TimeLeft pace;
    pace.add(0, scene.run.start.value);
    for (const RunStatus& status : journal.statuses) pace.add(status.seconds, status.time);
    const auto left = expected_cost(scene).predictable() ? pace.until(until) : std::nullopt;
    fmt::print("{}{}{}{}", line("time", fmt::format("{:.10g} of {:.10g}", now.time, until)),
               line("collisions", fmt::format("{}", now.collisions)),
               line("collisions/s", fmt::format("{:.3g} {}", collisions_per_second(journal.statuses),
                                                now.seconds > 60 ? "over the last minute" : "so far")),
               line("computing", duration(now.seconds) + (left ? fmt::format(", {} left", duration(*left)) : "")));
    for (const auto& [name, value] : {std::pair("smallest gap", now.gap_min), std::pair("closure gap", now.closure_gap),
                                      std::pair("closure speed", now.closure_speed)})
      if (!std::isnan(value)) fmt::print("{}", line(name, fmt::format("{:.6g}", value)));
  }
  fmt::print("{}", checkpoint_listing(journal.header, RunFiles::checkpoint_of(file_of(options.file, ".part"))));
  if (journal.torn_bytes > 0) fmt::print("{} bytes at its end are not whole\n", journal.torn_bytes);
  fmt::print("{}", listing(result_so_far(std::move(journal), options.file), options.file, options.all));
  return Exit::done;
}

Exit info_of_checkpoint(const InfoArguments& options) {
  const StateReader reader(options.file);
  if (reader.header().run.of_run())
    fmt::print("checkpoint of a run: `cradle resume {}` continues from it\n", file_of(options.file, ".checkpoint"));
  else
    fmt::print("checkpoint of a live simulation: cradle.Simulation.load(\"{}\") in Python continues from it\n",
               options.file);
  fmt::print("{}{}", checkpoint_listing(reader.header(), options.file),
             listing(scene_of(reader.header().run, options.file), options.all));
  return Exit::done;
}

Exit info(const InfoArguments& options) {
  if (const auto journal = journal_header(options.file))
    return journal->of_run() ? info_of_run(options) : info_of_study(options);
  if (stored_in(options.file) == Stored::checkpoint) return info_of_checkpoint(options);
  fmt::print("{}", listing(read_result(options.file, Reading::ends), options.file, options.all));
  return Exit::done;
}

// Repeats while the journal exists, which is as long as the run continues.
Exit follow(const InfoArguments& options) {
  using namespace std::chrono_literals;
  const auto in_progress = [&] { return stored_in(options.file) == Stored::journal; };
  if (!in_progress()) return info(options);
  for (;;) {
    fmt::print("{}", ::isatty(STDOUT_FILENO) != 0 ? "\033[H\033[2J" : "");
    try {
      info(options);
    } catch (const Error&) {
      if (in_progress()) throw;  // else the run has ended meanwhile
    }
    std::fflush(stdout);
    std::this_thread::sleep_for(2s);
    if (in_progress()) continue;
    fmt::print("{} is gone: the run is over\n", options.file);
    return Exit::done;
  }
}

}  // namespace

std::string listing(const Result& result, const std::string& file, bool all) {
  const Scene scene = parse_scene(attribute<std::string>(result.attributes, "scene", file), file);
  std::string lines;
  for (const auto& [name, value] : result.attributes)
    if (name != "scene" && (all || value != decltype(value){std::uint64_t{0}}))
      lines += fmt::format("{:<23} {}\n", name, text(value));
  lines += listing(scene, all);
  // Of many tables of one kind the first and the last.
  std::map<std::string_view, std::size_t> of_kind, seen;
  for (const auto& group : result.groups) ++of_kind[kind_of(group)];
  for (const auto& group : result.groups) {
    const std::size_t tables = of_kind[kind_of(group)], k = seen[kind_of(group)]++;
    if (const bool folded = !all && tables > 12; folded && k >= 2 && k + 1 < tables) {
      if (k == 2) lines += fmt::format("... {} more, which --all lists\n", tables - 3);
    } else if (all || !is_detail(group)) {
      lines += listing(result, group);
    }
  }
  return lines;
}

void add_info(CommandLine& program) {
  Command command =
      program.add("info", "what a result file, journal or checkpoint holds: scene, precision, times, counts",
                  "cradle info fig2.h5");
  auto& options = command.runs<InfoArguments>(
      [](const InfoArguments& given) { return given.follow ? follow(given) : info(given); });
  command.argument("FILE", options.file, "result file, FILE.part or FILE.checkpoint");
  command.flag("--all", options.all, "also what does not differ from the defaults");
  command.flag("--follow", options.follow, "of a run in progress: again every two seconds, until it is over");
}

}  // namespace cradle::tools
