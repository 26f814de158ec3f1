#pragma once
// Many collisions of identical particles that bounce, proved level by level (side_by_side.hpp): those of one level
// share no particle. What plain doubles leave open is made alone, as it would be in the order of the run. Of those in
// doubt the first in that order is reported: those before it depend on none that is in doubt, so they are proved.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cradle/core/certify/certain_state.hpp"
#include "cradle/core/certify/side_by_side.hpp"
#include "cradle/core/certify/world_lines.hpp"

namespace cradle {

template <class N> class InLevels {};

template <SideBySide N> class InLevels<N> {
 public:
  using Pair = std::pair<ParticleIndex, ParticleIndex>;
  static constexpr std::size_t most = 2048;  // so that lists stay in the nearest caches

  // The arguments are those of Bounces (side_by_side.hpp).
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
