#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/plot/plot_files.hpp"
#include "cradle/tools/result/atomic_file.hpp"
#include "cradle/tools/result/journal.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/run/run_journal.hpp"
#include "cradle/tools/theory/table.hpp"

namespace cradle::tools {

namespace {

struct PlotArguments {
  std::string file, output;
};

// A folder that is gone, with its files, when its owner is.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code missing;
    path_ = (std::filesystem::temp_directory_path(missing) / "cradle-XXXXXX").string();
    if (missing || ::mkdtemp(path_.data()) == nullptr) throw no_room();
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Returns the file's path.
  std::string write(std::string_view name, std::string_view text) const {
    const auto file = std::filesystem::path(path_) / name;
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush()) throw no_room();
    return file.string();
  }

 private:
  Error no_room() const {
    return {{path_, 0, ""}, "no temporary files", "", "make room on the disk or set TMPDIR", Exit::io};
  }

  std::string path_;
};

// Runs a program found on the path and returns its exit status, 127 if there is none.
int execute(const std::vector<std::string>& words, bool silent) {
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    if (silent) {
      const int nowhere = ::open("/dev/null", O_WRONLY);
      ::dup2(nowhere, STDOUT_FILENO);
      ::dup2(nowhere, STDERR_FILENO);
    }
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) < 0 || !WIFEXITED(status)) return 127;
  return WEXITSTATUS(status);
}

// The first Python that has what pictures need; python3 may be one without.
std::string find_python() {
  std::vector<std::string> candidates{"python3", "/usr/bin/python3"};
  if (const char* chosen = std::getenv("CRADLE_PYTHON")) candidates.insert(candidates.begin(), chosen);
  for (const auto& python : candidates)
    if (execute({python, "-c", "import h5py, matplotlib"}, true) == 0) return python;
  throw Error({}, "no Python with h5py and matplotlib", fmt::format("tried {}", fmt::join(candidates, ", ")),
              "install python3-h5py and python3-matplotlib (Debian's names), or set CRADLE_PYTHON to one that has them",
              Exit::io);
}

Exit plot(const PlotArguments& options) {
  const bool on_its_way = JournalReader::kind(options.file) == JournalOf::run;
  const Result result =
      on_its_way ? result_so_far(read_run_journal(options.file), options.file) : read_result(options.file);
  const Scene scene = scene_in(result.attributes, options.file);
  const std::string output =
      options.output.empty() ? std::filesystem::path(options.file).replace_extension(".png").string() : options.output;
  file_behind(output);            // neither a folder nor a device
  const TemporaryFolder program;  // Python runs a folder by its __main__.py
  for (const EmbeddedFile& file : plot_files()) program.write(file.name, file.text);
  const std::string file = on_its_way ? program.write("so_far.h5", file_image(result)) : options.file;
  std::vector<std::string> words{find_python(), "-B", program.path(), file, "-o", output};
  if (const auto table = predictions(scene); !table.empty())
    words.insert(words.end(), {"--theory", program.write("theory.csv", predictions_csv(table))});
  const int status = execute(words, false);
  if (status != 0 && status != static_cast<int>(Exit::bad_input) && status != static_cast<int>(Exit::io))
    throw Error({options.file, 0, ""}, "the picture could not be made", fmt::format("status {}", status),
                "see the message above", Exit::io);
  return static_cast<Exit>(status);
}

}  // namespace

void add_plot(CommandLine& program) {
  Command command = program.add("plot", "the pictures of a result file; PNG, PDF or SVG by extension",
                                "cradle plot fig2.h5 -o fig2.pdf");
  const auto options = std::make_shared<PlotArguments>();
  command.argument("FILE", options->file, "result file, or FILE.part of a run on its way");
  command.option("-o,--output", options->output, "picture (default: FILE with .png)");
  command.does([options] { return plot(*options); });
}

}  // namespace cradle::tools
