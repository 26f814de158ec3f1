// Compiled separately from the measuring loops: inlined into them, its speed would depend on the surrounding code.
#include "priority_queue.hpp"

namespace twins {

void PriorityQueueEngine::advance(double until) {
  while (!events_.empty() && events_.top().time <= until) {
    const Event event = events_.top();
    events_.pop();
    const std::size_t i = event.left;
    if (had_[i] != event.left_had || had_[i + 1] != event.right_had) continue;
    line_.collide(i, event.time);
    ++had_[i];
    ++had_[i + 1];
    ++collisions_;
    if (i > 0) predict(i - 1, event.time);
    if (i + 1 < line_.gaps()) predict(i + 1, event.time);
  }
}

}  // namespace twins
