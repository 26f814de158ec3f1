// The event queue against a sorted list, under random updates of three neighbouring gaps at a time, as the event loop
// makes them. Times on a grid that every key resolves must come in exactly the list's order; times finer than a key
// must be reported as too close. (That the width of the index in a key changes no run is in engine/same_bits_test.cpp.)
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "cradle/core/queue/event_queue.hpp"

namespace cradle::test::queue_test {

constexpr double never = EventQueue::never;

// The queue in its plainest form: a list sorted by (time, slot), with exact times.
class SortedListQueue {
 public:
  explicit SortedListQueue(std::size_t slots) : times_(slots, never) {
    for (Slot s = 0; s < slots; ++s) sorted_.emplace(never, s);
  }

  void set(Slot s, double time) {
    sorted_.erase({times_[s], s});
    times_[s] = time;
    sorted_.emplace(time, s);
  }
  Slot next() const { return sorted_.begin()->second; }
  double time(Slot s) const { return times_[s]; }
  std::vector<Slot> before(double time) const {  // at times <= time, from left to right
    std::set<Slot> slots;
    for (auto entry = sorted_.begin(); entry != sorted_.end() && entry->first <= time; ++entry)
      slots.insert(entry->second);
    return {slots.begin(), slots.end()};
  }

 private:
  std::vector<double> times_;
  std::set<std::pair<double, Slot>> sorted_;
};

class Queues : public testing::TestWithParam<std::size_t> {
 protected:
  std::size_t slots() const { return GetParam(); }
  // Slots that an update may be centred on: the two at either end stay empty.
  Slot any_slot() { return std::uniform_int_distribution<Slot>(3, slots() - 4)(random_); }
  // A multiple of 2^-20 below 16: 24 bits, where a key keeps 52 less those of the index.
  double any_time() {
    if (std::uniform_int_distribution<int>(0, 3)(random_) == 0) return never;
    return std::ldexp(std::uniform_int_distribution<int>(0, 1 << 24)(random_), -20);
  }
  // Set one by one, with random times.
  void fill(EventQueue& queue, SortedListQueue& list) {
    for (Slot s = 2; s + 2 < slots(); ++s) {
      const double time = any_time();
      queue.set(s, time);
      list.set(s, time);
    }
    queue.rebuild(2, slots() - 3);
  }
  std::mt19937_64 random_{20240607};
};
INSTANTIATE_TEST_SUITE_P(Sizes, Queues, testing::Values(7, 8, 9, 31, 64, 100, 1000, 5000));

TEST_P(Queues, NameTheListsNextGapAfterEveryUpdate) {
  EventQueue queue(slots(), true);
  SortedListQueue list(slots());
  for (int step = 0; step < 20000; ++step) {
    const Slot s = any_slot();
    const double times[] = {any_time(), any_time(), any_time()};
    queue.replace(s, times[0], times[1], times[2]);
    for (Slot k = 0; k < 3; ++k) list.set(s - 1 + k, times[k]);
    if (list.time(list.next()) == never) continue;
    ASSERT_EQ(queue.slot(queue.next()), list.next()) << "step " << step;
  }
}

TEST_P(Queues, EmptyOneInOrder) {
  EventQueue queue(slots(), true);
  SortedListQueue list(slots());
  fill(queue, list);
  while (list.time(list.next()) != never) {
    const Slot s = queue.slot(queue.next());
    ASSERT_EQ(s, list.next());
    queue.replace(s, list.time(s - 1), never, list.time(s + 1));
    list.set(s, never);
  }
  EXPECT_GE(queue.next(), queue.key(never, 0));
}

TEST_P(Queues, VisitWhatIsDueFromLeftToRight) {
  for (const bool exact_keys : {true, false}) {
    EventQueue queue(slots(), exact_keys);
    SortedListQueue list(slots());
    fill(queue, list);
    for (const double t : {0., 0.5, 3.75, 15.}) {
      std::vector<Slot> visited;
      queue.for_each_before(queue.possibly_before(t), [&](Slot s) {
        visited.push_back(s);
        return true;
      });
      EXPECT_EQ(visited, list.before(t)) << "on this grid nothing lies between t and what its key covers";
      for (Slot s = 2; s + 2 < slots(); ++s)
        if (queue.key_of(s) < queue.certainly_before(t)) {
          ASSERT_LT(list.time(s), t);
        }
    }
  }
}

TEST(Queue, ANegativeTimeComesFirst) {
  EventQueue queue(16, true);
  queue.replace(5, 1, 2, 3);
  queue.replace(9, 0.5, -1e-30, 4);
  EXPECT_EQ(queue.slot(queue.next()), 9U);
  queue.replace(12, 1, -1e300, 2);
  EXPECT_EQ(queue.slot(queue.next()), 9U) << "of times left behind the leftmost: exact times decide among them";
  EXPECT_TRUE(queue.close(queue.key_of(9), 12));
  EXPECT_TRUE(queue.close(queue.key_of(12), 9));
}

TEST(Queue, TimesFinerThanAKeyAreClose) {
  for (const int bits : {4, 13, 20}) {
    EventQueue queue(16, true, bits);
    const double resolution = std::ldexp(1, bits - 52);  // relative, of a key
    queue.replace(6, 1 + 3 * resolution, 1, 1 + resolution / 2);
    EXPECT_TRUE(queue.close(queue.key_of(6), 7)) << bits;
    EXPECT_TRUE(queue.close(queue.key_of(7), 6)) << bits;
    EXPECT_FALSE(queue.close(queue.key_of(6), 5)) << bits;
    EXPECT_TRUE(queue.close(queue.key_of(5), 6)) << "earlier, so not later";
  }
}

TEST(Queue, RoundedKeysAreCloseWithinTheirRounding) {
  EventQueue exact(16, true), rounded(16, false);
  const double resolution = std::ldexp(1, 4 - 52);
  for (EventQueue* queue : {&exact, &rounded}) queue->replace(6, 1, 1 + resolution, 9);
  EXPECT_FALSE(exact.close(exact.key_of(5), 6));
  EXPECT_TRUE(rounded.close(rounded.key_of(5), 6));
}

}  // namespace cradle::test::queue_test
