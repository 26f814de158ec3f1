// What the program does in Python: pictures and reports. The program contains the package tools/python/cradle, so both
// work wherever the program is installed.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/store/unfinished.hpp"

namespace cradle::tools {

namespace {

struct PageArguments {
  std::string file, output;
  bool forced = false;
};

// A temporary folder, removed with its files by the destructor. Throws Error (Exit::io) if it cannot be made.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code failed;
    path_ = (std::filesystem::temp_directory_path(failed) / "cradle-XXXXXX").string();
    if (failed || ::mkdtemp(path_.data()) == nullptr) throw no_room();
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;

  const std::string& path() const { return path_; }
  // Makes missing folders in the name.
  void write(std::string_view name, std::string_view text) const {
    const auto file = std::filesystem::path(path_) / name;
    std::error_code failed;
    std::filesystem::create_directories(file.parent_path(), failed);
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush()) throw no_room();
  }

 private:
  Error no_room() const { return {{path_}, "no temporary files", "", "make room on the disk or set TMPDIR", Exit::io}; }

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

// The first Python that has the packages for pictures; python3 may not have them. It only searches for the packages:
// importing them would take longer than some pictures. Its answer is a status that other programs do not give.
std::string find_python() {
  std::vector<std::string> candidates{"python3", "/usr/bin/python3"};
  if (const char* chosen = std::getenv("CRADLE_PYTHON")) candidates = {chosen};
  const std::string probe = "import sys; from importlib.util import find_spec; "
                            "sys.exit(42 * all(map(find_spec, ('h5py', 'matplotlib', 'numpy'))))";
  for (const auto& python : candidates)
    if (execute({python, "-c", probe}, true) == 42) return python;
  throw Error({}, "no Python with h5py and matplotlib", fmt::format("tried {}", fmt::join(candidates, ", ")),
              "install python3-h5py and python3-matplotlib (Debian's names), or set CRADLE_PYTHON to one that has them",
              Exit::io);
}

// The output for fig2.h5 and for fig2.h5.part is fig2.html.
std::string output_beside(std::filesystem::path file, const char* extension) {
  if (file.extension() == ".part") file.replace_extension();
  return file.replace_extension(extension).string();
}

// Runs the package's `cradle COMMAND FILE -o OUTPUT [--force]` from a temporary folder. Returns its status if that is
// one of bad input or files. The default output is FILE without .part and with another extension. `what` names the
// product ("the picture"). Throws Error (Exit::io) if FILE is damaged or no suitable Python is found.
Exit run_python(const std::string& command, const PageArguments& arguments, const char* extension,
                std::string_view what) {
  const auto& [file, wanted, forced] = arguments;
  if (stored_in(file) == Stored::other) read_result(file, Reading::ends);  // before Python reads a damaged file
  const std::string output = wanted.empty() ? output_beside(file, extension) : wanted;
  file_behind(output);  // throws for a folder or a device
  const TemporaryFolder folder;
  for (const EmbeddedFile& part : python_package()) folder.write(part.name, part.text);
  std::error_code unknown;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (!unknown) ::setenv("CRADLE_PROGRAM", self.c_str(), 1);  // the package calls this program
  std::vector<std::string> words{find_python(), "-B", folder.path() + "/cradle", command, file, "-o", output};
  if (forced) words.push_back("--force");
  const int status = execute(words, false);
  if (status != 0 && status != static_cast<int>(Exit::bad_input) && status != static_cast<int>(Exit::io))
    throw Error({file}, fmt::format("{} could not be made", what), fmt::format("status {}", status),
                "see the message above", Exit::io);
  return static_cast<Exit>(status);
}

void add_page_options(Command& command, PageArguments& arguments, const std::string& output) {
  command.argument("FILE", arguments.file, "result file, or FILE.part of a run in progress");
  command.option("-o,--output", arguments.output, output);
  command.flag("--force", arguments.forced, "replace what is there, also what was not made from FILE");
}

}  // namespace

void add_plot(CommandLine& program) {
  Command command = program.add("plot", "the pictures of a result file; PNG, PDF or SVG by extension",
                                "cradle plot fig2.h5 -o fig2.pdf");
  const auto plot = [](const PageArguments& given) { return run_python("plot", given, ".png", "the picture"); };
  add_page_options(command, command.runs<PageArguments>(plot), "picture (default: FILE with .png)");
}

void add_report(CommandLine& program) {
  Command command = program.add("report", "one page about a result: pictures, numbers, provenance, how to run it again",
                                "cradle report fig2.h5 -o fig2.html");
  const auto report = [](const PageArguments& given) { return run_python("report", given, ".html", "the report"); };
  add_page_options(command, command.runs<PageArguments>(report), "the page (default: FILE with .html)");
  command.note("One HTML file with everything in it: it needs no network, and can be sent.");
}

// Prints cite.bib of the package, which reports quote too.
void add_cite(CommandLine& program) {
  Command command = program.add("cite", "the paper and the program as BibTeX", "cradle cite >> my.bib");
  command.does([] {
    for (const EmbeddedFile& file : python_package())
      if (file.name == "cradle/cite.bib") fmt::print("{}", file.text);
    return Exit::done;
  });
}

}  // namespace cradle::tools
