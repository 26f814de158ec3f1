#include <filesystem>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/commands/python.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/store/run_journal.hpp"
#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/theory/table.hpp"

namespace cradle::tools {

namespace {

struct PlotArguments {
  std::string file, output;
};

Exit plot(const PlotArguments& options) {
  const bool in_progress = stored_in(options.file) == Stored::journal;
  const Result result =
      in_progress ? result_so_far(read_run_journal(options.file), options.file) : read_result(options.file);
  const Scene scene = scene_in(result.attributes, options.file);
  const std::string output =
      options.output.empty() ? std::filesystem::path(options.file).replace_extension(".png").string() : options.output;
  file_behind(output);  // neither a folder nor a device
  const TemporaryFolder folder;
  const std::string file = in_progress ? folder.write("so_far.h5", file_image(result)) : options.file;
  std::vector<std::string> words{"plot", file, "-o", output};
  if (const auto table = predictions(scene); !table.empty())
    words.insert(words.end(), {"--theory", folder.write("theory.csv", predictions_csv(table))});
  return run_python(folder, words, options.file, "the picture");
}

}  // namespace

void add_plot(CommandLine& program) {
  Command command = program.add("plot", "the pictures of a result file; PNG, PDF or SVG by extension",
                                "cradle plot fig2.h5 -o fig2.pdf");
  const auto options = std::make_shared<PlotArguments>();
  command.argument("FILE", options->file, "result file, or FILE.part of a run in progress");
  command.option("-o,--output", options->output, "picture (default: FILE with .png)");
  command.does([options] { return plot(*options); });
}

}  // namespace cradle::tools
