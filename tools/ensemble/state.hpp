// One ensemble in memory: statistics of all quantities over replicas (core/ensemble/tree.hpp), the table of replicas,
// messages of failed replicas, and histograms if requested. Journals and ranks exchange it as records, result files
// hold it as groups. Both keep every bit, so that ensembles can be continued and merged.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/core/ensemble/ensemble.hpp"
#include "cradle/tools/ensemble/every_replica.hpp"
#include "cradle/tools/ensemble/layout.hpp"
#include "cradle/tools/store/journal.hpp"

namespace cradle::tools {

// ---- an ensemble as records, which journals hold and ranks send
struct ReplicaRecord {
  ReplicaRow row;
  std::vector<double> values;
  ReplicaTables kept = {};
  static auto state(auto& self) { return std::tie(self.row, self.values, self.kept); }
};
struct FailureRecord {
  ReplicaIndex replica = 0;
  std::string message;
  static auto state(auto& self) { return std::tie(self.replica, self.message); }
  void loaded() const { require_state(replica >> 63 == 0, "a replica beyond the last"); }
};
using RowsRecord = std::vector<std::pair<ReplicaRow, std::string>>;  // with messages; their values are in the nodes
struct SpreadRecord {
  std::uint64_t number = 0;  // of the spread
  std::vector<std::uint64_t> counts;
  static auto state(auto& self) { return std::tie(self.number, self.counts); }
};
struct KeptRecord {
  ReplicaIndex replica = 0;
  ReplicaTables kept;
  static auto state(auto& self) { return std::tie(self.replica, self.kept); }
};
struct EnsembleRecord {
  std::uint64_t point = 0;  // which ensemble of a sweep
  std::variant<ReplicaRecord, FailureRecord, RowsRecord, SpreadRecord, TreeNode, KeptRecord> what;
  static auto state(auto& self) { return std::tie(self.point, self.what); }

  /// The number of replicas whose outcome it holds.
  std::uint64_t replicas() const;
};

/// Rows in the order of arrival, numbers side by side: about 50 bytes a replica.
class ReplicaTable {
 public:
  explicit ReplicaTable(std::size_t numbers) : width_(numbers) {}

  void add(const ReplicaRow& row);
  std::size_t size() const { return integers_.size() / integers; }
  ReplicaRow operator[](std::size_t k) const;
  /// The positions of the rows, sorted by replica index.
  std::vector<std::size_t> order() const;

 private:
  static constexpr std::size_t integers = 4;
  std::size_t width_;
  std::vector<std::uint64_t> integers_;  // index, outcome, collisions, merges
  std::vector<double> numbers_;
};

/// Mean, standard error and extremes of a quantity. NaN if no replica has it. Counts the replicas that have it if not
/// all do.
Group statistics_group(std::string name, const Quantity& quantity, const Moments& total);

class EnsembleState {
 public:
  using Outcomes = std::array<std::uint64_t, outcome_count>;

  /// `group` is the place in the result file: "" for the whole file, or "points/0003". Throws Error if the scene cannot
  /// be run as an ensemble.
  EnsembleState(std::string group, Scene scene, const std::vector<SpreadRequest>& spreads);

  const std::string& group() const { return group_; }
  const Scene& scene() const { return scene_; }
  const ReplicaLayout& layout() const { return layout_; }

  const MomentTree& replicas() const { return tree_; }
  Outcomes outcomes() const;
  const ReplicaTable& table() const { return table_; }
  /// The replicas that cannot be trusted, each with its reason: what stopped it, or that it lost the order of
  /// collisions or exhausted the resolution.
  std::map<ReplicaIndex, std::string> failures() const;

  bool holds_all_of(const EnsembleState& other) const;
  bool holds_any_of(const EnsembleState& other) const;
  /// Adds the other's replicas; the two must share none.
  void take(EnsembleState& other);

  /// Puts everything as records, enough to restore this state; `point` is the number of this ensemble.
  void put_records(std::uint64_t point, const JournalWriter::Put& put) const;
  /// Skips a replica that is there already. Throws Error (Exit::io) for a record of another ensemble. Records of one
  /// replica each may come from several threads.
  void apply(EnsembleRecord&& record);

  // ---- as groups of a result file
  std::vector<Group> groups() const;
  /// Throws Error (Exit::io) where the file does not hold what groups() wrote for this scene.
  void read(const Result& result, const std::string& file);

 private:
  struct Spread {
    Quantity quantity;
    Histograms counts;
  };

  std::string name(const std::string& below) const { return group_.empty() ? below : group_ + "/" + below; }
  void check_length(std::size_t entries) const;
  void take(ReplicaRecord&& one);
  void take(FailureRecord&& failure);
  void take(RowsRecord&& rows);
  void take(KeptRecord&& kept) { kept_.emplace(kept.replica, std::move(kept.kept)); }
  // These two check everything, since it comes from a file or another process.
  void take(SpreadRecord&& spread, const std::string& from = "a journal");
  void take(TreeNode&& node, const std::string& from = "a journal");
  void check_replicas(const std::string& file) const;
  Group quantity_group(const Quantity& quantity, const Moments& total) const;
  Group spread_group(const Spread& spread, const Moments& total) const;
  Group replica_group() const;

  std::string group_;
  Scene scene_;
  ReplicaLayout layout_;
  MomentTree tree_;
  mutable std::mutex mutex_;  // guards all that follows
  ReplicaTable table_;
  std::map<ReplicaIndex, std::string> messages_;  // of the replicas that failed
  std::vector<Spread> spreads_;
  KeptReplicas kept_;  // of every replica, if the scene requests it
};

}  // namespace cradle::tools
