// Compiled separately from the measuring loops: inlined into them, its speed would depend on the surrounding code.
#include "queues.hpp"

namespace twins {

template <class Queue> void QueueEngine<Queue>::advance(double until) {
  while (queue_.first().time <= until) {
    const auto [time, i] = queue_.first();
    line_.collide(i, time);
    ++collisions_;
    queue_.update(i, never);
    if (i > 0) queue_.update(i - 1, line_.due(i - 1, time));
    if (i + 1 < line_.gaps()) queue_.update(i + 1, line_.due(i + 1, time));
  }
}
template class QueueEngine<Scan>;
template class QueueEngine<IndexedHeap>;
template class QueueEngine<TunedHeap>;

}  // namespace twins
