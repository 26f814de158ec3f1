#pragma once
// Compares runs in segments with the plain loop, bit for bit: state, counts, energy, account, at several times; and, of
// runs with an observer, every collision.

#include "cradle/core/ensemble/executor.hpp"
#include "cradle/core/initial/walled.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
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

// What runs in segments have made, all of those that are compared.
struct SlabsMade {
  std::uint64_t slabs = 0, given_up = 0, again = 0, collisions = 0, in_steps = 0;
  template <class Other> SlabsMade& operator+=(const Other& other) {
    slabs += other.slabs, given_up += other.given_up, again += other.again;
    collisions += other.collisions, in_steps += other.in_steps;
    return *this;
  }
};

// The mixture of fixtures.hpp, on a line or, with a circumference, on a ring; masses from 1 to 4.5.
template <class T> Scene<T> gas(ParticleIndex n, const T& circumference = T(0), bool unequal = false) {
  const auto mass = [=](ParticleIndex b) { return unequal ? T(T(1) + T(bits_of(b, 40, 7)) / T(2)) : T(1); };
  return as_list(*rmix<T>(n), mass, circumference);
}

// Lines at whose ends gaps are curves in time: a column on a floor that is at rest, on one that saws and on one that
// moves like a sine under a hot ceiling; and a gas between shaken walls.
template <class T> std::vector<Scene<T>> lines_at_curved_walls(ParticleIndex n, bool unequal = false) {
  const auto shaken = [](const Wall<T>& at, Shape shape, int amplitude, int frequency) {
    Wall<T> wall = at;
    wall.motion = std::make_shared<WallMotion<T>>(shape, T(amplitude) / T(16), T(frequency), T(1));
    return wall;
  };
  const Wall<T> left{.position = T(-1)}, right{.position = T(n + 1)};
  const Wall<T> hot{.position = right.position, .temperature = 0.3, .seed = 5, .replica = 2};
  const T falls = T(-2) / T(n);
  const Scene<T> line = gas<T>(n, T(0), unequal);
  return {std::make_shared<Walled<T>>(line, left, std::nullopt, falls),
          std::make_shared<Walled<T>>(line, shaken(left, Shape::sawtooth, 1, 40), std::nullopt, falls),
          std::make_shared<Walled<T>>(line, shaken(left, Shape::sine, 8, 1), hot, falls),
          std::make_shared<Walled<T>>(line, shaken(left, Shape::sine, 4, 2), shaken(right, Shape::parabola, 8, 1))};
}

// A cool wall on the right, and on the left a heated one or, of unequal particles, one that moves.
template <class T> Scene<T> gas_between_walls(bool unequal = false) {
  const Wall<T> hot{.position = T(-1), .temperature = 0.4, .seed = 5, .replica = 2};
  const Wall<T> moving{.position = T(-1), .speed = T(1) / T(10), .restitution = T(9) / T(10)};
  const Wall<T> cool{.position = T(801), .temperature = 0.1, .seed = 5, .replica = 2};
  return std::make_shared<Walled<T>>(gas<T>(800, T(0), unequal), unequal ? moving : hot, cool);
}

// Elastic particles, nearly elastic ones, some with a cut-off, soft ones.
template <class T> std::vector<Inelastic<T>> laws() {
  const auto law = [](int restitution, int cutoff) {
    return Inelastic<T>(T(restitution) / T(1000), cutoff > 0 ? T(1) / T(cutoff) : T(0));
  };
  return {law(1000, 0), law(999, 100000), law(900, 8), law(300, 2)};
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

// Of particles that may merge: every number of every cell but the gap behind the last one of a line, which is none.
template <class T> void expect_same_bits(const ClusterChain<T>& a, const ClusterChain<T>& b) {
  const auto &left = a.line().gaps, &right = b.line().gaps;
  for (Slot s = a.first(), r = b.first();; s = a.right(s), r = b.right(r)) {
    const auto& [one, other] = std::pair(left[s], right[r]);
    ASSERT_EQ(one.particle, other.particle);
    ASSERT_TRUE(one.velocity == other.velocity && one.mass == other.mass) << one.particle;
    ASSERT_EQ(s == a.last(), r == b.last());
    if (s == a.last() && !a.on_ring()) break;
    ASSERT_TRUE(one.gap == other.gap && one.time == other.time && left.lag(s) == right.lag(r)) << one.particle;
    ASSERT_EQ(a.due(s), b.due(r)) << one.particle;
    if (s == a.last()) break;
  }
}

// Advances a run in the plain loop and, for each way to go in segments, a run and the same with an observer, through
// the same times. `every_bit`: what chains hold is compared, too.
template <class Chain, bool every_bit = false, class T = typename Chain::Scalar, class Law>
SlabsMade expect_same_in_segments(const Scene<std::type_identity_t<T>>& scene, const Law& law,
                                  const std::vector<SegmentsAs>& ways,
                                  const std::vector<std::type_identity_t<T>>& times) {
  using Run = Simulation<T, Law, Chain>;
  struct InSegments {
    Run run;
    Segments<Law, Chain> segments;
    Observed<T> seen;
  };
  const auto started = [&] { return Run(law, Chain(scene, T(0))); };
  const auto expect_same = [](const Run& a, const Run& b, const T& time) {
    expect_same_state(a, b, time);
    if constexpr (every_bit) expect_same_bits(a.chain(), b.chain());
  };
  Run plain = started();
  Observed<T> in_plain;
  std::vector<InSegments> alone, observed;
  for (const SegmentsAs& as : ways)
    for (auto* runs : {&alone, &observed})
      runs->push_back({started(), Segments<Law, Chain>(threads(as.threads), as.how), {}});
  for (const T& time : times) {
    const Status status = plain.advance(time, in_plain.by(plain));
    EXPECT_EQ(in_plain.collisions(), plain.counts().collisions);
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const Segmentation& how = ways[k].how;
      SCOPED_TRACE(::testing::Message() << (how.steps ? how.steps->target : "no steps") << ", " << how.gaps << " gaps, "
                                        << how.ghosts << " ghosts, " << ways[k].threads << " threads, until "
                                        << to_double(time));
      auto& [run, segments, nothing] = alone[k];
      EXPECT_EQ(run.advance(time, segments), status);
      expect_same(plain, run, time);
      if (ways[k].observed) {
        auto& [watched, in_slabs, seen] = observed[k];
        EXPECT_EQ(watched.advance(time, in_slabs, seen.by(watched)), status);
        expect_same(plain, watched, time);
        EXPECT_TRUE(seen == in_plain) << "other collisions, or in another order";
      }
      if (::testing::Test::HasFailure()) return {};
    }
    if (status != Status::reached) break;
  }
  SlabsMade made;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const auto &by_itself = alone[k].segments.statistics(), &watched = observed[k].segments.statistics();
    made += by_itself;
    if (!ways[k].observed) continue;
    // Time slabs that are observed end elsewhere, and steps may give up one where the other run has none to give up.
    // Pairs make none of them in steps.
    if (watched.in_steps > 0) made += watched;
    if (ways[k].how.steps == nullptr) {
      EXPECT_EQ(watched.given_up > 0, by_itself.given_up > 0);
    }
  }
  return made;
}

}  // namespace cradle::test
