#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result.hpp"

namespace cradle::tools {

namespace {

struct Options {
  std::string file;
  bool all = false;
};

std::string text(const std::variant<std::string, double, std::uint64_t>& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

Exit info(const Options& options) {
  const Result result = read_result(options.file);
  const Scene scene = parse_scene(attribute<std::string>(result.attributes, "scene", options.file), options.file);
  for (const auto& [name, value] : result.attributes)
    if (name != "scene" && (options.all || value != decltype(value){std::uint64_t{0}}))
      fmt::print("{:<24}{}\n", name, text(value));
  fmt::print("\nscene{}\n", options.all ? "" : ", where it differs from the defaults");
  for (const auto& [key, value] : values(scene, options.all)) fmt::print("  {} = {}\n", key, value);
  fmt::print("\n");
  for (const auto& group : result.groups) {
    std::size_t rows = 0;
    for (const auto& column : group.columns) rows = std::max(rows, column.rows());
    fmt::print("/{:<23}{} x {}", group.name, rows, group.columns.size());
    for (const auto& [name, value] : group.attributes) fmt::print("  {} = {}", name, text(value));
    fmt::print("\n");
    if (group.name == "series" && rows > 0)
      for (const auto& column : group.columns)
        std::visit([&](const auto& v) { fmt::print("  {:<22}{} to {}\n", column.name, v.front(), v.back()); },
                   column.values);
  }
  return Exit::done;
}

}  // namespace

void add_info(CLI::App& program, Action& action) {
  auto* command = program.add_subcommand("info", "what a result file holds: scene, precision, times, counts");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->file, "result file")->required();
  command->add_flag("--all", options->all, "also what does not differ from the defaults");
  command->callback([&action, options] { action = [options] { return info(*options); }; });
}

}  // namespace cradle::tools
