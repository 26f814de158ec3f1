// Who looks over a run's shoulder: is told of every contact before it is made, and of what the run says of itself at
// every time that it is looked at. What a witness throws ends the run.
#pragma once

#include <string>

#include "cradle/core/run.hpp"

namespace cradle::tools {

struct RunLook {
  double time = 0;
  std::string time_text;  // with all digits of the run's precision, as are energy and front
  bool of_series = false, of_snapshots = false;
  bool at_contact = false;  // the run ends here, with the contact that it made last
  Counts counts;
  std::string energy, front_right;  // front_right: empty before the first contact
};

class Witness {
 public:
  virtual ~Witness() = default;
  virtual void contact(BodyIndex left, BodyIndex right, double time) = 0;
  virtual void look(const RunLook& look) = 0;
};

}  // namespace cradle::tools
