#include "indexed_heap.hpp"

namespace twins {

void IndexedHeapEngine::advance(double until) {
  for (;;) {
    const std::uint32_t gap = heap_.first();
    const double time = heap_.due(gap);
    if (time > until) return;
    line_.collide(gap, time);
    ++collisions_;
    heap_.update(gap, never);
    if (gap > 0) heap_.update(gap - 1, line_.due(gap - 1, time));
    if (gap + 1 < line_.gaps()) heap_.update(gap + 1, line_.due(gap + 1, time));
  }
}

}  // namespace twins
