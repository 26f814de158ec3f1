#include <fmt/format.h>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

struct ResumeArguments : RunningOptions {
  std::string file;
  std::optional<std::string> until;
};

Exit resume(const ResumeArguments& options) {
  std::string file = options.file;
  for (const std::string_view ending : {".part", ".checkpoint"})
    if (file.ends_with(ending)) file.resize(file.size() - ending.size());
  if (options.until && !plain_decimal(*options.until))
    throw Error({"--until", 0, ""}, "not a number", *options.until, "give a time");
  const std::string path = RunFiles::journal_of(file);
  if (const auto journal = journal_header(path); journal && !journal->of_run()) {
    if (journal->kind == threshold_kind)
      throw Error({path}, "a search for a threshold", journal->name, "repeat its command, which continues it");
    if (options.until)
      throw Error({"--until", 0, ""}, "an ensemble has no later end", *options.until, "give it a file of its own");
    return run_study_command(options.quiet, [&] {
      const Error damaged({path}, "its scenes are not those of its replicas", "another identity",
                          "take it from a copy, or remove it", Exit::io);
      return StudyPlan{study_in(*journal, path, damaged), {journal->wanted, options.threads, options.show()}, file};
    });
  }
  Interrupt interrupt;
  note_signals(interrupt);
  const FileClaim claim(file);
  RunFiles files(file, options.until);
  if (!files.over().empty()) {
    if (!options.quiet) fmt::print("{}\n", files.over());
    return files.over_status();
  }
  if (!options.quiet) {
    notify(files.not_extended());
    fmt::print("{}: {}\n", file,
               files.resumed_from().empty() ? "nothing to continue from, the run begins again"
                                            : "continuing from " + files.resumed_from());
  }
  return run_command(files, file, options, interrupt, options.quiet ? "" : expected_warning(files.scene()));
}

}  // namespace

void add_resume(CommandLine& program) {
  Command command =
      program.add("resume", "continue a run or an ensemble that was stopped; the result is byte-identical",
                  "cradle resume fig2.h5 --until 8000");
  auto& options = command.runs<ResumeArguments>(resume);
  command.argument("FILE", options.file,
                   "its result file, there or not yet; FILE.part and FILE.checkpoint are beside it");
  command.option("--until", options.until, "a later end, also of a run that is finished; samples keep their spacing");
  add_running_options(command, options);
}

}  // namespace cradle::tools
