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

void ReplicaTable::add(const ReplicaTable& other) {
  integers_.insert(integers_.end(), other.integers_.begin(), other.integers_.end());
  numbers_.insert(numbers_.end(), other.numbers_.begin(), other.numbers_.end());
}

ReplicaTable ReplicaTable::part(std::size_t first, std::size_t last) const {
  ReplicaTable some(width_);
  const auto take = [&](auto& to, const auto& all, std::size_t width) {
    const auto part = std::span(all).subspan(first * width, (last - first) * width);
    to.assign(part.begin(), part.end());
  };
  take(some.integers_, integers_, integers), take(some.numbers_, numbers_, width_);
  return some;
}

void ReplicaTable::loaded() const {
  require_state(width_ < 1 << 20 && integers_.size() % integers == 0 && numbers_.size() == width_ * size(), "rows");
  for (std::size_t k = 0; k < size(); ++k) {
    require_state(index(k) >> 63 == 0, "a replica beyond the last");  // the tree of replicas ends there
    require_state(static_cast<std::size_t>(outcome(k)) < outcome_count, "no outcome of a replica");
  }
}

std::vector<std::size_t> ReplicaTable::order() const {
  std::vector<std::size_t> rows(size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  if (std::ranges::is_sorted(rows, {}, [&](std::size_t row) { return index(row); })) return rows;
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
    if (std::ranges::any_of(spreads_, [&](const Spread& of) { return of.quantity.offset == found->offset; }))
      throw Error({"--spread", 0, ""}, "a quantity that has bins already", request.name, "give each quantity once");
    spreads_.push_back({*found, Histograms(request.bins, found->size())});
  }
}

EnsembleState::Outcomes EnsembleState::outcomes() const {
  const std::scoped_lock lock(mutex_);
  Outcomes counts{};
  for (std::size_t k = 0; k < table_.size(); ++k) ++counts.at(static_cast<std::size_t>(table_.outcome(k)));
  return counts;
}

std::map<ReplicaIndex, std::string> EnsembleState::failures() const {
  const std::scoped_lock lock(mutex_);
  std::map<ReplicaIndex, std::string> failures = messages_;
  for (std::size_t k = 0; k < table_.size(); ++k)
    if (end_row(table_.outcome(k)).status == Exit::lost && table_.outcome(k) != RunEnd::failed)
      failures.emplace(table_.index(k), end_row(table_.outcome(k)).text);
  return failures;
}

bool EnsembleState::holds_all_of(const EnsembleState& other) const {
  return std::ranges::all_of(other.tree_.present(), [this](const auto& range) { return tree_.missing(range).empty(); });
}

bool EnsembleState::holds_any_of(const EnsembleState& other) const {
  return std::ranges::any_of(other.tree_.present(), [this](const auto& range) { return tree_.overlaps(range); });
}

void EnsembleState::take(EnsembleState& other) {
  table_.add(other.table_);
  messages_.merge(other.messages_);
  kept_.merge(other.kept_);
  for (std::size_t k = 0; k < spreads_.size(); ++k) spreads_[k].counts.add(other.spreads_[k].counts);
  for (TreeNode& node : other.tree_.nodes()) tree_.add(std::move(node));
}

void EnsembleState::take(TreeNode&& node, const std::string& from) {
  const Moments& m = node.moments;
  const auto wrong = [&](const std::string& found) { return damaged_ensemble({from}, found); };
  if (node.level > 62 || m.replicas > node.range().count)
    throw wrong(fmt::format("{} replicas in a node of level {}", m.replicas, node.level));
  if (m.replicas > 0 && m.entries() != layout_.entries)
    throw Error({}, "an ensemble of other quantities", fmt::format("{} numbers a replica", m.entries()),
                fmt::format("this version records {}: use the program that wrote it", layout_.entries), Exit::io);
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

void EnsembleState::take_counts(std::size_t spread, std::vector<std::uint64_t> counts, const std::string& from) {
  if (spread >= spreads_.size() || counts.size() != spreads_[spread].counts.all_counts().size())
    throw damaged_ensemble({from}, fmt::format("{} counts for the spread {}", counts.size(), spread));
  Histograms& all = spreads_[spread].counts;
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
    const ReplicaIndex index = table_.index(k);
    same = same && tree_.contains(index) && before != index;
    before = index;
    in_table += table_.outcome(k) != RunEnd::failed;
  }
  if (!same || in_table != in_statistics)
    throw damaged_ensemble({file, 0, name("replicas")},
                           fmt::format("{} replicas listed, statistics of {}", table_.size(), tree_.size()));
}

// ---- as records

void EnsembleState::put(EnsembleRecord& record, const ReplicaRow& row, const std::vector<double>& values) const {
  if (record.rows.size() == 0) record.rows = ReplicaTable(table_.numbers());
  record.rows.add(row);
  Moments memory;
  if (!record.left_over.empty()) memory = std::move(record.left_over.back()), record.left_over.pop_back();
  append(record.nodes, {row.index, 0, moments_of(values, std::move(memory))}, record.left_over);
  for (const auto& [quantity, counts] : spreads_) {
    const auto of_replica = std::span(values).subspan(quantity.offset, quantity.size());
    record.to_spread.insert(record.to_spread.end(), of_replica.begin(), of_replica.end());
  }
}

void EnsembleState::put_failure(EnsembleRecord& record, ReplicaIndex replica, std::string message) const {
  std::replace(message.begin(), message.end(), '\n', ' ');  // one line each in result files
  if (record.rows.size() == 0) record.rows = ReplicaTable(table_.numbers());
  record.rows.add({replica, RunEnd::failed, 0, 0, {}});
  append(record.nodes, {replica, 0, {}}, record.left_over);
  record.messages.emplace(replica, std::move(message));
}

void EnsembleState::put_records(std::uint64_t point, const JournalWriter::Put& put) const {
  const auto put_one = [&](EnsembleRecord&& record) {
    record.point = point;
    put(to_bytes(record));
  };
  constexpr std::size_t rows_of_a_record = 10000;
  for (std::size_t first = 0; first < table_.size(); first += rows_of_a_record) {
    EnsembleRecord record{.rows = table_.part(first, std::min(first + rows_of_a_record, table_.size()))};
    for (std::size_t k = 0; k < record.rows.size(); ++k)
      if (const auto failure = messages_.find(record.rows.index(k)); failure != messages_.end())
        record.messages.insert(*failure);
    put_one(std::move(record));
  }
  EnsembleRecord counted;
  for (const Spread& spread : spreads_) counted.spreads.push_back(spread.counts.all_counts());
  if (!spreads_.empty()) put_one(std::move(counted));
  for (TreeNode& node : tree_.nodes()) put_one({.nodes = {std::move(node)}});
  for (const auto& kept : kept_) put_one({.kept = {kept}});
}

void EnsembleState::apply(EnsembleRecord&& record) {
  const std::string from = "a journal";
  if (!record.nodes.empty() && std::ranges::all_of(record.nodes, [&](const TreeNode& node) {
        return node.level < 63 && tree_.missing(node.range()).empty();
      }))
    return;
  if (record.rows.size() > 0 && record.rows.numbers() != table_.numbers())
    throw damaged_ensemble({from}, fmt::format("{} numbers a row", record.rows.numbers()));
  for (TreeNode& node : record.nodes) take(std::move(node), from);
  const std::scoped_lock lock(mutex_);
  table_.add(record.rows);
  messages_.merge(record.messages);
  for (std::size_t k = 0; k < record.spreads.size(); ++k) take_counts(k, std::move(record.spreads[k]), from);
  std::size_t wanted = 0;
  for (const Spread& spread : spreads_) wanted += spread.quantity.size();
  if (wanted == 0 ? !record.to_spread.empty() : record.to_spread.size() % wanted != 0)
    throw damaged_ensemble({from}, fmt::format("{} numbers for spreads", record.to_spread.size()));
  for (auto at = record.to_spread.begin(); at != record.to_spread.end();)
    for (auto& [quantity, counts] : spreads_) {
      counts.add({at, at + static_cast<std::ptrdiff_t>(quantity.size())});
      at += static_cast<std::ptrdiff_t>(quantity.size());
    }
  kept_.merge(record.kept);
}

}  // namespace cradle::tools
