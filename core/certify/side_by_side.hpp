#pragma once
// The checker's arithmetic for many collisions at once (checker.hpp). Collisions that share no particle may be checked
// in any order, so those of one list are divided into levels: a collision is one level above the last one of either of
// its particles. Those of a level share no particle, and are computed side by side, by loops that compilers turn into
// vectors, with the operations of the checker for one collision: enclosures are the same to the bit.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cradle/core/certify/certain_state.hpp"
#include "cradle/core/certify/world_lines.hpp"

namespace cradle {

// Numbers that are a few doubles each, and have what a loop without jumps needs.
template <class N>
concept SideBySide = Enclosing<N> && requires(const N x, const std::array<double, N::doubles> of) {
  { x.in_doubles() } -> std::same_as<std::array<double, N::doubles>>;
  { N::of_doubles(of) } -> std::same_as<N>;
  { certainly_positive(x) } -> std::same_as<bool>;   // is_positive
  { less_in_doubles(x, x) } -> std::same_as<bool>;   // order_in_doubles is Order::less
  { quotient_by_nonzero(x, x) } -> std::same_as<N>;  // x / y; means nothing where y may be 0
};

// Collisions of identical particles that bounce, `most` of them at a time, and what comes of them.
template <class N> class Bounces {};

template <SideBySide N> class Bounces<N> {
 public:
  static constexpr std::size_t most = 64;

  // Elastic below the cut-off, which is negative where there is none, or `always_elastic`.
  Bounces(const typename N::Share& share, const N& cutoff, bool always_elastic)
      : share_(share), cutoff_(cutoff), always_elastic_(always_elastic) {}

  // `changed`: the last collision of a particle.
  void put(std::size_t k, const auto& left, const auto& right) {
    left_place_.put(k, left.place), left_velocity_.put(k, left.velocity), left_changed_.put(k, left.changed);
    right_place_.put(k, right.place), right_velocity_.put(k, right.velocity), right_changed_.put(k, right.changed);
  }
  void make(std::size_t count) {
    typename N::Share share = share_;
    N cutoff = cutoff_;
    for (std::size_t k = 0; k < count; ++k) {
      N l = left_place_[k], r = right_place_[k], lv = left_velocity_[k], rv = right_velocity_[k];
      N closing = lv - rv, apart = l - r, time = -quotient_by_nonzero(apart, closing);
      const bool below = less_in_doubles(closing, cutoff), above = less_in_doubles(cutoff, closing);
      const bool later = less_in_doubles(left_changed_[k], time) & less_in_doubles(right_changed_[k], time);
      auto places = N::combined(l, r, apart, share, share), velocities = N::combined(lv, rv, closing, share, share);
      left_place_.put(k, places.left), right_place_.put(k, places.right);
      left_velocity_.put(k, velocities.left), right_velocity_.put(k, velocities.right);
      left_changed_.put(k, time);
      certain_[k] = certainly_positive(closing) & later & (below | above) ? 1 : 0;
      below_[k] = below ? 1 : 0;
    }
  }
  // Whether doubles have decided all that is to be certain of it; else nothing is known of it.
  bool certain(std::size_t k) const { return certain_[k] != 0; }
  bool below_cutoff(std::size_t k) const { return below_[k] != 0; }
  void get(std::size_t k, auto& left, auto& right) const {
    if (always_elastic_ || below_cutoff(k)) {  // they exchange world lines
      std::swap(left.place, right.place), std::swap(left.velocity, right.velocity);
    } else {
      left.place = left_place_[k], left.velocity = left_velocity_[k];
      right.place = right_place_[k], right.velocity = right_velocity_[k];
    }
    left.changed = right.changed = left_changed_[k];
    left.touched = right.touched = true;
  }

 private:
  class Column {
   public:
    N operator[](std::size_t k) const {
      std::array<double, N::doubles> of;
      for (std::size_t part = 0; part < N::doubles; ++part) of[part] = parts_[part][k];
      return N::of_doubles(of);
    }
    void put(std::size_t k, const N& x) {
      const std::array<double, N::doubles> of = x.in_doubles();
      for (std::size_t part = 0; part < N::doubles; ++part) parts_[part][k] = of[part];
    }

   private:
    alignas(64) double parts_[N::doubles][most] = {};
  };

  typename N::Share share_;
  N cutoff_;
  bool always_elastic_;
  Column left_place_, left_velocity_, left_changed_, right_place_, right_velocity_, right_changed_;
  alignas(64) std::int64_t certain_[most] = {}, below_[most] = {};
};

// The collisions of a list by levels.
class Levels {
 public:
  struct Entry {
    std::uint32_t left, right;  // lines of its particles
    std::uint32_t number;       // in the list
  };

  void begin(std::size_t most) {
    base_ = next_, count_ = 0;
    ends_.clear();
    if (listed_.size() < most) listed_.resize(most), sorted_.resize(most);
  }
  // The next one; `left` and `right` hold the levels of their last collisions, of whatever list.
  void add(auto& left, auto& right, ParticleIndex particle) {
    std::uint64_t level = left.level < right.level ? right.level : left.level;
    level = level < base_ ? base_ : level;
    left.level = right.level = level + 1;
    if (level == next_) ++next_, ends_.push_back(0);
    level -= base_;
    ++ends_[level];
    listed_[count_++] = {particle, static_cast<std::uint32_t>(level)};
  }
  // `first`, `last`: the particles that have lines, in their order; right of the last one stands the first.
  void sort(ParticleIndex first, ParticleIndex last) {
    std::uint32_t at = 0;
    for (std::uint32_t& end : ends_) at += std::exchange(end, at);
    for (std::uint32_t k = 0; k < count_; ++k) {
      const auto [particle, level] = listed_[k];
      const auto left = static_cast<std::uint32_t>(particle - first);
      sorted_[ends_[level]++] = {left, particle == last ? 0 : left + 1, k};
    }
  }
  std::size_t count() const { return ends_.size(); }
  std::span<const Entry> operator[](std::size_t level) const {
    const std::size_t begin = level == 0 ? 0 : ends_[level - 1];
    return {sorted_.data() + begin, ends_[level] - begin};
  }

 private:
  struct Listed {
    ParticleIndex particle;  // the left one
    std::uint32_t level;
  };

  std::uint64_t base_ = 0, next_ = 0;  // levels of this list
  std::uint32_t count_ = 0;
  std::vector<Listed> listed_;
  std::vector<Entry> sorted_;
  std::vector<std::uint32_t> ends_;  // of levels in `sorted_`; before, their sizes
};

// Many collisions of identical particles that bounce, proved level by level. What plain doubles leave open is made
// alone, as it would be in the order of the run. Of those in doubt the first in that order is reported: those before it
// depend on none that is in doubt, so they are proved.
template <class N> class InLevels {};

template <SideBySide N> class InLevels<N> {
 public:
  using Pair = std::pair<ParticleIndex, ParticleIndex>;
  static constexpr std::size_t most = 2048;  // so that lists stay in the nearest caches

  // The arguments are those of Bounces.
  InLevels(const typename N::Share& share, const N& cutoff, bool always_elastic)
      : bounces_(share, cutoff, always_elastic) {}

  // Checks `pairs`, at most `most` collisions in the order of the run. neighbours(left, right) says whether two
  // particles are neighbours, and takes in those beside them; collide(left, right) makes one collision alone. The last
  // one is always made alone, since a run may end with it.
  template <class Neighbours, class Collide>
  std::optional<DoubtAt<N>> operator()(std::span<const Pair> pairs, WorldLines<N>& lines, Proved& proved,
                                       Neighbours neighbours, Collide collide) {
    const std::size_t last = pairs.size() - 1;
    const Proved before = proved;
    std::uint64_t together = 0;
    std::optional<DoubtAt<N>> first;
    levels_.begin(last);
    for (std::size_t k = 0; k < last && !first; ++k) {
      const auto [left, right] = pairs[k];
      if (lines.inside(left, right) || neighbours(left, right))
        levels_.add(lines[left], lines[right], left);
      else
        first = {k, {Check::neighbours, true, left, right}};
    }
    levels_.sort(lines.first(), lines.last());
    how_.assign(pairs.size(), in_doubles);
    const auto alone = [&](std::size_t k) {
      const Proved so_far = proved;
      auto doubt = collide(pairs[k].first, pairs[k].second);
      if (doubt && (!first || k < first->number)) first = {k, std::move(*doubt)};
      how_[k] = (proved.in_doubles > so_far.in_doubles ? in_doubles : 0) |
                (proved.below_cutoff > so_far.below_cutoff ? below_cutoff : 0);
    };
    WorldLine<N>* line = &lines[lines.first()];
    for (std::size_t level = 0; level < levels_.count(); ++level)
      for (auto rest = levels_[level]; !rest.empty();) {
        const auto some = rest.first(std::min(rest.size(), Bounces<N>::most));
        rest = rest.subspan(some.size());
        for (std::size_t k = 0; k < some.size(); ++k) bounces_.put(k, line[some[k].left], line[some[k].right]);
        bounces_.make(some.size());
        for (std::size_t k = 0; k < some.size(); ++k) {
          const auto [left, right, number] = some[k];
          if (!bounces_.certain(k) || right == 0) {  // 0: over the seam
            alone(number);
            continue;
          }
          bounces_.get(k, line[left], line[right]);
          ++together;
          if (bounces_.below_cutoff(k)) ++proved.below_cutoff, how_[number] |= below_cutoff;
        }
      }
    proved.collisions += together, proved.in_doubles += together;
    if (!first) alone(last);
    if (!first) return std::nullopt;
    proved = before;
    proved.collisions += first->number;
    for (std::size_t k = 0; k < first->number; ++k) {
      proved.in_doubles += (how_[k] & in_doubles) != 0;
      proved.below_cutoff += (how_[k] & below_cutoff) != 0;
    }
    return first;
  }

 private:
  static constexpr std::uint8_t in_doubles = 1, below_cutoff = 2;

  Bounces<N> bounces_;
  Levels levels_;
  std::vector<std::uint8_t> how_;  // each collision was decided
};

}  // namespace cradle
