#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/store.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

namespace {

struct Options {
  std::string file;
  bool all = false;
};

std::string text(const std::variant<std::string, double, std::uint64_t>& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

void print_scene(const Scene& scene, bool all) {
  fmt::print("\nscene{}\n", all ? "" : ", where it differs from the defaults");
  for (const auto& [key, value] : values(scene, all)) fmt::print("  {} = {}\n", key, shortened(value));
  fmt::print("\n");
}

Exit info_of_journal(const Options& options) {
  const JournalContents journal = read_journal_contents(options.file);
  fmt::print("journal of an ensemble: the command that was interrupted goes on from here\n");
  if (journal.torn_bytes > 0) fmt::print("{} bytes at its end are damaged\n", journal.torn_bytes);
  for (std::size_t k = 0; k < journal.scenes.size(); ++k) {
    const auto& [group, scene] = journal.scenes[k];
    fmt::print("{}{}{} replicas finished\n", group, group.empty() ? "" : ": ", journal.replicas[k]);
    if (k == 0 || options.all) print_scene(parse_scene(scene, options.file), options.all);
  }
  return Exit::done;
}

// Of ensembles, groups with statistics of one quantity, and what merging needs.
bool is_detail(const Group& group) {
  const bool mean = std::any_of(group.columns.begin(), group.columns.end(),
                                [](const Column& column) { return column.name == "mean"; });
  return mean || group.name.ends_with("ensemble/nodes");
}

// Names of the quantities below a group that there are statistics of.
std::string quantities(const Result& result, const std::string& group) {
  std::string names;
  for (const Group& other : result.groups)
    if (other.name.starts_with(group + "/") && is_detail(other))
      names += (names.empty() ? "" : ", ") + other.name.substr(group.size() + 1);
  return names;
}

Exit info(const Options& options) {
  if (JournalReader::is_journal(options.file)) return info_of_journal(options);
  const Result result = read_result(options.file);
  const Scene scene = scene_in(result.attributes, options.file);
  for (const auto& [name, value] : result.attributes)
    if (name != "scene" && (options.all || value != decltype(value){std::uint64_t{0}}))
      fmt::print("{:<24}{}\n", name, text(value));
  print_scene(scene, options.all);
  for (const auto& group : result.groups) {
    if (is_detail(group) && !options.all) continue;
    std::size_t rows = 0;
    for (const auto& column : group.columns) rows = std::max(rows, column.rows());
    fmt::print("/{:<23} {} x {}", group.name, rows, group.columns.size());
    for (const auto& [name, value] : group.attributes)
      if (name != "scene") fmt::print("  {} = {}", name, text(value));
    fmt::print("\n");
    const std::string below = group.columns.empty() ? std::string() : quantities(result, group.name);
    if (!below.empty()) fmt::print("  mean, sem, min, max of {}\n", below);
    if (group.name == "series" && rows > 0)
      for (const auto& column : group.columns)
        std::visit([&](const auto& v) { fmt::print("  {:<22}{} to {}\n", column.name, v.front(), v.back()); },
                   column.values);
  }
  return Exit::done;
}

}  // namespace

void add_info(CommandLine& program) {
  Command command = program.add("info", "what a result file or journal holds: scene, precision, times, counts",
                                "cradle info fig2.h5");
  const auto options = std::make_shared<Options>();
  command.argument("FILE", options->file, "result file, or FILE.part");
  command.flag("--all", options->all, "also what does not differ from the defaults");
  command.does([options] { return info(*options); });
}

}  // namespace cradle::tools
