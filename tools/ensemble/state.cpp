#include "cradle/tools/ensemble/state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>

namespace cradle::tools {

void ReplicaTable::add(const ReplicaRow& row) {
  integers_.insert(integers_.end(), {row.index, static_cast<std::uint64_t>(row.outcome), row.collisions, row.merges});
  for (std::size_t k = 0; k < width_; ++k) numbers_.push_back(k < row.numbers.size() ? row.numbers[k] : missing);
}

ReplicaRow ReplicaTable::operator[](std::size_t k) const {
  const auto numbers = std::span(numbers_).subspan(k * width_, width_);
  const auto of_row = std::span(integers_).subspan(k * integers, integers);
  return {of_row[0], static_cast<RunEnd>(of_row[1]), of_row[2], of_row[3], {numbers.begin(), numbers.end()}};
}

std::vector<std::size_t> ReplicaTable::order() const {
  std::vector<std::size_t> rows(size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::sort(rows, {}, [&](std::size_t row) { return integers_[row * integers]; });
  return rows;
}

EnsembleState::EnsembleState(std::string group, Scene scene, const std::vector<SpreadRequest>& spreads)
    : group_(std::move(group)), scene_(std::move(scene)), layout_(replica_layout(scene_)),
      table_(layout_.numbers.size()) {
  for (const SpreadRequest& request : spreads) {
    const auto found = std::ranges::find(layout_.quantities, request.name,
                                         [](const Quantity& of) { return of.group + "/" + of.name; });
    if (found == layout_.quantities.end()) {
      std::vector<std::string> names;  // of profiles those of the first time
      for (const Quantity& of : layout_.quantities)
        if (!of.group.starts_with("profiles/") || of.group == "profiles/0000")
          names.push_back(of.group == "series" ? of.name : of.group + "/" + of.name);
      throw Error({"--spread", 0, ""}, "nothing of this name in the series or profiles", request.name,
                  fmt::format("choose one of {}", fmt::join(names, ", ")));
    }
    spreads_.push_back({*found, Histograms(request.bins, found->size())});
  }
}

EnsembleState::Outcomes EnsembleState::outcomes() const {
  const std::scoped_lock lock(mutex_);
  Outcomes counts{};
  for (std::size_t k = 0; k < table_.size(); ++k) ++counts.at(static_cast<std::size_t>(table_[k].outcome));
  return counts;
}

std::map<ReplicaIndex, std::string> EnsembleState::failures() const {
  const std::scoped_lock lock(mutex_);
  std::map<ReplicaIndex, std::string> failures = messages_;
  for (std::size_t k = 0; k < table_.size(); ++k)
    if (end_row(table_[k].outcome).status == Exit::lost && table_[k].outcome != RunEnd::failed)
      failures.emplace(table_[k].index, end_row(table_[k].outcome).text);
  return failures;
}

bool EnsembleState::holds_all_of(const EnsembleState& other) const {
  return std::ranges::all_of(other.tree_.present(), [this](const auto& range) { return tree_.missing(range).empty(); });
}

bool EnsembleState::holds_any_of(const EnsembleState& other) const {
  return std::ranges::any_of(other.tree_.present(), [this](const auto& range) { return tree_.overlaps(range); });
}

void EnsembleState::take(EnsembleState& other) {
  for (std::size_t k = 0; k < other.table_.size(); ++k) table_.add(other.table_[k]);
  messages_.merge(other.messages_);
  kept_.merge(other.kept_);
  for (std::size_t k = 0; k < spreads_.size(); ++k) spreads_[k].counts.add(other.spreads_[k].counts);
  for (TreeNode& node : other.tree_.nodes()) tree_.add(std::move(node));
}

void EnsembleState::check_length(std::size_t entries) const {
  if (entries != layout_.entries)
    throw Error({}, "an ensemble of other quantities", fmt::format("{} numbers a replica", entries),
                fmt::format("this version records {}: use the program that wrote it", layout_.entries), Exit::io);
}

namespace {

Error damaged(const std::string& from, const std::string& found) {
  return {{from, 0, ""}, "a damaged ensemble", found, "take it from a copy, or run it again", Exit::io};
}

}  // namespace

void EnsembleState::take(TreeNode&& node, const std::string& from) {
  const Moments& m = node.moments;
  const auto wrong = [&](const std::string& found) { return damaged(from, found); };
  if (node.level > 62 || m.replicas > node.range().count)
    throw wrong(fmt::format("{} replicas in a node of level {}", m.replicas, node.level));
  if (m.replicas > 0) check_length(m.entries());
  for (const std::size_t size : {m.squares.size(), m.least.size(), m.greatest.size()})
    if (size != m.entries()) throw wrong("statistics of different lengths");
  if (!m.counts.empty() && (m.counts.size() != m.entries() ||
                            std::any_of(m.counts.begin(), m.counts.end(), [&](auto n) { return n > m.replicas; })))
    throw wrong("counts that cannot be");
  try {
    tree_.add(std::move(node));
  } catch (const std::invalid_argument& error) {
    throw wrong(error.what());
  }
}

void EnsembleState::take(SpreadRecord&& spread, const std::string& from) {
  auto& [k, counts] = spread;
  if (k >= spreads_.size() || counts.size() != spreads_[k].counts.all_counts().size())
    throw damaged(from, fmt::format("{} counts for the spread {}", counts.size(), k));
  Histograms& all = spreads_[k].counts;
  Histograms other(all.bins(), all.entries());
  other.set_all_counts(std::move(counts));
  all.add(other);
}

// The table of replicas and the statistics must have the same replicas.
void EnsembleState::check_replicas(const std::string& file) const {
  std::uint64_t in_statistics = 0, in_table = 0;
  for (const TreeNode& node : tree_.nodes()) in_statistics += node.moments.replicas;
  std::optional<ReplicaIndex> before;
  bool same = table_.size() == tree_.size();
  for (const std::size_t k : table_.order()) {
    const ReplicaRow row = table_[k];
    same = same && tree_.contains(row.index) && before != row.index;
    before = row.index;
    in_table += row.outcome != RunEnd::failed;
  }
  if (!same || in_table != in_statistics)
    throw Error({file, 0, name("replicas")}, "a damaged ensemble",
                fmt::format("{} replicas listed, statistics of {}", table_.size(), tree_.size()),
                "take it from a copy, or run it again", Exit::io);
}

// ---- as records

std::uint64_t EnsembleRecord::replicas() const {
  if (const auto* rows = std::get_if<RowsRecord>(&what)) return rows->size();
  return std::holds_alternative<ReplicaRecord>(what) || std::holds_alternative<FailureRecord>(what) ? 1 : 0;
}

void EnsembleState::put_records(std::uint64_t point, const JournalWriter::Put& put) const {
  const auto put_one = [&](auto&& what) { put(to_bytes(EnsembleRecord{point, std::forward<decltype(what)>(what)})); };
  constexpr std::size_t rows_of_a_record = 10000;
  for (std::size_t first = 0; first < table_.size(); first += rows_of_a_record) {
    RowsRecord rows;
    for (std::size_t k = first; k < std::min(first + rows_of_a_record, table_.size()); ++k) {
      const auto failure = messages_.find(table_[k].index);
      rows.emplace_back(table_[k], failure == messages_.end() ? "" : failure->second);
    }
    put_one(std::move(rows));
  }
  for (std::size_t k = 0; k < spreads_.size(); ++k) put_one(SpreadRecord{k, spreads_[k].counts.all_counts()});
  for (TreeNode& node : tree_.nodes()) put_one(std::move(node));
  for (const auto& [replica, kept] : kept_) put_one(KeptRecord{replica, kept});
}

void EnsembleState::apply(EnsembleRecord&& record) {
  std::visit([this](auto& what) { take(std::move(what)); }, record.what);
}

void EnsembleState::take(ReplicaRecord&& one) {
  if (tree_.contains(one.row.index)) return;
  check_length(one.values.size());
  {
    const std::scoped_lock lock(mutex_);
    table_.add(one.row);
    if (!one.kept.empty()) kept_.emplace(one.row.index, std::move(one.kept));
    for (auto& [quantity, counts] : spreads_)
      counts.add(std::span(one.values).subspan(quantity.offset, quantity.size()));
  }
  tree_.add(one.row.index, std::move(one.values));
}

void EnsembleState::take(FailureRecord&& failure) {
  auto& [replica, message] = failure;
  if (tree_.contains(replica)) return;
  std::replace(message.begin(), message.end(), '\n', ' ');  // one line each in result files
  {
    const std::scoped_lock lock(mutex_);
    table_.add({replica, RunEnd::failed, 0, 0, {}});
    messages_.emplace(replica, std::move(message));
  }
  tree_.add(replica, std::nullopt);
}

void EnsembleState::take(RowsRecord&& rows) {
  for (auto& [row, message] : rows) {
    table_.add(row);
    if (row.outcome == RunEnd::failed) messages_.emplace(row.index, std::move(message));
  }
}

}  // namespace cradle::tools
