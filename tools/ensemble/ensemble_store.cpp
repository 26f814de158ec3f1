#include "cradle/tools/ensemble/ensemble_store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "cradle/tools/result/files.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

namespace {

std::string plural(std::uint64_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

std::string spreads_text(const std::vector<SpreadRequest>& spreads) {
  std::string text;
  for (const auto& [name, bins] : spreads)
    text += fmt::format("{}--spread {}={}:{}:{}", text.empty() ? "" : " ", name, bins.from, bins.to, bins.bins);
  return text.empty() ? "no --spread" : text;
}

std::string describe(const std::vector<ReplicaRange>& ranges) {
  const std::string several = ranges.size() > 1 ? fmt::format("{} ranges, ", ranges.size()) : "";
  return fmt::format("{}{} to {}", several, ranges.front().first, ranges.back().end() - 1);
}

}  // namespace

EnsembleStore::EnsembleStore(Study study, std::string file)
    : study_(std::move(study)), file_(std::move(file)), part_(file_ + ".part"), identity_(study_.identity()),
      states_(empty_states()) {}

EnsembleStates EnsembleStore::empty_states() const {
  EnsembleStates states;
  for (const auto& [group, scene] : study_.points)
    states.push_back(std::make_unique<EnsembleState>(group, scene, study_.spreads));
  return states;
}

// ---- reading the result and the journals of all ranks

void EnsembleStore::check_identity(const JournalHeader& there, const std::string& path, const char* otherwise) const {
  if (there.identity == identity_) return;
  const auto& points = there.points;
  std::string found = points.size() == study_.points.size() ? "" : plural(points.size(), "ensemble");
  for (std::size_t k = 0; k < points.size() && found.empty(); ++k)
    found = scene_difference(parse_scene(points[k].second, path), study_.points[k].scene);
  if (found.empty() && there.spreads != study_.spreads)
    found = fmt::format("{}, here {}", spreads_text(there.spreads), spreads_text(study_.spreads));
  if (found.empty()) found = "another version of the program, or other listed particles";
  throw Error({path}, "holds ensembles of something else", found, otherwise);
}

void EnsembleStore::load_result(const char* otherwise) {
  const Result result = read_result(file_);
  check_identity(header_in(result, file_, otherwise), file_, otherwise);
  for (const auto& state : states_) state->read(result, file_);
  result_there_ = true;
}

void EnsembleStore::check_replaces(const std::string& file) const {
  if (!std::filesystem::exists(file)) return;
  EnsembleStore there(study_, file);
  there.load_result();
  for (std::size_t k = 0; k < states_.size(); ++k)
    if (!states_[k]->holds_all_of(*there.states_[k]))
      throw Error({file}, "holds replicas that none of the files has", "",
                  "merge it too, give another -o FILE, or --force to replace it");
}

// Whether an interrupted study that was forced is to replace a result of something else: its journal says so.
bool EnsembleStore::replaces_another() const {
  const auto journal = std::filesystem::exists(part_) ? journal_header(part_) : std::nullopt;
  if (!journal || journal->of_run() || journal->identity != identity_) return false;
  try {
    EnsembleStore(study_, file_).load_result();
    return false;
  } catch (const Error& error) {
    return error.status == Exit::bad_input;
  }
}

std::string EnsembleStore::load(Force force) {
  claim_.emplace(file_);
  if (force == Force::yes) {
    drop_journals();
    return "";
  }
  if (std::filesystem::exists(file_) && !replaces_another()) load_result();
  std::string account;
  std::uint64_t whole = 0;
  if (std::filesystem::exists(part_)) {
    account += read_journal(part_, whole);
    journal_.emplace(part_, whole);
  }
  const std::vector<std::string> others = rank_journals();
  for (const std::string& path : others) account += read_journal(path, whole);
  if (!others.empty()) compact();
  for (const std::string& path : others) ::unlink(path.c_str());
  return account;
}

std::string EnsembleStore::read_journal(const std::string& path, std::uint64_t& whole_bytes) {
  JournalReader reader(path);
  const JournalHeader& header = reader.header();
  if (header.of_run())
    throw Error({path}, "the journal of a run", "", "continue it by `cradle resume`, or give another -o FILE",
                Exit::io);
  check_identity(header, path);
  if (wanted_.count == 0) wanted_ = header.wanted;
  EnsembleStates states = empty_states();
  while (auto record = reader.next<EnsembleRecord>()) {
    if (record->point >= states.size())
      throw Error({path}, "a record of no ensemble", fmt::format("number {}", record->point), "remove the file",
                  Exit::io);
    states[record->point]->apply(std::move(*record));
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
      throw Error({from}, "has some replicas in common with other files of this ensemble", "",
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

// ---- while replicas are run

JournalHeader EnsembleStore::header() const {
  JournalHeader header{study_.kind, identity_, effective_toml(study_.scene), study_.scene.name};
  header.wanted = wanted_;
  header.spreads = study_.spreads;
  for (const auto& [group, scene] : study_.points) header.points.emplace_back(group, effective_toml(scene));
  return header;
}

void EnsembleStore::start_journal(unsigned rank, ReplicaRange wanted, std::uint64_t largest) {
  wanted_ = wanted;
  largest_ = std::max(largest, largest_);
  if (rank > 0) part_ += fmt::format(".{}", rank);
  if (rank > 0) return;
  if (journal_)
    compact();  // so that a program that continues from it reads what is wanted now
  else
    journal_.emplace(part_, header());
}

// Syncs the journal from time to time, and rewrites it as nodes of the tree when it has become large.
void EnsembleStore::add(EnsembleRecord&& replicas) {
  using namespace std::chrono_literals;
  bool due = false, large = false;
  {
    const std::shared_lock lock(changing_);
    const std::string bytes = to_bytes(replicas);
    std::unique_lock appending(appending_);
    if (!journal_) journal_.emplace(part_, header());
    journal_->append(bytes);
    large = journal_->bytes() > largest_;
    const auto now = std::chrono::steady_clock::now();
    due = now - synced_ > 20s;
    if (due) synced_ = now;
    appending.unlock();
    states_.at(replicas.point)->apply(std::move(replicas));
    if (due && !large) journal_->sync();
  }
  if (large) {
    const std::unique_lock lock(changing_);
    if (journal_->bytes() > largest_) compact();
  }
}

void EnsembleStore::sync() {
  if (journal_) journal_->sync();
}

void EnsembleStore::compact() {
  JournalWriter anew(part_, header(), [this](const JournalWriter::Put& put) { put_records(put); });
  journal_ = std::move(anew);
  largest_ = std::max(largest_, 4 * journal_->bytes());
}

void EnsembleStore::put_records(const JournalWriter::Put& put) const {
  for (std::size_t k = 0; k < states_.size(); ++k) states_[k]->put_records(k, put);
}

void EnsembleStore::apply(std::string_view bytes) {
  auto record = from_bytes<EnsembleRecord>(std::string(bytes));
  states_.at(record.point)->apply(std::move(record));
}

// ---- the result

std::uint64_t EnsembleStore::replicas() const { return replicas_in(states_); }

std::string EnsembleStore::outcome() const {
  EnsembleState::Outcomes outcomes{};
  for (const auto& state : states_) std::ranges::transform(outcomes, state->outcomes(), outcomes.begin(), std::plus());
  std::string text;
  for (std::size_t k = 0; k < outcomes.size(); ++k)
    if (outcomes[k] > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", outcomes[k], run_ends[k].text);
  return text;
}

Result EnsembleStore::result() const {
  Result result;
  result.attributes = provenance(study_.scene, precision_name(study_.scene.run), outcome());
  result.attributes.insert(result.attributes.begin() + 2, {"kind", study_.kind});
  append(result.attributes, {{"replicas", replicas()}, {"identity", identity_}});
  if (study_.kind == "sweep") result.groups.push_back(sweep_summary(study_.scene.sweep, states_));
  for (const auto& state : states_)
    for (Group& group : state->groups()) result.groups.push_back(std::move(group));
  return result;
}

void EnsembleStore::finish() {
  try {
    write_result(result(), file_);
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + "; finished replicas are in " + part_ +
                    ", the same command continues from there",
                error.status);
  }
  drop_journals();
}

void EnsembleStore::drop_journals() {
  journal_.reset();
  ::unlink(part_.c_str());
  for (const std::string& path : rank_journals()) ::unlink(path.c_str());
}

std::unique_ptr<EnsembleStore> merged(const std::vector<std::string>& files) {
  const std::string& first = files.front();
  const Study study = study_in(
      header_in(read_result(first), first, "give a file that `cradle ensemble` or `cradle sweep` wrote"), first,
      {{first},
       "cannot be merged here",
       "another version's file, or a scene that was changed in it",
       "use the program that wrote it"});
  auto all = std::make_unique<EnsembleStore>(study, "");
  for (const std::string& file : files) {
    EnsembleStore one(study, file);
    one.load_result("leave it out, since files of one scene with the same --spread are merged");
    for (std::size_t k = 0; k < all->states().size(); ++k) {
      EnsembleState &into = *all->states()[k], &from = *one.states()[k];
      if (into.holds_any_of(from))
        throw Error({file}, "has replicas that another of the files has too", describe(from.replicas().present()),
                    "merge files of different replicas (--first)");
      into.take(from);
    }
  }
  return all;
}

}  // namespace cradle::tools
