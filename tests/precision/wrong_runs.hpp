// Runs that are wrong in one collision, made from the right collisions of a drawn scene: the checker must refuse each.
#pragma once

#include <gtest/gtest.h>

#include "cradle/tests/precision/drawn_scenes.hpp"

namespace cradle::test::drawn {

class WrongRuns {
 public:
  WrongRuns(const Drawn& scene, const Collisions& right, std::uint64_t seed, std::uint64_t number)
      : scene_(scene), right_(right), seed_(seed), number_(number) {}

  std::size_t pick(std::uint64_t salt, std::size_t of) const { return random_bits(seed_, number_, salt) % of; }
  std::uint64_t refused() const { return refused_; }

  void refuse(const Collisions& collisions, const std::optional<Said>& said = {}) {
    Checker<B> checker(particles_of<B>(scene_), law_of(scene_));
    ++refused_;
    ASSERT_FALSE(proved(checker, collisions, said));
  }
  void refuse_dropped(std::size_t which) {
    Collisions dropped = right_;
    dropped.erase(dropped.begin() + static_cast<std::ptrdiff_t>(which));
    refuse(dropped);
  }
  // Of neighbours; in scenes with walls or gravity also with walls, which are no neighbours where they are not.
  void refuse_invented(std::uint64_t salt) {
    const std::size_t particles = scene_.gaps.size();
    const bool walled = scene_.walls[0] || scene_.walls[1], ring = scene_.length > 0;
    const std::size_t pairs = walled ? particles + 1 : ring ? particles : particles - 1;
    const auto left = static_cast<ParticleIndex>(pick(salt + 10, pairs)) - (walled ? 1 : 0);
    const auto right = ring ? (left + 1) % static_cast<ParticleIndex>(particles) : left + 1;
    Collisions invented = right_;
    invented.insert(invented.begin() + static_cast<std::ptrdiff_t>(pick(salt + 20, invented.size() + 1)),
                    {left, right});
    refuse(invented);
  }
  // Later than the one after it, which shares a particle with it.
  void refuse_late(std::uint64_t salt) {
    Collisions late = right_;
    for (std::size_t k = pick(salt + 30, late.size()); k + 1 < late.size(); ++k)
      if (late[k] != late[k + 1] && shares_a_particle(late[k], late[k + 1])) {
        std::swap(late[k], late[k + 1]);
        return refuse(late);
      }
  }

 private:
  const Drawn& scene_;
  const Collisions& right_;
  std::uint64_t seed_, number_, refused_ = 0;
};

}  // namespace cradle::test::drawn
