#pragma once
// Which replicas are put together with which: a fixed binary tree over replica indices. A node covers an aligned
// interval of 2^level indices and is made of its two halves, the lower one first; a half without replicas changes
// nothing. So the statistics of a set of replicas have the same bits however the set came about: in any order, on any
// number of threads or ranks, split, interrupted, continued, merged.
//
// A set is held as its largest full nodes: those of which every replica is there and the sibling is not. Replicas
// [first, first + n) take at most 2 log2 n of them, and T replicas that are still missing from such a range split it
// into at most T + 1 ranges. Memory grows with threads times log(replicas). A replica that failed is there, and empty:
// nodes grow over it, and what it leaves to the others is what a set without it gives.
//
// Why not superaccumulators (Neal, arXiv:1505.05571), which are exact in any order: two of them for an entry, for the
// sum and (double length) for the sum of squares, take some 1.6 kB against 32 bytes times the nodes held, one or two
// dozen, and each addition costs several times the dozen operations of a pairwise update. The tree's error grows with
// log(replicas) only, see tests/core/ensemble/ensemble_test.cpp.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cradle/core/ensemble/moments.hpp"

namespace cradle {

using ReplicaIndex = std::uint64_t;  // below 2^63

struct ReplicaRange {
  ReplicaIndex first = 0;
  std::uint64_t count = 0;
  ReplicaIndex end() const { return first + count; }
  static auto state(auto& self) { return std::tie(self.first, self.count); }
  bool operator==(const ReplicaRange&) const = default;
};

struct TreeNode {
  ReplicaIndex first = 0;  // a multiple of 2^level
  unsigned level = 0;
  Moments moments;
  ReplicaRange range() const { return {first, std::uint64_t{1} << level}; }
  static auto state(auto& self) { return std::tie(self.first, self.level, self.moments); }
  bool operator==(const TreeNode&) const = default;
};

/// All functions may be called from several threads at once.
class MomentTree {
 public:
  /// One replica's vector; none for one that failed.
  void add(ReplicaIndex replica, std::optional<std::vector<double>> values) {
    add({replica, 0, values ? moments_of(std::move(*values)) : Moments()});
  }

  /// A node that was taken from another set, which must have no replica in common with this one; throws
  /// std::invalid_argument for one that has, that no tree can hold, or whose vectors are of another length.
  void add(TreeNode node) {
    if (node.level > 62 || node.first >> 63 || (node.first & (node.range().count - 1)) != 0)
      throw std::invalid_argument("no node of the tree of replicas: index " + std::to_string(node.first) + ", level " +
                                  std::to_string(node.level));
    std::optional<Siblings> siblings = keep(std::move(node));
    // What is slow, putting two nodes together, is done outside the lock; until that is done readers see the two.
    while (siblings) siblings = replace(*siblings, combine(*siblings->lower, *siblings->upper));
  }

  /// Statistics of the whole set.
  Moments total() const {
    const std::scoped_lock lock(mutex_);
    unsigned level = 0;
    if (!nodes_.empty()) {
      const ReplicaRange last = range(std::prev(nodes_.end()));
      while ((last.end() - 1) >> level) ++level;
    }
    return fold({0, std::uint64_t{1} << level});
  }

  /// The set as its nodes, by index.
  std::vector<TreeNode> nodes() const {
    const std::scoped_lock lock(mutex_);
    std::vector<TreeNode> all;
    all.reserve(nodes_.size());
    for (const auto& [first, held] : nodes_) all.push_back({first, held.level, *held.moments});
    return all;
  }
  std::size_t nodes_held() const {
    const std::scoped_lock lock(mutex_);
    return nodes_.size();
  }

  /// Replicas there, failed ones included.
  std::uint64_t size() const {
    const std::scoped_lock lock(mutex_);
    std::uint64_t sum = 0;
    for (auto at = nodes_.begin(); at != nodes_.end(); ++at) sum += range(at).count;
    return sum;
  }

  bool contains(ReplicaIndex replica) const { return overlaps({replica, 1}); }

  /// Is any of these replicas there?
  bool overlaps(ReplicaRange wanted) const {
    const std::scoped_lock lock(mutex_);
    return holds_some_of(wanted);
  }

  /// Those of these replicas that are not there, in order.
  std::vector<ReplicaRange> missing(ReplicaRange wanted) const { return gaps(wanted, false); }
  /// Those that are.
  std::vector<ReplicaRange> present() const { return gaps({0, std::uint64_t{1} << 63}, true); }

 private:
  struct Held {
    unsigned level;
    std::shared_ptr<const Moments> moments;
  };
  using Nodes = std::map<ReplicaIndex, Held>;  // disjoint, so the first index names a node

  static ReplicaRange range(Nodes::const_iterator at) { return {at->first, std::uint64_t{1} << at->second.level}; }

  bool holds_some_of(ReplicaRange wanted) const {
    auto after = nodes_.lower_bound(wanted.end());  // the first node beyond; the one before it reaches furthest
    return after != nodes_.begin() && range(std::prev(after)).end() > wanted.first && wanted.count > 0;
  }

  struct Siblings {
    ReplicaIndex first;  // of the lower one
    unsigned level;
    std::shared_ptr<const Moments> lower, upper;
  };

  std::optional<Siblings> keep(TreeNode node) {
    const std::scoped_lock lock(mutex_);
    if (holds_some_of(node.range()))
      throw std::invalid_argument("replicas " + std::to_string(node.first) + " to " +
                                  std::to_string(node.range().end() - 1) + ": some of them are there already");
    if (node.moments.replicas > 0) {
      if (entries_.value_or(node.moments.entries()) != node.moments.entries())
        throw std::invalid_argument("statistics of vectors of different lengths (" + std::to_string(*entries_) +
                                    " and " + std::to_string(node.moments.entries()) + " numbers)");
      entries_ = node.moments.entries();
    }
    return hold(node.first, node.level, std::move(node.moments));
  }

  std::optional<Siblings> replace(const Siblings& halves, Moments whole) {
    const std::scoped_lock lock(mutex_);
    nodes_.erase(halves.first);
    nodes_.erase(halves.first + (std::uint64_t{1} << halves.level));
    return hold(halves.first, halves.level + 1, std::move(whole));
  }

  // Gives the node and its sibling if that is there. Whoever held the later of the two, and nobody else, gets them.
  std::optional<Siblings> hold(ReplicaIndex first, unsigned level, Moments moments) {
    auto lower = nodes_.emplace(first, Held{level, std::make_shared<const Moments>(std::move(moments))}).first;
    auto upper = nodes_.find(first ^ (std::uint64_t{1} << level));
    if (upper == nodes_.end() || upper->second.level != level) return std::nullopt;
    if (upper->first < first) std::swap(lower, upper);
    return Siblings{lower->first, level, lower->second.moments, upper->second.moments};
  }

  // Value of the node over `whole`, full or not.
  Moments fold(ReplicaRange whole) const {
    const auto at = nodes_.lower_bound(whole.first);
    if (at == nodes_.end() || at->first >= whole.end()) return {};
    if (range(at) == whole) return *at->second.moments;
    const std::uint64_t half = whole.count / 2;
    return combine(fold({whole.first, half}), fold({whole.first + half, half}));
  }

  std::vector<ReplicaRange> gaps(ReplicaRange wanted, bool complement) const {
    const std::scoped_lock lock(mutex_);
    std::vector<ReplicaRange> ranges;
    const auto put = [&](ReplicaIndex from, ReplicaIndex to) {
      if (from >= to) return;
      if (!ranges.empty() && ranges.back().end() == from)
        ranges.back().count += to - from;
      else
        ranges.push_back({from, to - from});
    };
    ReplicaIndex done = wanted.first;
    for (auto at = nodes_.begin(); at != nodes_.end(); ++at) {
      const ReplicaIndex from = std::clamp(at->first, wanted.first, wanted.end()),
                         to = std::clamp(range(at).end(), wanted.first, wanted.end());
      if (complement)
        put(from, to);
      else
        put(done, from);
      done = std::max(done, to);
    }
    if (!complement) put(done, wanted.end());
    return ranges;
  }

  mutable std::mutex mutex_;
  Nodes nodes_;
  std::optional<std::size_t> entries_;  // of every vector
};

}  // namespace cradle
