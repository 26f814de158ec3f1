#include <fmt/format.h>

#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/csv.hpp"
#include "cradle/tools/result/reader.hpp"

namespace cradle::tools {

namespace {

struct ExportArguments {
  std::string file, folder;
};

Exit export_result(const ExportArguments& options) {
  for (const std::string& file : export_csv(read_result(options.file), options.folder)) fmt::print("{}\n", file);
  return Exit::done;
}

}  // namespace

void add_export(CommandLine& program) {
  Command command = program.add("export", "a result as CSV, one file per group", "cradle export fig2.h5 --to fig2");
  const auto options = std::make_shared<ExportArguments>();
  command.argument("FILE", options->file, "result file");
  command.option("--to", options->folder, "folder to write to; made where it is missing", Needed::yes);
  command.does([options] { return export_result(*options); });
}

}  // namespace cradle::tools
