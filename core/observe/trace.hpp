#pragma once
// The trace of a run: a hash that two runs share exactly if every particle has had the same collisions in the same
// sequence. A hash of the list of collisions would not do: collisions of different particles commute and may be made in
// either order. So every particle carries a hash of its past. A collision mixes the two pasts and gives the result to
// both particles (the canonical form of a Mazurkiewicz trace). The digest is the sum over all particles.

#include <cstdint>
#include <unordered_map>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

class Trace {
 public:
  void collision(ParticleIndex left, ParticleIndex right) {
    const std::uint64_t of_left = past_[left], of_right = past_[right];
    digest_ -=
        mix(of_left, left) + mix(of_right, right);  // at a first collision mix(0, particle), the same in every run
    const std::uint64_t shared = mix(mix(of_left, left) ^ (mix(of_right, right) * 3), left);
    past_[left] = past_[right] = shared;
    digest_ += mix(shared, left) + mix(shared, right);
  }
  std::uint64_t digest() const { return digest_; }

 private:
  static std::uint64_t mix(std::uint64_t past, ParticleIndex particle) {
    return splitmix64(past + 0x9E3779B97F4A7C15 * (static_cast<std::uint64_t>(particle) + 1));
  }

  std::unordered_map<ParticleIndex, std::uint64_t> past_;
  std::uint64_t digest_ = 0;
};

}  // namespace cradle
