// One checker is given collisions one by one, another one in pieces: all that they know is the same, to the bit.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "cradle/tests/precision/drawn_scenes.hpp"

namespace cradle::test::drawn {

struct Known {
  std::uint64_t collisions, in_doubles, below_cutoff;
  std::vector<double> numbers;
  friend bool operator==(const Known&, const Known&) = default;
};
inline void add(std::vector<double>& to, const B& x) {
  to.insert(to.end(), {x.middle().high(), x.middle().low(), x.radius()});
}
inline Known known(const Checker<B>& checker) {
  Known all{checker.proved().collisions, checker.proved().in_doubles, checker.proved().below_cutoff, {}};
  checker.for_each(B(0),
                   [&](ParticleIndex, const B&, const B& x, const B& v) { add(all.numbers, x), add(all.numbers, v); });
  const auto last = checker.state_now();
  add(all.numbers, last.time), add(all.numbers, last.closing), add(all.numbers, last.energy);
  for (const auto& account : last.walls) add(all.numbers, account.given);
  return all;
}

inline void compare_side_by_side(const std::shared_ptr<const Particles<B>>& particles, const CertainLaw<B>& law,
                                 const Collisions& collisions, std::size_t piece, bool proves) {
  Checker<B> one(particles, law), many(particles, law);
  std::optional<Doubt<B>> doubt;
  std::optional<DoubtAt<B>> at;
  for (std::size_t k = 0; k < collisions.size() && !doubt; k += piece) {
    const std::span<const Checker<B>::Pair> some =
        std::span(collisions).subspan(k, std::min(piece, collisions.size() - k));
    at = many.collisions(some);
    std::size_t number = 0;
    for (; number < some.size() && !doubt; ++number) doubt = one.collision(some[number].first, some[number].second);
    ASSERT_EQ(doubt.has_value(), at.has_value());
    if (!doubt) {
      if (k % 97 < piece || k + piece >= collisions.size()) {
        ASSERT_EQ(known(one), known(many));
      }
      continue;
    }
    EXPECT_EQ(at->number + 1, number);
    EXPECT_EQ(at->doubt.check, doubt->check);
    EXPECT_EQ(at->doubt.refuted, doubt->refuted);
    EXPECT_EQ(at->doubt.left, doubt->left);
    EXPECT_EQ(at->doubt.right, doubt->right);
    std::vector<double> quantities, of_one;
    add(quantities, at->doubt.first), add(quantities, at->doubt.second);
    add(of_one, doubt->first), add(of_one, doubt->second);
    EXPECT_EQ(quantities, of_one);
    EXPECT_EQ(many.proved().collisions, one.proved().collisions);
    EXPECT_EQ(many.proved().in_doubles, one.proved().in_doubles);
    EXPECT_EQ(many.proved().below_cutoff, one.proved().below_cutoff);
  }
  EXPECT_EQ(doubt.has_value(), !proves);
}

}  // namespace cradle::test::drawn
