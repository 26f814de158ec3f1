#include <fmt/format.h>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/commands/python.hpp"

namespace cradle::tools {

namespace {

// Reports quote this file, too.
Exit cite() {
  for (const EmbeddedFile& file : python_package())
    if (file.name == "cradle/cite.bib") fmt::print("{}", file.text);
  return Exit::done;
}

}  // namespace

void add_cite(CommandLine& program) {
  Command command = program.add("cite", "the paper and the program as BibTeX", "cradle cite >> my.bib");
  command.does(cite);
}

}  // namespace cradle::tools
