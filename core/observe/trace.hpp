#pragma once
// The trace of a run: a hash that two runs share exactly if, at every body, they have made the same contacts in the
// same sequence. A plain list of contacts would not do: contacts of different bodies commute and may be made in either
// order. So every body carries a hash of its past. A contact mixes the two pasts and gives the result to both bodies
// (the canonical form of a Mazurkiewicz trace). The digest is the sum over all bodies.

#include <cstdint>
#include <unordered_map>

#include "cradle/core/bodies.hpp"

namespace cradle {

class Trace {
 public:
  void contact(BodyIndex left, BodyIndex right) {
    const std::uint64_t of_left = past_[left], of_right = past_[right];
    digest_ -= mix(of_left, left) + mix(of_right, right);  // at a first contact mix(0, body), the same in every run
    const std::uint64_t shared = mix(mix(of_left, left) ^ (mix(of_right, right) * 3), left);
    past_[left] = past_[right] = shared;
    digest_ += mix(shared, left) + mix(shared, right);
  }
  std::uint64_t digest() const { return digest_; }

 private:
  static std::uint64_t mix(std::uint64_t past, BodyIndex body) {  // the splitmix64 finaliser
    std::uint64_t z = past + 0x9E3779B97F4A7C15 * (static_cast<std::uint64_t>(body) + 1);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  std::unordered_map<BodyIndex, std::uint64_t> past_;
  std::uint64_t digest_ = 0;
};

}  // namespace cradle
