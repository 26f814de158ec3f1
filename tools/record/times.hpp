// The times of a run: those at which it is recorded, and those of its tables.
#pragma once

#include <vector>

#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {

/// A time at which a run is recorded: the decimal in the scene, or the run's own time if the scene gives none.
struct RequestedTime {
  Decimal time;
  bool of_series = false, of_snapshots = false;
  bool last = false;  // the end of the run
};

/// The times of the series and of tables at times, and the end, as results store them: rounded from the run's
/// precision.
struct PlannedTimes {
  std::vector<double> series;
  std::vector<std::vector<double>> tables;  // of each measurement, as measurement_rows() has them
  double until = 0;
};

}  // namespace cradle::tools
