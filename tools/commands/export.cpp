#include <fmt/format.h>

#include <filesystem>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/store/run_files.hpp"

namespace cradle::tools {

namespace {

struct ExportArguments {
  std::string file, folder, result;
  bool forced = false;
};

Exit export_result(const ExportArguments& options) {
  if (options.folder.empty() && options.result.empty())
    throw Error({}, "nothing to export to", "", "give --to DIR, --result FILE or both");
  const bool in_progress = stored_in(options.file) == Stored::journal;
  const Result result =
      in_progress ? result_so_far(read_run_journal(options.file), options.file) : read_result(options.file);
  if (!options.result.empty()) {
    check_overwrite(options.result, result, options.forced ? Force::yes : Force::no);
    write_result(result, options.result);
    fmt::print("{}\n", options.result);
  }
  std::string name = std::filesystem::path(options.file).filename().string();
  if (name.ends_with(".part")) name.resize(name.size() - std::string_view(".part").size());
  if (!options.folder.empty())
    for (const std::string& file : export_csv(result, options.folder, name, options.forced)) fmt::print("{}\n", file);
  return Exit::done;
}

}  // namespace

void add_export(CommandLine& program) {
  Command command = program.add("export", "a result as CSV, one file per group", "cradle export fig2.h5 --to fig2");
  auto& options = command.runs<ExportArguments>(export_result);
  command.argument("FILE", options.file, "result file, or FILE.part of a run in progress");
  command.option("--to", options.folder, "folder to write to; made where it is missing");
  command.option("--result", options.result, "result file to write: of FILE.part what is recorded so far");
  command.flag("--force", options.forced, "replace what is there, also what was not exported from FILE");
}

}  // namespace cradle::tools
