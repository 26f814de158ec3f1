#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

namespace {

struct Options {
  std::string file, folder;
};

// One line per row, as many digits as it takes to read the same number back. Columns that are shorter (gaps of n
// bodies) leave their last fields empty; attributes come first, as comments.
std::string csv(const Group& group) {
  std::string text;
  for (const auto& [name, value] : group.attributes)
    text += std::visit([&](const auto& v) { return fmt::format("# {} = {}\n", name, v); }, value);
  std::size_t rows = 0;
  std::string separator;
  const auto append = [&](const std::string& cell) {
    text += separator + cell;
    separator = ",";
  };
  for (const auto& column : group.columns) {
    for (std::size_t i = 0; i < column.width; ++i)
      append(column.width > 1 ? fmt::format("{}[{}]", column.name, i) : column.name);
    rows = std::max(rows, column.rows());
  }
  if (!group.columns.empty()) text += '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    separator.clear();
    for (const auto& column : group.columns)
      for (std::size_t i = 0; i < column.width; ++i)
        append(
            row < column.rows()
                ? std::visit([&](const auto& v) { return fmt::format("{}", v[row * column.width + i]); }, column.values)
                : std::string());
    text += '\n';
  }
  return text;
}

Exit export_result(const Options& options) {
  const Result result = read_result(options.file);
  for (const auto& group : result.groups) {
    const std::filesystem::path file = std::filesystem::path(options.folder) / (group.name + ".csv");
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    std::ofstream stream(file, std::ios::binary);
    stream << csv(group) << std::flush;
    if (!stream)
      throw Error({file.string(), 0, ""}, "could not be written", "", "give another --to DIR, or make room on the disk",
                  Exit::io);
    fmt::print("{}\n", file.string());
  }
  return Exit::done;
}

}  // namespace

void add_export(CommandLine& program) {
  Command command = program.add("export", "a result as CSV, one file per group", "cradle export fig2.h5 --to fig2");
  const auto options = std::make_shared<Options>();
  command.argument("FILE", options->file, "result file");
  command.option("--to", options->folder, "folder to write to; made where it is missing", Needed::yes);
  command.does([options] { return export_result(*options); });
}

}  // namespace cradle::tools
