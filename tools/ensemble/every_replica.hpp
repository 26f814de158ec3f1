// The snapshots and profiles of every replica, which an ensemble keeps if its scene requests it (output.every_replica).
// A result file has one table for each time, "replicas/snapshots/0002": the rows of all replicas, one replica after the
// other, as a run of it has them, behind a column with its number. Where a run has one row less (the gaps between n
// particles), the last one of a replica is NaN. The last snapshot of a replica that ended before the end of the scene
// has a time of its own: a table in which times differ has a second column with them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cradle/core/ensemble/ensemble.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

/// These tables with the rows of one replica each.
using ReplicaTables = std::vector<Group>;
/// Of several replicas.
using KeptReplicas = std::map<ReplicaIndex, ReplicaTables>;

/// What to throw where a file or a record does not hold what an ensemble writes.
Error damaged_ensemble(const Place& place, const std::string& found);

ReplicaTables kept_tables(ReplicaIndex replica, const Result& run);

/// One table for each time, below `folder` ("" or "points/0003/").
std::vector<Group> joined_tables(const KeptReplicas& kept, const std::string& folder);
/// The inverse. Throws Error (Exit::io), naming `file`, for other columns than joined_tables makes.
KeptReplicas separated_tables(const Result& result, const std::string& folder, const std::string& file);

}  // namespace cradle::tools
