// How long a run still needs, from its pace so far. What a unit of simulated time costs may grow: in a dry shock it
// grows linearly until the collapse, and by orders of magnitude there. With c the cost of a unit in the last quarter of
// the computing and in the quarter before, c is extrapolated linearly to the rest of the run. Nobody can foresee a
// jump, so an answer is given only while the totals that would have been predicted earlier, at a half and at three
// quarters of the computing so far, agree with the present one within a factor of 1.5.
#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace cradle::tools {

class TimeLeft {
 public:
  /// The run has reached this simulated time after so many seconds of computing; both increase.
  void add(double seconds, double time);
  /// Seconds of computing until a simulated time; nothing if they cannot be predicted.
  std::optional<double> until(double end) const;

 private:
  std::vector<std::pair<double, double>> points_;
};

}  // namespace cradle::tools
