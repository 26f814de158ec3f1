#include <fmt/format.h>

#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/journal.hpp"
#include "cradle/tools/ensemble/journal_contents.hpp"
#include "cradle/tools/result/listing.hpp"
#include "cradle/tools/result/reader.hpp"

namespace cradle::tools {

namespace {

struct InfoArguments {
  std::string file;
  bool all = false;
};

Exit info_of_journal(const InfoArguments& options) {
  const JournalContents journal = read_journal_contents(options.file);
  fmt::print("journal of an ensemble: the command that was interrupted goes on from here\n");
  if (journal.torn_bytes > 0) fmt::print("{} bytes at its end are damaged\n", journal.torn_bytes);
  for (std::size_t k = 0; k < journal.scenes.size(); ++k) {
    const auto& [group, scene] = journal.scenes[k];
    fmt::print("{}{}{} replicas finished\n", group, group.empty() ? "" : ": ", journal.replicas[k]);
    if (k == 0 || options.all) fmt::print("{}", listing(parse_scene(scene, options.file), options.all));
  }
  return Exit::done;
}

Exit info(const InfoArguments& options) {
  if (JournalReader::is_journal(options.file)) return info_of_journal(options);
  fmt::print("{}", listing(read_result(options.file, Reading::ends), options.file, options.all));
  return Exit::done;
}

}  // namespace

void add_info(CommandLine& program) {
  Command command = program.add("info", "what a result file or journal holds: scene, precision, times, counts",
                                "cradle info fig2.h5");
  const auto options = std::make_shared<InfoArguments>();
  command.argument("FILE", options->file, "result file, or FILE.part");
  command.flag("--all", options->all, "also what does not differ from the defaults");
  command.does([options] { return info(*options); });
}

}  // namespace cradle::tools
