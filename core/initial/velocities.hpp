#pragma once
// Random velocities, whole numbers of 2^-28 standard deviations: Gaussian ones by Marsaglia's polar method (SIAM Rev.
// 6, 260, 1964, doi 10.1137/1006063), or uniform ones. They are keyed by seed, replica and particle (counter_rng.hpp).
//
// Gaussian numbers are drawn four at once (two without AVX2), as vectors of GCC and Clang: the operations of each, and
// so its bits, are those of scalars. Those that the method rejects, 21 %, take part in the next draw.

#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/initial/rows.hpp"

namespace cradle {

// How velocities are drawn: those of many particles at once, from `first` on, or one after the other.
class VelocityDraw : public std::function<void(ParticleIndex first, std::span<std::int64_t> velocities)> {
 public:
  using std::function<void(ParticleIndex, std::span<std::int64_t>)>::function;
  template <std::invocable<ParticleIndex> OfOne>
  VelocityDraw(const OfOne& velocity)
      : function([velocity](ParticleIndex first, std::span<std::int64_t> velocities) {
          for (std::int64_t& each : velocities) each = velocity(first++);
        }) {}
};

inline std::vector<std::int64_t> drawn(const VelocityDraw& draw, ParticleIndex first, ParticleIndex count) {
  std::vector<std::int64_t> velocities(static_cast<std::size_t>(count));
  draw(first, velocities);
  return velocities;
}

namespace detail {

// The index of random bits is the particle and the number of the attempt, from 1 on: displacements have 0, 1, ...
inline constexpr std::uint64_t attempt = std::uint64_t{1} << 56;

namespace lanes {

#ifdef __AVX2__
inline constexpr std::size_t count = 4;
#else
inline constexpr std::size_t count = 2;
#endif
using Words [[gnu::vector_size(8 * count)]] = std::uint64_t;
using Integers [[gnu::vector_size(8 * count)]] = std::int64_t;
using Doubles [[gnu::vector_size(8 * count)]] = double;

inline constexpr std::uint64_t low = 0xFFFFFFFF;  // half of a word

// The product of numbers below 2^32. Compilers do not see that one instruction is enough.
inline Words product(Words a, std::uint64_t b) {
#if defined(__AVX2__) && !defined(__clang__)
  using Halves [[gnu::vector_size(8 * count)]] = int;
  return std::bit_cast<Words>(__builtin_ia32_pmuludq256(std::bit_cast<Halves>(a), std::bit_cast<Halves>(Words{} + b)));
#else
  return a * b;
#endif
}

// cradle::random_bits.
inline Words random_bits(std::uint64_t seed, std::uint64_t replica, Words index) {
  Words a = index & low, b = index >> 32, c = Words{} + (replica & low), d = Words{} + (replica >> 32);
  std::uint64_t key = seed & low, other_key = seed >> 32;
  for (int round = 0; round < 10; ++round) {
    const Words of_a = product(a, 0xD2511F53), of_c = product(c, 0xCD9E8D57);
    a = (of_c >> 32) ^ b ^ key, b = of_c & low, c = (of_a >> 32) ^ d ^ other_key, d = of_a & low;
    key = (key + 0x9E3779B9) & low, other_key = (other_key + 0xBB67AE85) & low;
  }
  return a | b << 32;
}

// Of numbers below 2^32: the bits of 2^52 + x are those of 2^52 plus x.
inline Doubles exactly(Words x) { return std::bit_cast<Doubles>(x + 0x4330000000000000) - 0x1p52; }

// portable_log, 0 < x <= 2.
inline Doubles logarithm(Doubles x) {
  constexpr double ln2 = 0.693147180559945309;
  const auto bits = std::bit_cast<Words>(x);
  Doubles mantissa = std::bit_cast<Doubles>((bits & 0x000FFFFFFFFFFFFF) | 0x3FE0000000000000),
          exponent = exactly(bits >> 52) - 1022;
  const auto small = mantissa < 0.70710678118654752;
  mantissa = small ? mantissa * 2 : mantissa;
  exponent = small ? exponent - 1 : exponent;
  const Doubles s = (mantissa - 1) / (mantissa + 1), square = s * s;
  Doubles sum{};
  for (int k = 23; k > 0; k -= 2) sum = sum * square + 1.0 / k;
  return 2 * s * sum + exponent * ln2;
}

struct Polar {
  Doubles square;     // rejected if it is not below 1
  Integers velocity;  // else
};
inline Polar polar(Words bits) {
  const Doubles u = (exactly(bits >> 32) + 0.5) * 0x1p-31 - 1, v = (exactly(bits & low) + 0.5) * 0x1p-31 - 1;
  const Doubles square = u * u + v * v, ratio = -2 * logarithm(square) / square;
  Doubles root{};
  for (std::size_t k = 0; k < count; ++k) root[k] = std::sqrt(ratio[k]);
  // The greatest whole number that is not above x: the nearest one, as in `exactly` but for either sign, or one less.
  constexpr double shift = 0x1.8p52;
  const Doubles x = u * root * static_cast<double>(displacement_unit) + 0.5, nearest = (x + shift) - shift;
  return {square, std::bit_cast<Integers>(nearest + shift) + (nearest > x) - std::bit_cast<std::int64_t>(shift)};
}

}  // namespace lanes

}  // namespace detail

inline VelocityDraw gaussian_velocity(std::uint64_t seed, std::uint64_t replica) {
  return [=](ParticleIndex first, std::span<std::int64_t> velocities) {
    using detail::attempt;
    namespace lanes = detail::lanes;
    lanes::Words index{};
    const auto begin = static_cast<std::uint64_t>(first);
    std::size_t used = 0;
    for (std::uint64_t next = 0; next < velocities.size() || used > 0;) {
      for (; used < lanes::count && next < velocities.size(); ++next) index[used++] = (begin + next) | attempt;
      const lanes::Polar of = lanes::polar(lanes::random_bits(seed, replica, index));
      const std::size_t tried = std::exchange(used, 0);
      for (std::size_t k = 0; k < tried; ++k)
        if (of.square[k] < 1)
          velocities[(index[k] & (attempt - 1)) - begin] = of.velocity[k];
        else
          index[used++] = index[k] + attempt;
    }
  };
}

// Uniform velocities between plus and minus sqrt(3) standard deviations.
inline VelocityDraw uniform_velocity(std::uint64_t seed, std::uint64_t replica) {
  constexpr std::int64_t bound = 464943848;  // sqrt(3) 2^28
  return [=](ParticleIndex first, std::span<std::int64_t> velocities) {
    for (auto index = static_cast<std::uint64_t>(first) | detail::attempt; std::int64_t & velocity : velocities)
      velocity = uniform_integer(random_bits(seed, replica, index++), bound);
  };
}

}  // namespace cradle
