#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/commands/python.hpp"

namespace cradle::tools {

void add_report(CommandLine& program) {
  Command command = program.add("report", "one page about a result: pictures, numbers, provenance, how to run it again",
                                "cradle report fig2.h5 -o fig2.html");
  const auto arguments = std::make_shared<PageArguments>();
  command.argument("FILE", arguments->file, "result file, or FILE.part of a run in progress");
  command.option("-o,--output", arguments->output, "the page (default: FILE with .html)");
  command.note("One HTML file with everything in it: it needs no network, and can be sent.");
  command.flag("--force", arguments->forced, "replace what is there, also what was not made from FILE");
  command.does([arguments] { return run_python("report", *arguments, ".html", "the report"); });
}

}  // namespace cradle::tools
