#pragma once
// `NextCollision` finds the collision of a chain that is the next one, by a queue of all gaps; where the queue's keys
// cannot decide it, by the exact times (ties.hpp). A run in time slabs (core/parallel) does without the queue.

#include <cstdint>
#include <utility>

#include "cradle/core/chains/chain.hpp"
#include "cradle/core/engine/pacing.hpp"
#include "cradle/core/engine/status.hpp"
#include "cradle/core/engine/ties.hpp"

namespace cradle {

// The time to advance to, in the scene and in the chain.
template <Real T> struct Target {
  T until, horizon;
  T stop;                                // the end of the epoch if that is earlier, else the horizon
  EventQueue::Key certainly_before = 0;  // collisions with smaller keys come before it and are not observed

  template <class Chain> void aim(const Chain& chain, const Pacing<T>& pacing, const EventQueue& queue, bool observed) {
    horizon = chain.local_time(until);
    stop = pacing.in_epochs && pacing.epoch_end < horizon ? pacing.epoch_end : horizon;
    certainly_before = observed ? 0 : queue.certainly_before(chain.queue_time(stop));
  }
};

template <class Chain> class NextCollision {
  using T = typename Chain::Scalar;

 public:
  NextCollision(const Chain& chain, int least_queue_bits)
      : queue(chain.slots(), Chain::keys_are_exact, least_queue_bits), least_queue_bits_(least_queue_bits) {}

  EventQueue queue;

  bool has_queue() const { return has_queue_; }
  void fill(const Chain& chain) {
    queue.lay_out(chain.slots(), Chain::keys_are_exact, least_queue_bits_);
    has_queue_ = true;
    refill(chain);
  }
  void begin_again(const Chain& chain) {
    close_calls_until_ = 0;
    fill(chain);
  }
  void refill(const Chain& chain) {
    if (!has_queue_) return;
    for (Slot s = chain.first(); s <= chain.last(); ++s) queue.set(s, chain.queue_due(s));
    queue.rebuild(chain.first(), chain.last());
    ties_.forget();
  }
  void release() {
    if (std::exchange(has_queue_, false)) queue = EventQueue(8, Chain::keys_are_exact);
  }

  // Whether the next collision, which is at `first`, is not later than a local time.
  bool is_by(const T& time, const Chain& chain, Counts& counts, Slot& first) {
    if (queue.next() > queue.possibly_before(chain.queue_time(time))) return false;
    const bool contested = queue.contested();
    if (contested) first = ties_.first(queue, chain, counts.collisions);
    if (!(chain.due(first) <= time)) return false;
    if (contested) count_close_call(counts);
    return true;
  }
  // The slot of the next collision, if the queue is contested.
  Slot first_of_tied(const Chain& chain, Counts& counts) {
    count_close_call(counts);
    return ties_.first(queue, chain, counts.collisions);
  }

 private:
  // Counts every collision once, even if it is the next one several times before it is made.
  void count_close_call(Counts& counts) {
    if (counts.collisions < close_calls_until_) return;
    ++counts.close_calls;
    close_calls_until_ = counts.collisions + 1;
  }

  int least_queue_bits_;
  bool has_queue_ = true;
  std::uint64_t close_calls_until_ = 0;  // collisions up to this number have been checked for close calls
  Ties<Chain> ties_;
};

}  // namespace cradle
