#include "cradle/tools/store/ensemble_store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/store/ensemble_journal.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

EnsembleStore::EnsembleStore(Study study, std::string file)
    : study_(std::move(study)), file_(std::move(file)), part_(file_ + ".part"), identity_(study_.identity()),
      states_(empty_states()) {}

EnsembleStates EnsembleStore::empty_states() const {
  EnsembleStates states;
  for (const auto& [group, scene] : study_.points)
    states.push_back(std::make_unique<EnsembleState>(group, scene, study_.spreads));
  return states;
}

// ---- while replicas are being run

std::string EnsembleStore::journal_header() const { return header_of(study_, wanted_); }

void EnsembleStore::start_journal(unsigned rank, ReplicaRange wanted, std::uint64_t largest) {
  wanted_ = wanted;
  largest_ = std::max(largest, largest_);
  if (rank > 0) part_ += fmt::format(".{}", rank);
  journalling_ = true;
  if (rank > 0) return;
  if (journal_)
    compact();  // whoever continues from it takes what is wanted now
  else
    journal_.emplace(part_, JournalOf::replicas, journal_header());
}

void EnsembleStore::journal(std::string_view record) {
  if (!journalling_) return;
  const std::scoped_lock lock(appending_);
  if (!journal_) journal_.emplace(part_, JournalOf::replicas, journal_header());
  journal_->append(record);
}

void EnsembleStore::add(std::size_t point, const ReplicaRow& row, std::vector<double> values) {
  {
    const std::shared_lock lock(changing_);
    journal(EnsembleState::record(point, row, values));
    states_.at(point)->add(row, std::move(values));
  }
  if (journalling_) keep_safe();
}

// To the disk now and then, and as nodes where a journal of replicas would grow too large.
void EnsembleStore::keep_safe() {
  using namespace std::chrono_literals;
  bool due = false, large = false;
  {
    const std::scoped_lock lock(appending_);
    const auto now = std::chrono::steady_clock::now();
    due = now - synced_ > 20s;
    large = journal_->bytes() > largest_;
    if (due) synced_ = now;
  }
  if (large) {
    const std::unique_lock lock(changing_);
    if (journal_->bytes() > largest_) compact();
  } else if (due) {
    const std::shared_lock lock(changing_);
    journal_->sync();
  }
}

void EnsembleStore::fail(std::size_t point, ReplicaIndex replica, const std::string& message) {
  const std::shared_lock lock(changing_);
  journal(EnsembleState::record(point, replica, message));
  states_.at(point)->fail(replica, message);
}

void EnsembleStore::sync() {
  if (journal_) journal_->sync();
}

void EnsembleStore::compact() {
  JournalWriter anew(part_, JournalOf::replicas, journal_header(),
                     [this](const JournalWriter::Put& put) { put_records(put); });
  journal_ = std::move(anew);
  largest_ = std::max(largest_, 4 * journal_->bytes());
}

void EnsembleStore::put_records(const JournalWriter::Put& put) const {
  for (std::size_t k = 0; k < states_.size(); ++k) states_[k]->put_records(k, put);
}

void EnsembleStore::apply(std::string_view record) { states_.at(EnsembleState::point(record))->apply(record); }

// ---- the result

std::uint64_t EnsembleStore::replicas() const { return replicas_in(states_); }

std::string EnsembleStore::outcome() const {
  EnsembleState::Outcomes outcomes{};
  for (const auto& state : states_) {
    const auto of_state = state->outcomes();
    for (std::size_t k = 0; k < outcomes.size(); ++k) outcomes[k] += of_state[k];
  }
  std::string text;
  for (std::size_t k = 0; k < outcomes.size(); ++k)
    if (outcomes[k] > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", outcomes[k], run_ends[k].text);
  return text;
}

Result EnsembleStore::result() const {
  Result result;
  result.attributes = {{"format_version", format_version},
                       {"cradle_version", std::string(version)},
                       {"kind", study_.kind},
                       {"scene", effective_toml(study_.scene)},
                       {"name", study_.scene.name},
                       {"precision", precision_name(study_.scene.run)},
                       {"outcome", outcome()},
                       {"replicas", replicas()},
                       {"identity", identity_}};
  result.attributes.insert(result.attributes.end(), study_.attributes.begin(), study_.attributes.end());
  if (study_.summary) result.groups = study_.summary(states_);
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

}  // namespace cradle::tools
