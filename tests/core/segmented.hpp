#pragma once
// Compares runs in segments with the plain loop, bit for bit: state, counts, energy, account, at several times; and, of
// runs with an observer, every collision.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>

#include "cradle/core/ensemble/executor.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test {

inline Workers threads(unsigned count) {
  if (count < 2) return {};
  return {count, [count](std::size_t jobs, const Workers::Work& work) { for_each(ThreadExecutor(count), jobs, work); }};
}

// Includes impractical segments: of three gaps, with one ghost, with more ghosts than gaps.
struct SegmentsAs {
  Segmentation how;
  unsigned threads;
  bool observed = true;  // also with an observer
};
inline std::vector<SegmentsAs> segmentations() {
  return {{{.gaps = 3, .ghosts = 1, .collisions = 4, .anywhere = true}, 1},
          {{.gaps = 3, .ghosts = 40, .collisions = 0.5, .anywhere = true}, 2},
          {{.gaps = 50, .ghosts = 16, .anywhere = true}, 3},
          {{.gaps = 200, .ghosts = 64, .collisions = 1, .anywhere = true}, 2},
          {{.gaps = 300, .ghosts = 8, .collisions = 8, .anywhere = true}, 8}};
}

struct SlabsMade {
  std::uint64_t slabs = 0, given_up = 0, again = 0;
  SlabsMade& operator+=(const SlabsMade& other) {
    slabs += other.slabs, given_up += other.given_up, again += other.again;
    return *this;
  }
};

// The mixture of fixtures.hpp, on a line or, with a circumference, on a ring; masses from 1 to 4.5.
template <class T> Scene<T> gas(ParticleIndex n, const T& circumference = T(0), bool unequal = false) {
  const auto mass = [=](ParticleIndex b) { return unequal ? T(T(1) + T(bits_of(b, 40, 7)) / T(2)) : T(1); };
  return as_list(*rmix<T>(n), mass, circumference);
}

// Every number of every gap, and the accounts of walls.
template <class Chain> void expect_same_bits(const Chain& a, const Chain& b) {
  const auto bits = [](const auto& x) {
    return std::bit_cast<std::array<std::uint64_t, sizeof x / sizeof(std::uint64_t)>>(x);
  };
  ASSERT_EQ(a.last() - a.first(), b.last() - b.first());
  const auto &left = a.line().gaps, &right = b.line().gaps;
  for (Slot k = 0; k <= a.last() - a.first(); ++k) {
    const Slot s = a.first() + k, r = b.first() + k;
    const auto &one = left[s], &other = right[r];
    ASSERT_EQ(bits(one.gap), bits(other.gap)) << k;
    ASSERT_EQ(bits(one.closing), bits(other.closing)) << k;
    ASSERT_EQ(bits(one.time), bits(other.time)) << k;
    if constexpr (requires { one.due; }) {
      ASSERT_EQ(bits(one.due), bits(other.due)) << k;
    }
    if constexpr (requires { one.lost; }) {
      ASSERT_EQ(bits(one.lost), bits(other.lost)) << k;
    }
    ASSERT_EQ(bits(left.lag(s)), bits(right.lag(r))) << k;
  }
  for (const End end : {End::left, End::right}) {
    ASSERT_EQ(a.walls().tally(end).collisions, b.walls().tally(end).collisions);
    for (const auto sum : {&WallTally<typename Chain::Scalar>::given, &WallTally<typename Chain::Scalar>::momentum,
                           &WallTally<typename Chain::Scalar>::dissipated})
      ASSERT_EQ(bits((a.walls().tally(end).*sum).value()), bits((b.walls().tally(end).*sum).value()));
  }
}

// All that an observer of a run receives, in its order, and the counts that it reads then: a hash of it, since a run
// has millions of collisions.
template <class T> class Observed {
 public:
  template <class Run> auto by(const Run& run) {
    return [this, &run](const Collision<T>& c) {
      ++collisions_;
      for (const T& number : {c.time.high, c.time.low, c.interval, c.closing_speed}) {
        const double rounded = to_double(number);
        add(std::bit_cast<std::uint64_t>(rounded));
        add(std::bit_cast<std::uint64_t>(to_double(T(number - T(rounded)))));
      }
      const Counts& counts = run.counts();
      add(static_cast<std::uint64_t>(c.left)), add(static_cast<std::uint64_t>(c.right));
      add(counts.collisions), add(counts.below_cutoff), add(counts.merges);
    };
  }
  std::uint64_t collisions() const { return collisions_; }
  friend bool operator==(const Observed&, const Observed&) = default;

 private:
  void add(std::uint64_t number) {
    hash_ = (hash_ ^ number) * 0x9E3779B97F4A7C15;
    hash_ ^= hash_ >> 32;
  }
  std::uint64_t collisions_ = 0, hash_ = 0;
};

// Advances a run in segments, the same with an observer, and one in the plain loop, through the same times.
template <class Chain, class T, class Law>
SlabsMade expect_same_in_segments(const Scene<T>& scene, const Law& law, const SegmentsAs& as,
                                  const std::vector<T>& times) {
  using Run = Simulation<T, Law, Chain>;
  Run plain(law, Chain(scene, T(0))), segmented(law, Chain(scene, T(0))), observed(law, Chain(scene, T(0)));
  Segments<Law, Chain> segments(threads(as.threads), as.how), observed_segments(threads(as.threads), as.how);
  Observed<T> in_plain, in_segments;
  for (const T& time : times) {
    const Status status = as.observed ? plain.advance(time, in_plain.by(plain)) : plain.advance(time);
    EXPECT_EQ(segmented.advance(time, segments), status);
    expect_same_state(plain, segmented, time);
    if (as.observed) {
      EXPECT_EQ(observed.advance(time, observed_segments, in_segments.by(observed)), status);
      expect_same_state(plain, observed, time);
      EXPECT_TRUE(in_segments == in_plain) << "other collisions, or in another order";
      EXPECT_EQ(in_plain.collisions(), plain.counts().collisions);
    }
    if (status != Status::reached) break;
  }
  if (as.observed) {
    EXPECT_EQ(observed_segments.statistics().given_up > 0, segments.statistics().given_up > 0);
  }
  return {segments.statistics().slabs, segments.statistics().given_up, segments.statistics().again};
}

}  // namespace cradle::test
