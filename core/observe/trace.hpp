#pragma once
// The trace of a run: a hash that two runs share exactly if every particle has had the same collisions in the same
// sequence. A hash of the list of collisions would not do: collisions of different particles commute and may be made in
// either order. So every particle carries a hash of its past. A collision mixes the two pasts and gives the result to
// both particles (the canonical form of a Mazurkiewicz trace). The digest is the sum over all particles.

#include <cstdint>
#include <unordered_map>

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
  static std::uint64_t mix(std::uint64_t past, ParticleIndex particle) {  // the splitmix64 finaliser
    std::uint64_t z = past + 0x9E3779B97F4A7C15 * (static_cast<std::uint64_t>(particle) + 1);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  std::unordered_map<ParticleIndex, std::uint64_t> past_;
  std::uint64_t digest_ = 0;
};

}  // namespace cradle
