#include "cradle/tools/ensemble/journal_contents.hpp"

#include <fmt/format.h>

#include "cradle/tools/ensemble/journal.hpp"
#include "cradle/tools/ensemble/state.hpp"

namespace cradle::tools {

JournalContents read_journal_contents(const std::string& path) {
  JournalReader reader(path);
  ByteReader header(reader.header());
  header.integer();  // identity
  JournalContents contents;
  while (!header.empty()) {
    const std::string group = header.text();
    contents.scenes.emplace_back(group, header.text());
  }
  contents.replicas.resize(contents.scenes.size());
  for (std::string record; reader.next(record);) {
    const std::uint64_t point = EnsembleState::point(record);
    if (point >= contents.replicas.size())
      throw Error({path, 0, ""}, "a record of no ensemble", fmt::format("number {}", point), "remove the file",
                  Exit::io);
    contents.replicas[point] += EnsembleState::replicas_in(record);
  }
  contents.torn_bytes = reader.torn_bytes();
  return contents;
}

}  // namespace cradle::tools
