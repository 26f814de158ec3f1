#pragma once
// This is the time of the last collision at each gap, for laws with a memory (LawWithMemory); it is empty for others.

#include <initializer_list>
#include <tuple>
#include <utility>
#include <vector>

#include "cradle/core/base/real.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

template <Real T> class CollisionMemory {
 public:
  // Whether the last collisions at all these gaps were `span` or longer ago. Records the present collision at the gap
  // s. `start` is the local time at which the run began, `slots` the largest number of gaps.
  bool rested(std::initializer_list<Slot> gaps, Slot s, const T& now, const T& span, const T& start,
              std::size_t slots) {
    if (last_.empty()) {
      never_ = start - span - T(1);
      last_.assign(slots, never_);
    }
    bool all = true;
    for (const Slot gap : gaps) all = all && !(now - last_[gap] < span);
    last_[s] = now;
    return all;
  }

  void lay_out(std::size_t slots, Slot first, const std::vector<Slot>& kept) {
    if (last_.empty()) return;
    std::vector<T> last(slots, never_);
    for (const Slot s : kept) last[first++] = std::move(last_[s]);
    last_ = std::move(last);
  }
  void move_origin(const T& by) {
    for (T& time : last_) time -= by;
    never_ -= by;
  }
  std::size_t slots() const { return last_.size(); }  // 0: nothing is recorded yet
  static auto state(auto& self) { return std::tie(self.last_, self.never_); }

 private:
  std::vector<T> last_;  // local times
  T never_{0};           // marks a gap without a collision
};

}  // namespace cradle
