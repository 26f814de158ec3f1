// One ensemble in memory: statistics of all quantities over replicas (core/ensemble/tree.hpp), the table of replicas,
// messages of failed replicas, and histograms if requested. Journals and ranks exchange it as records, result files
// hold it as groups. Both keep every bit, so that ensembles can be continued and merged.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/base/large_pages.hpp"
#include "cradle/core/ensemble/ensemble.hpp"
#include "cradle/tools/ensemble/layout.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/store/unfinished.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

/// Rows in the order of arrival, numbers side by side: about 50 bytes a replica.
class ReplicaTable {
 public:
  explicit ReplicaTable(std::size_t numbers) : width_(numbers) {}

  void add(const ReplicaRow& row);
  /// Adds the rows of a table of as many numbers.
  void add(const ReplicaTable& other);
  std::size_t size() const { return integers_.size() / integers; }
  std::size_t numbers() const { return width_; }
  /// Rows [first, last).
  ReplicaTable part(std::size_t first, std::size_t last) const;
  ReplicaIndex index(std::size_t k) const { return integers_[k * integers]; }
  RunEnd outcome(std::size_t k) const { return static_cast<RunEnd>(integers_[k * integers + 1]); }
  double number(std::size_t k, std::size_t which) const { return numbers_[k * width_ + which]; }
  std::uint64_t collisions(std::size_t k) const { return integers_[k * integers + 2]; }
  std::uint64_t merges(std::size_t k) const { return integers_[k * integers + 3]; }
  /// The positions of the rows, sorted by replica index.
  std::vector<std::size_t> order() const;

  static auto state(auto& self) { return fields(self.width_, self.integers_, self.numbers_); }
  void loaded() const;

 private:
  static constexpr std::size_t integers = 4;
  std::size_t width_;
  LongArray<std::uint64_t> integers_;  // index, outcome, collisions, merges
  LongArray<double> numbers_;
};

// ---- the snapshots and profiles of every replica (every_replica.cpp)

/// The tables of a result file, with the rows of one replica each; and those of several replicas.
using ReplicaTables = std::vector<Group>;
using KeptReplicas = std::map<ReplicaIndex, ReplicaTables>;

ReplicaTables kept_tables(ReplicaIndex replica, const Result& run);
/// One table for each time, below `folder` ("" or "points/0003/").
std::vector<Group> joined_tables(const KeptReplicas& kept, const std::string& folder);
/// The inverse. Throws Error (Exit::io), naming `file`, for other columns than joined_tables makes.
KeptReplicas separated_tables(const Result& result, const std::string& folder, const std::string& file);

/// A part of an ensemble, which journals hold and ranks send: finished replicas with their statistics, or all of an
/// ensemble in several records.
struct EnsembleRecord {
  std::uint64_t point = 0;  // which ensemble of a sweep
  ReplicaTable rows = ReplicaTable(0);
  std::map<ReplicaIndex, std::string> messages = {};     // of the replicas that failed
  std::vector<TreeNode> nodes = {};                      // statistics
  std::vector<double> to_spread = {};                    // numbers that the spreads do not count yet, for each replica
  std::vector<std::vector<std::uint64_t>> spreads = {};  // counts
  KeptReplicas kept = {};
  std::vector<Moments> left_over = {};  // memory for more of them

  static auto state(auto& self) {
    return fields(self.point, self.rows, self.messages, self.nodes, self.to_spread, self.spreads, self.kept);
  }
};

/// What to throw where a file or a record does not hold what an ensemble writes.
Error damaged_ensemble(const Place& place, const std::string& found);

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
  /// Adds a replica to the record, after those before it.
  void put(EnsembleRecord& record, const ReplicaRow& row, const std::vector<double>& values) const;
  /// The same for a replica that failed.
  void put_failure(EnsembleRecord& record, ReplicaIndex replica, std::string message) const;
  /// Skips statistics that are there already, with their replicas. Throws Error (Exit::io) for a record of another
  /// ensemble. May be called from several threads.
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
  // These check everything, since it comes from a file or another process.
  void take_counts(std::size_t spread, std::vector<std::uint64_t> counts, const std::string& from);
  void take(TreeNode&& node, const std::string& from);
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
