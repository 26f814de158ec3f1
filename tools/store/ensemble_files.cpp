// What a store finds on the disk: its result file, its journals, those of other ranks.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/store/ensemble_journal.hpp"
#include "cradle/tools/store/ensemble_store.hpp"

namespace cradle::tools {

namespace {

std::string plural(std::uint64_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

}  // namespace

void EnsembleStore::check_identity(std::uint64_t identity, const std::vector<std::string>& scenes,
                                   const std::string& path) const {
  if (identity == identity_) return;
  std::string found = scenes.size() == study_.points.size() ? "" : plural(scenes.size(), "ensemble");
  for (std::size_t k = 0; k < scenes.size() && found.empty(); ++k)
    found = scene_difference(parse_scene(scenes[k], path), study_.points[k].scene);
  if (found.empty()) found = "another version of the program, other --spread bins or other listed particles";
  throw Error({path, 0, ""}, "holds ensembles of something else", found, "give another -o FILE, or remove this one");
}

void EnsembleStore::load_result() {
  const Result result = read_result(file_);
  const auto is = [&](const auto& attribute) { return attribute.first == "identity"; };
  if (std::none_of(result.attributes.begin(), result.attributes.end(), is))
    throw Error({file_, 0, ""}, "holds no ensemble", "a single run, or another command's result",
                "give another -o FILE, or remove this one");
  std::vector<std::string> scenes;
  for (const Study::Point& point : study_.points) {
    const bool alone = point.group.empty();
    const Group* group = result.find(alone ? "ensemble" : point.group + "/ensemble");
    if (group == nullptr) break;
    scenes.push_back(attribute<std::string>(alone ? result.attributes : group->attributes, "scene", file_));
  }
  check_identity(attribute<std::uint64_t>(result.attributes, "identity", file_), scenes, file_);
  for (const auto& state : states_) state->read(result, file_);
  result_there_ = true;
}

std::string EnsembleStore::load() {
  claim_.emplace(file_);
  if (std::filesystem::exists(file_)) load_result();
  std::string account;
  if (std::filesystem::exists(part_)) {
    journal_.emplace(part_);
    std::uint64_t whole = 0;
    account += read_journal(part_, whole);
    journal_->continue_after(whole);
  }
  const std::vector<std::string> others = rank_journals();
  if (others.empty()) return account;
  std::vector<JournalWriter> claims;
  for (const std::string& path : others) {
    claims.emplace_back(path);
    std::uint64_t whole = 0;
    account += read_journal(path, whole);
  }
  compact();
  for (const std::string& path : others) ::unlink(path.c_str());
  return account;
}

std::string EnsembleStore::read_journal(const std::string& path, std::uint64_t& whole_bytes) {
  JournalReader reader(path, JournalOf::replicas);
  const JournalContents header = header_in(reader.header());
  std::vector<std::string> scenes;
  for (const auto& [group, scene] : header.scenes) scenes.push_back(scene);
  check_identity(header.identity, scenes, path);
  if (wanted_.count == 0) wanted_ = header.wanted;
  EnsembleStates states = empty_states();
  for (std::string record; reader.next(record);) {
    const std::uint64_t point = EnsembleState::point(record);
    if (point >= states.size())
      throw Error({path, 0, ""}, "a record of no ensemble", fmt::format("number {}", point), "remove the file",
                  Exit::io);
    states[point]->apply(record);
  }
  whole_bytes = reader.whole_bytes();
  std::string account = fmt::format("{}: {} taken from there", path, plural(replicas_in(states), "replica"));
  if (reader.torn_bytes() > 0) account += fmt::format("; its end was damaged ({} bytes left out)", reader.torn_bytes());
  take(states, path);
  return account + "\n";
}

void EnsembleStore::take(EnsembleStates& others, const std::string& from) {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (states_[k]->holds_all_of(*others[k])) continue;
    result_there_ = false;
    if (others[k]->holds_all_of(*states_[k]))
      states_[k] = std::move(others[k]);
    else if (!states_[k]->holds_any_of(*others[k]))
      states_[k]->take(*others[k]);
    else
      throw Error({from, 0, ""}, "has some replicas in common with other files of this ensemble", "",
                  "remove those files that do not belong to it", Exit::io);
  }
}

std::vector<std::string> EnsembleStore::rank_journals() const {
  const std::filesystem::path part(part_);
  const std::string begin = part.filename().string() + ".";
  const std::filesystem::path folder = part.has_parent_path() ? part.parent_path() : ".";
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > begin.size() && name.starts_with(begin) &&
        name.find_first_not_of("0123456789", begin.size()) == name.npos)
      found.push_back(part_ + name.substr(begin.size() - 1));
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace cradle::tools
