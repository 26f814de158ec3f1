#pragma once
// Keyed random numbers without state: Philox4x32-10 (Salmon et al., SC'11, doi 10.1145/2063384.2063405). The key is the
// seed, the counter is (replica, index), so a particle's number does not depend on when or in which order it is drawn:
// a streamed row, a full row and a single replica start identically.

#include <array>
#include <cstdint>

namespace cradle {

// Four random words for a counter and a key.
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * counter[0], b = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

// 64 random bits for (seed, replica, index).
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t replica, std::uint64_t index) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
  const auto words = philox4x32({low(index), high(index), low(replica), high(replica)}, {low(seed), high(seed)});
  return words[0] | std::uint64_t{words[1]} << 32;
}

// Uniform integer in [-bound, bound], 0 <= bound < 2^31. Relative errors of probabilities are at most 2^-32.
constexpr std::int64_t uniform_integer(std::uint64_t bits, std::int64_t bound) {
  const auto range = static_cast<std::uint64_t>(2 * bound + 1);
  return static_cast<std::int64_t>(((bits >> 32) * range + (((bits & 0xFFFFFFFF) * range) >> 32)) >> 32) - bound;
}

}  // namespace cradle
