// Compiled separately from the measuring loops: inlined into them, its speed would depend on the surrounding code.
#include "heaps.hpp"

namespace twins {

template <class Heap> void HeapEngine<Heap>::advance(double until) {
  while (heap_.first().time <= until) {
    const auto [time, i] = heap_.first();
    line_.collide(i, time);
    ++collisions_;
    heap_.update(i, never);
    if (i > 0) heap_.update(i - 1, line_.due(i - 1, time));
    if (i + 1 < line_.gaps()) heap_.update(i + 1, line_.due(i + 1, time));
  }
}
template class HeapEngine<IndexedHeap>;
template class HeapEngine<TunedHeap>;

}  // namespace twins
