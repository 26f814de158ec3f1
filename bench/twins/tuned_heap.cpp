// Compiled separately from the measuring loops: inlined into them, its speed would depend on the surrounding code.
#include "tuned_heap.hpp"

namespace twins {

void TunedHeapEngine::advance(double until) {
  while (heap_.front().time <= until) {
    const auto [time, i] = heap_.front();
    line_.collide(i, time);
    ++collisions_;
    update(i, never);
    if (i > 0) update(i - 1, line_.due(i - 1, time));
    if (i + 1 < line_.gaps()) update(i + 1, line_.due(i + 1, time));
  }
}

}  // namespace twins
