// Compiled apart from the loops that measure it: inlined into them, its speed depends on what stands around.
#include "indexed_heap.hpp"

namespace twins {

void IndexedHeapEngine::advance(double until) {
  while (due_[heap_.front()] <= until) {
    const std::uint32_t i = heap_.front();
    const double time = due_[i];
    line_.collide(i, time);
    ++contacts_;
    update(i, never);
    if (i > 0) update(i - 1, line_.due(i - 1, time));
    if (i + 1 < line_.gaps()) update(i + 1, line_.due(i + 1, time));
  }
}

}  // namespace twins
