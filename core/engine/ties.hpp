#pragma once
// `Ties` decides which of several collisions is first by (exact time, position in the line), if the queue's keys cannot
// decide it.
//
// All collisions whose keys may belong to the same time as the root's are candidates, anywhere on the line. Comparing
// only neighbours would be right for each pair and still wrong: distant collisions would overtake each other within the
// width of a key, and their effects would meet in the wrong order.
//
// A few candidates are compared anew for every collision. On a lattice thousands are simultaneous: these are kept in a
// heap from one collision to the next, and only the three gaps that a collision changes are checked again. An entry
// whose gap is now due at another time is dropped when it comes to the top.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "cradle/core/chains/chain.hpp"

namespace cradle {

// C: a chain, or a segment of one.
template <class C> class Ties {
 public:
  // The first of all collisions when the queue is contested, after so many collisions.
  Slot first(const EventQueue& queue, const C& chain, std::uint64_t collisions) {
    const EventQueue::Key bound = queue.no_later_than(queue.next());
    if (!brought_up_to_date(queue, chain, collisions, bound)) {
      Slot first = 0;
      if (found_among_few(queue, chain, bound, first)) return first;
      gather(queue, chain, bound);
    }
    while (!stands(queue, chain, heap_.front())) pop();
    const Slot first = heap_.front().slot;
    changing_[0] = chain.left(first), changing_[1] = first, changing_[2] = chain.right(first);
    collisions_ = collisions;
    return first;
  }

  // Forgets everything, after a general change of slots, times or keys.
  void forget() { heap_.clear(); }

 private:
  using T = typename C::Scalar;
  struct Candidate {
    T time;
    Slot slot;
    friend bool operator<(const Candidate& a, const Candidate& b) {
      return a.time < b.time || (a.time == b.time && a.slot < b.slot);
    }
  };
  static bool later(const Candidate& a, const Candidate& b) { return b < a; }
  static constexpr std::size_t few = 16;

  bool found_among_few(const EventQueue& queue, const C& chain, EventQueue::Key bound, Slot& first) {
    heap_.clear();
    std::size_t candidates = 0;
    T earliest(0);
    return queue.for_each_before(bound, [&](Slot s) {  // from left to right
      const T time = chain.due(s);
      if (candidates == 0 || time < earliest) first = s, earliest = time;
      return ++candidates <= few;
    });
  }

  void gather(const EventQueue& queue, const C& chain, EventQueue::Key bound) {
    queue.for_each_before(bound, [&](Slot s) {
      heap_.push_back({chain.due(s), s});
      return true;
    });
    std::make_heap(heap_.begin(), heap_.end(), later);
    bound_ = bound;
    gathered_ = heap_.size();
  }

  // Whether the heap holds every collision up to the bound, after the single collision since the last call.
  bool brought_up_to_date(const EventQueue& queue, const C& chain, std::uint64_t collisions, EventQueue::Key bound) {
    if (heap_.empty() || bound > bound_ || heap_.size() > 2 * gathered_) return false;
    if (collisions == collisions_) return true;
    if (collisions != collisions_ + 1) return false;
    for (const Slot s : changing_)
      if (queue.key_of(s) <= bound_) {
        heap_.push_back({chain.due(s), s});
        std::push_heap(heap_.begin(), heap_.end(), later);
      }
    return true;
  }

  bool stands(const EventQueue& queue, const C& chain, const Candidate& candidate) const {
    return queue.key_of(candidate.slot) <= bound_ && chain.due(candidate.slot) == candidate.time;
  }
  void pop() {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
  }

  std::vector<Candidate> heap_;   // the first is on top; empty: nothing is kept
  std::size_t gathered_ = 0;      // candidates when it was made
  EventQueue::Key bound_ = 0;     // it contains collisions with keys up to this
  std::uint64_t collisions_ = 0;  // number of collisions at the last call
  Slot changing_[3] = {0, 0, 0};  // the gaps that the collision found then changes
};

}  // namespace cradle
