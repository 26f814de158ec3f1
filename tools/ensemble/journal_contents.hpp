// What a journal of replicas holds, without running anything.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace cradle::tools {

struct JournalContents {
  std::vector<std::pair<std::string, std::string>> scenes;  // of each ensemble: its group, and the scene as TOML
  std::vector<std::uint64_t> replicas;                      // of each ensemble
  std::uint64_t torn_bytes = 0;                             // at the end: what a kill has left of a record
};
/// Throws Error (Exit::io).
JournalContents read_journal_contents(const std::string& path);

}  // namespace cradle::tools
