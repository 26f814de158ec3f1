#include <filesystem>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/commands/python.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/store/journal.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tools {

namespace {

struct ReportArguments {
  std::string file, output;
};

// fig2.h5 and fig2.h5.part are reported in fig2.html.
std::string page_of(std::filesystem::path file) {
  if (file.extension() == ".part") file.replace_extension();
  return file.replace_extension(".html").string();
}

Exit report(const ReportArguments& options) {
  if (stored_in(options.file) == Stored::other)
    read_result(options.file, Reading::ends);  // or Python would see it damaged
  const std::string output = options.output.empty() ? page_of(options.file) : options.output;
  file_behind(output);  // neither a folder nor a device
  const TemporaryFolder folder;
  return run_python(folder, {"report", options.file, "-o", output}, options.file, "the report");
}

}  // namespace

void add_report(CommandLine& program) {
  Command command = program.add("report", "one page about a result: pictures, numbers, provenance, how to run it again",
                                "cradle report fig2.h5 -o fig2.html");
  const auto options = std::make_shared<ReportArguments>();
  command.argument("FILE", options->file, "result file, or FILE.part of a run in progress");
  command.option("-o,--output", options->output, "the page (default: FILE with .html)");
  command.note("One HTML file with everything in it: it needs no network, and can be sent.");
  command.does([options] { return report(*options); });
}

}  // namespace cradle::tools
