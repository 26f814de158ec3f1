// What a journal of replicas holds, without running anything.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/core/ensemble/ensemble.hpp"
#include "cradle/tools/ensemble/study.hpp"

namespace cradle::tools {

struct JournalContents {
  std::uint64_t identity = 0;
  std::string kind;         // "ensemble" or "sweep"
  std::string scene, name;  // the file's, as TOML
  std::vector<SpreadRequest> spreads;
  ReplicaRange wanted = {};                                 // of each ensemble
  std::vector<std::pair<std::string, std::string>> scenes;  // of each ensemble: its group, and the scene as TOML
  std::vector<std::uint64_t> replicas;                      // of each ensemble, finished
  std::uint64_t torn_bytes = 0;                             // at the end: what a kill has left of a record
};
/// Throws Error (Exit::io).
JournalContents read_journal_contents(const std::string& path);

/// The header alone, and what it is read from.
JournalContents header_in(std::string_view header);
std::string header_of(const Study& study, ReplicaRange wanted);

/// What is being studied. Throws Error (Exit::io) naming the journal.
Study study_in(const JournalContents& journal, const std::string& path);

}  // namespace cradle::tools
