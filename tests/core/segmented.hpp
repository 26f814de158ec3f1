#pragma once
// Compares runs in segments with the plain loop, bit for bit: state, counts, energy, account, at several times.

#include <gtest/gtest.h>

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
  const Scene<T> like = rmix<T>(n);
  std::vector<T> x, v, m;
  for (ParticleIndex i = 0; i < n; ++i) {
    x.push_back(like->position(i));
    v.push_back(like->velocity(i));
    if (unequal) m.push_back(T(1) + T(bits_of(i, 40, 7)) / T(2));
  }
  return std::make_shared<List<T>>(std::move(x), std::move(v), std::move(m), circumference);
}

template <class Run, class T> void expect_same_state(const Run& a, const Run& b, const T& time) {
  EXPECT_TRUE(identical(configuration_at(a, time), configuration_at(b, time)));
  EXPECT_TRUE(same_collisions(a.counts(), b.counts()));
  EXPECT_EQ(a.counts().collisions, b.counts().collisions);
  EXPECT_EQ(a.counts().origin_moves, b.counts().origin_moves);
  EXPECT_EQ(a.energy_lost(), b.energy_lost());
  EXPECT_EQ(a.last_collision_time(), b.last_collision_time());
  EXPECT_EQ(a.account().simultaneous, b.account().simultaneous);
  EXPECT_EQ(a.account().order_lost, b.account().order_lost);
  EXPECT_EQ(a.account().first_order_lost.time, b.account().first_order_lost.time);
  EXPECT_EQ(a.collided_particles(), b.collided_particles());
}

// Advances a run in segments and a run in the plain loop through the same times.
template <class Chain, class T, class Law>
SlabsMade expect_same_in_segments(const Scene<T>& scene, const Law& law, const SegmentsAs& as,
                                  const std::vector<T>& times) {
  Simulation<T, Law, Chain> plain(law, Chain(scene, T(0))), segmented(law, Chain(scene, T(0)));
  Segments<Law, Chain> segments(threads(as.threads), as.how);
  for (const T& time : times) {
    const Status status = plain.advance(time);
    EXPECT_EQ(segmented.advance(time, segments), status);
    expect_same_state(plain, segmented, time);
    if (status != Status::reached) break;
  }
  return {segments.statistics().slabs, segments.statistics().given_up, segments.statistics().again};
}

}  // namespace cradle::test
