#pragma once
// Keyed random numbers without state: Philox4x32-10 (Salmon et al., SC'11, doi 10.1145/2063384.2063405). The key is the
// seed, the counter is (replica, index), so a particle's number does not depend on when or in which order it is drawn:
// a streamed row, a full row and a single replica start identically.

#include <array>
#include <cmath>
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

// The finaliser of splitmix64: a number whose bits depend on all bits of z.
constexpr std::uint64_t splitmix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}

// Uniform integer in [-bound, bound], 0 <= bound < 2^31. Relative errors of probabilities are at most 2^-32.
constexpr std::int64_t uniform_integer(std::uint64_t bits, std::int64_t bound) {
  const auto range = static_cast<std::uint64_t>(2 * bound + 1);
  return static_cast<std::int64_t>(((bits >> 32) * range + (((bits & 0xFFFFFFFF) * range) >> 32)) >> 32) - bound;
}

namespace detail {

// ln x for 0 < x <= 1, by the four operations alone: a library's logarithm differs between machines in the last bit.
inline double portable_log(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < 0.70710678118654752) mantissa *= 2, --exponent;
  const double s = (mantissa - 1) / (mantissa + 1), square = s * s;  // ln m = 2 artanh s, |s| < 0.172
  double sum = 0;
  for (int k = 23; k > 0; k -= 2) sum = sum * square + 1.0 / k;
  return 2 * s * sum + exponent * 0.693147180559945309;
}

}  // namespace detail

// An exponential number of mean 1 from 52 of the bits.
inline double exponential(std::uint64_t bits) {
  return -detail::portable_log((static_cast<double>(bits >> 12) + 0.5) * 0x1p-52);
}

}  // namespace cradle
