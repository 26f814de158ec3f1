#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/commands/python.hpp"

namespace cradle::tools {

void add_plot(CommandLine& program) {
  Command command = program.add("plot", "the pictures of a result file; PNG, PDF or SVG by extension",
                                "cradle plot fig2.h5 -o fig2.pdf");
  const auto arguments = std::make_shared<PageArguments>();
  command.argument("FILE", arguments->file, "result file, or FILE.part of a run in progress");
  command.option("-o,--output", arguments->output, "picture (default: FILE with .png)");
  command.flag("--force", arguments->forced, "replace what is there, also what was not made from FILE");
  command.does([arguments] { return run_python("plot", *arguments, ".png", "the picture"); });
}

}  // namespace cradle::tools
