// What the numbers of a replica mean. A replica is one vector of doubles: the columns that a run of the scene records
// in its series, profiles, zone, averages, histograms and correlations, one after the other. Ensembles keep statistics
// of this vector. Times and bins are the same in all replicas, so they are stored here. The tables of a run
// (record/rows.hpp) say which columns there are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Marks a number that a replica or a point does not have.
inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// A column of "series", "series/heaviest", "profiles/0002", ...: `rows` times `width` numbers from `offset` on.
struct Quantity {
  std::string group, name, unit, description;
  std::size_t offset = 0, rows = 0, width = 1;
  std::optional<std::size_t> column = {};  // in the table "series"
  std::size_t size() const { return rows * width; }
};

/// One line of the table of replicas.
struct ReplicaRow {
  std::uint64_t index = 0;
  RunEnd outcome = RunEnd::reached;
  std::uint64_t collisions = 0, merges = 0;
  std::vector<double> numbers;  // one for each of ReplicaLayout::numbers; NaN: none
};

struct ReplicaLayout {
  struct Binned {  // "profiles/0002", "zone"
    std::string group;
    std::vector<Attribute> attributes;
    std::vector<Column> bins;  // where they are
  };

  Column time;  // of the series
  std::vector<Binned> binned;
  std::vector<Quantity> quantities;
  std::size_t entries = 0;      // length of the vector
  std::vector<Column> numbers;  // the numbers of a ReplicaRow (energy at the end, ...), without values

  /// The vector of a run that has its tables, with NaN after its end if it ended early. Throws std::logic_error for a
  /// run with another layout.
  std::vector<double> values(const RunOutcome& run) const;
  /// The same into `values`, with the columns of the table "series" apart from the other tables.
  using SeriesNumbers = std::vector<std::vector<double>>;
  void put_values(RunEnd end, const SeriesNumbers& series, const std::vector<Group>& tables,
                  std::vector<double>& values) const;
  void put_row(std::uint64_t index, const RunOutcome& run, ReplicaRow& row) const;
  ReplicaRow row(std::uint64_t index, const RunOutcome& run) const {
    ReplicaRow row;
    put_row(index, run, row);
    return row;
  }
};

/// Throws Error, naming the key, if the scene cannot be run as an ensemble.
void check_ensemble(const Scene& scene);

/// The layout of the scene's replicas; runs nothing. Throws Error as check_ensemble does.
ReplicaLayout replica_layout(const Scene& scene);

/// The scene of one replica, without the outputs that ensembles do not keep: masses and events, and snapshots unless
/// the scene keeps those of every replica.
Scene replica_scene(const Scene& scene, std::uint64_t index);

}  // namespace cradle::tools
