#pragma once
// The order in which replicas are combined: a fixed binary tree over replica indices. A node covers an aligned interval
// of 2^level indices and combines its two halves, the lower one first; a half without replicas changes nothing. So the
// statistics of a set of replicas have the same bits for every history of the set: in any order, on any number of
// threads or ranks, split, interrupted, continued, merged.
//
// A set is stored as its largest full nodes: those with all replicas whose sibling is not full. Replicas [first, first
// + n) need at most 2 log2 n nodes, and T replicas that are still missing split them into at most T + 1 ranges. Memory
// grows with threads times log(replicas). A failed replica is present but empty: nodes include it, and the statistics
// are those of the set without it.
//
// Superaccumulators (Neal, arXiv:1505.05571) would be exact in any order. But two per entry, for the sum and (double
// length) for the sum of squares, need about 1.6 kB instead of 32 bytes times the stored nodes, one or two dozen, and
// each addition costs several times the dozen operations of a pairwise update. The error of the tree grows only with
// log(replicas), see tests/core/ensemble/ensemble_test.cpp.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/ensemble/statistics.hpp"

namespace cradle {

using ReplicaIndex = std::uint64_t;  // below 2^63

struct ReplicaRange {
  ReplicaIndex first = 0;
  std::uint64_t count = 0;
  ReplicaIndex end() const { return first + count; }
  static auto state(auto& self) { return fields(self.first, self.count); }
  bool operator==(const ReplicaRange&) const = default;
};

struct TreeNode {
  ReplicaIndex first = 0;  // a multiple of 2^level
  unsigned level = 0;
  Moments moments;
  ReplicaRange range() const { return {first, std::uint64_t{1} << level}; }
  static auto state(auto& self) { return fields(self.first, self.level, self.moments); }
  bool operator==(const TreeNode&) const = default;
};

/// Adds the node of the replicas that follow, and combines nodes as the tree does. Leaves what is not needed any more.
inline void append(std::vector<TreeNode>& nodes, TreeNode next, std::vector<Moments>& left_over) {
  for (; !nodes.empty() && nodes.back().level == next.level; nodes.pop_back()) {
    TreeNode& before = nodes.back();
    if ((before.first ^ next.first) != next.range().count) break;  // no siblings
    Moments both = combine(std::move(before.moments), next.moments);
    left_over.push_back(std::exchange(next.moments, std::move(both)));
    next.first = before.first, ++next.level;
  }
  nodes.push_back(std::move(next));
}

/// All functions may be called from several threads at once. A thread that adds many replicas combines them first, by
/// `append`, since others wait while nodes are combined here.
class MomentTree {
 public:
  /// Adds one replica's vector; none for a failed replica.
  void add(ReplicaIndex replica, std::optional<std::vector<double>> values) {
    add({replica, 0, values ? moments_of(*values) : Moments()});
  }

  /// Adds a node from another set. Throws std::invalid_argument if the sets share replicas, if no tree has such a node,
  /// or if its vectors have another length.
  void add(TreeNode node) {
    if (node.level > 62 || node.first >> 63 || (node.first & (node.range().count - 1)) != 0)
      throw std::invalid_argument("no node of the tree of replicas: index " + std::to_string(node.first) + ", level " +
                                  std::to_string(node.level));
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
    for (;; ++node.level) {  // siblings become one node
      const auto sibling = nodes_.find(node.first ^ node.range().count);
      if (sibling == nodes_.end() || sibling->second.level != node.level) break;
      TreeNode upper = std::move(sibling->second);
      nodes_.erase(sibling);
      if (upper.first < node.first) std::swap(node, upper);
      node.moments = combine(std::move(node.moments), upper.moments);
    }
    const ReplicaIndex first = node.first;
    nodes_.emplace(first, std::move(node));
  }

  /// Statistics of the whole set.
  Moments total() const {
    const std::scoped_lock lock(mutex_);
    if (nodes_.empty()) return {};
    return fold({0, std::bit_ceil(nodes_.rbegin()->second.range().end())});
  }

  /// The nodes of the set, by index.
  std::vector<TreeNode> nodes() const {
    const std::scoped_lock lock(mutex_);
    std::vector<TreeNode> all;
    all.reserve(nodes_.size());
    for (const auto& [first, node] : nodes_) all.push_back(node);
    return all;
  }

  /// The number of replicas, failed ones included.
  std::uint64_t size() const {
    const std::scoped_lock lock(mutex_);
    std::uint64_t sum = 0;
    for (const auto& [first, node] : nodes_) sum += node.range().count;
    return sum;
  }

  bool contains(ReplicaIndex replica) const { return overlaps({replica, 1}); }

  /// Whether any of these replicas is present.
  bool overlaps(ReplicaRange wanted) const {
    const std::scoped_lock lock(mutex_);
    return holds_some_of(wanted);
  }

  /// The replicas that are present, in order.
  std::vector<ReplicaRange> present() const {
    const std::scoped_lock lock(mutex_);
    std::vector<ReplicaRange> ranges;
    for (const auto& [first, node] : nodes_)
      if (!ranges.empty() && ranges.back().end() == first)
        ranges.back().count += node.range().count;
      else
        ranges.push_back(node.range());
    return ranges;
  }
  /// The missing ones of these replicas.
  std::vector<ReplicaRange> missing(ReplicaRange wanted) const {
    std::vector<ReplicaRange> gaps;
    ReplicaIndex done = wanted.first;
    for (const ReplicaRange& held : present()) {
      if (const ReplicaIndex to = std::min(held.first, wanted.end()); done < to) gaps.push_back({done, to - done});
      done = std::max(done, held.end());
    }
    if (done < wanted.end()) gaps.push_back({done, wanted.end() - done});
    return gaps;
  }

 private:
  bool holds_some_of(ReplicaRange wanted) const {
    auto after = nodes_.lower_bound(wanted.end());  // the first node beyond; the one before it extends furthest
    return after != nodes_.begin() && std::prev(after)->second.range().end() > wanted.first && wanted.count > 0;
  }

  // The moments of the node over `whole`, full or not.
  Moments fold(ReplicaRange whole) const {
    const auto at = nodes_.lower_bound(whole.first);
    if (at == nodes_.end() || at->first >= whole.end()) return {};
    if (at->second.range() == whole) return at->second.moments;
    const std::uint64_t half = whole.count / 2;
    return combine(fold({whole.first, half}), fold({whole.first + half, half}));
  }

  mutable std::mutex mutex_;
  std::map<ReplicaIndex, TreeNode> nodes_;  // disjoint, so the first index names a node
  std::optional<std::size_t> entries_;      // length of every vector
};

}  // namespace cradle
