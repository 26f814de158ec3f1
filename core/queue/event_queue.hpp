#pragma once
// The event queue holds one key per gap in a binary tree of minima. Keys are updated in place; the root is the key of
// the next gap.
//
// README.md (The order of collisions) describes a key, and how close the times of two keys may be. Where keys do not
// distinguish them, the caller compares exact times: `contested` is true where that is necessary, and
// `for_each_before` lists the candidates. The keys of wide scalar types are made of rounded times, which may be off by
// two units of the last bit that a key keeps of a time; `slack_` allows for that.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cradle/core/base/large_pages.hpp"

namespace cradle {

using Slot = std::size_t;

class EventQueue {
 public:
  using Key = std::uint64_t;

  static constexpr double never = std::numeric_limits<double>::infinity();

  // Slots 0 to slots - 1. The two at either end stay empty: an update touches the neighbours of its slot.
  explicit EventQueue(std::size_t slots, bool exact_keys, int least_bits = 3) {
    lay_out(slots, exact_keys, least_bits);
  }
  // The same for a queue that is there: it becomes empty.
  void lay_out(std::size_t slots, bool exact_keys, int least_bits) {
    leaves_ = std::size_t{1} << std::max<int>(least_bits, static_cast<int>(std::bit_width(slots - 1)));
    mask_ = leaves_ - 1;
    slack_ = exact_keys ? 0 : 2 * leaves_;
    tree_.assign(2 * leaves_, key(never, 0));
  }

  std::size_t slots() const { return leaves_; }
  Key next() const { return tree_[1]; }
  Slot slot(Key key) const { return key & mask_; }

  // A negative time (of a collision before the origin, after the origin has moved) has its sign bit set and would sort
  // last; it gets the key of time 0, which sorts first.
  Key key(double due, Slot slot) const {
    return (static_cast<Key>(std::max<std::int64_t>(std::bit_cast<std::int64_t>(due), 0)) & ~mask_) | slot;
  }

  // Keys below `certainly_before(t)` belong to collisions before t, keys above `possibly_before(t)` to collisions after
  // it.
  Key certainly_before(double t) const {
    const Key k = key(t, 0);
    return k > slack_ ? k - slack_ : 0;
  }
  Key possibly_before(double t) const { return no_later_than(key(t, 0)); }

  // Whether any other key is too close to the root's to decide which is first: the least of the others is beside the
  // path from the root to its leaf.
  bool contested() const {
    const Key root = tree_[1];
    std::size_t node = leaves_ + slot(root);
    Key second = tree_[node ^ 1];
    for (node >>= 1; node > 1; node >>= 1) second = std::min(second, tree_[node ^ 1]);
    return second <= no_later_than(root);
  }
  bool close(Key a, Slot b) const { return key_of(b) <= no_later_than(a); }
  Key key_of(Slot s) const { return tree_[leaves_ + s]; }

  // Sets the times of three neighbouring gaps. Their paths to the root are adjacent and soon meet. Branches depend on
  // the shape of the tree only: a processor cannot predict which of two times is smaller.
  [[gnu::always_inline]] void replace(Slot s, double left_due, double due, double right_due) {
    Key* const tree = tree_.data();
    const std::size_t leaf = leaves_ + s;
    const Key left = key(left_due, s - 1), own = key(due, s), right = key(right_due, s + 1);
    tree[leaf - 1] = left;
    tree[leaf] = own;
    tree[leaf + 1] = right;
    const bool own_with_left = leaf & 1;
    const Key other = tree[own_with_left ? leaf + 2 : leaf - 2];
    std::size_t a = (leaf - 1) >> 1, b = a + 1;
    Key least_a = own_with_left ? std::min(left, own) : std::min(left, other);
    Key least_b = own_with_left ? std::min(right, other) : std::min(own, right);
    tree[a] = least_a;
    tree[b] = least_b;
    while ((a >> 1) != (b >> 1)) {
      const Key beside_a = tree[a ^ 1], beside_b = tree[b ^ 1];
      least_a = std::min(least_a, beside_a);
      least_b = std::min(least_b, beside_b);
      a >>= 1;
      b >>= 1;
      tree[a] = least_a;
      tree[b] = least_b;
    }
    a >>= 1;
    least_a = std::min(least_a, least_b);
    tree[a] = least_a;
    while (a > 1) {
      least_a = std::min(least_a, tree[a ^ 1]);
      a >>= 1;
      tree[a] = least_a;
    }
  }

  // The same for gaps that are neighbours on the line but not in the tree: left < s < right, or around the end of a
  // ring.
  [[gnu::always_inline]] void replace(Slot left, double left_due, Slot s, double due, Slot right, double right_due) {
    if (left + 1 == s && s + 1 == right)
      replace(s, left_due, due, right_due);
    else
      replace_apart(left, left_due, s, due, right, right_due);
  }

  // Empties all slots.
  void clear() { std::fill(tree_.begin(), tree_.end(), key(never, 0)); }
  // Sets one time without updating the tree; call `rebuild` once all from the first to the last slot are set.
  void set(Slot s, double due) { tree_[leaves_ + s] = key(due, s); }
  void rebuild(Slot first, Slot last) {
    for (std::size_t from = (leaves_ + first) / 2, to = (leaves_ + last) / 2; from > 0; from /= 2, to /= 2)
      for (std::size_t node = from; node <= to; ++node) refresh(node);
  }

  // Calls visit(slot) for every slot whose key is at most `bound`, from left to right, until it returns false; visits
  // no other part of the tree. Returns whether all were visited.
  template <class Visit> bool for_each_before(Key bound, Visit visit) const { return visit_before(bound, visit, 1); }
  // The largest key that may belong to the same time as `key`. It is always less than the keys of `never`, which slots
  // without a gap have.
  Key no_later_than(Key key) const { return std::min<Key>((key | mask_) + slack_, std::bit_cast<Key>(never) - 1); }

 private:
  [[gnu::noinline]] void replace_apart(Slot left, double left_due, Slot s, double due, Slot right, double right_due) {
    Key* const tree = tree_.data();
    std::size_t a = leaves_ + left, b = leaves_ + s, c = leaves_ + right;
    Key least_a = key(left_due, left), least_b = key(due, s), least_c = key(right_due, right);
    tree[a] = least_a;
    tree[b] = least_b;
    tree[c] = least_c;
    while (a > 1) {  // also after they have met: a test costs more than three steps
      least_a = std::min(least_a, tree[a ^ 1]);
      least_b = std::min(least_b, tree[b ^ 1]);
      least_c = std::min(least_c, tree[c ^ 1]);
      tree[a >>= 1] = least_a;
      tree[b >>= 1] = least_b;
      tree[c >>= 1] = least_c;
    }
  }

  void refresh(std::size_t node) { tree_[node] = std::min(tree_[2 * node], tree_[2 * node + 1]); }
  template <class Visit> bool visit_before(Key bound, Visit& visit, std::size_t node) const {
    if (tree_[node] > bound) return true;
    if (node >= leaves_) return visit(static_cast<Slot>(node - leaves_));
    return visit_before(bound, visit, 2 * node) && visit_before(bound, visit, 2 * node + 1);
  }

  std::size_t leaves_ = 0;
  Key mask_ = 0;
  Key slack_ = 0;
  LongArray<Key> tree_;  // tree_[1] the root, tree_[leaves_ + s] the key of slot s
};

}  // namespace cradle
