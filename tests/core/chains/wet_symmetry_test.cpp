// Symmetries of the wet law that the arithmetic of gaps and velocities keeps to the last bit. Proves: mirrored initial
// states give mirrored runs, as long as no two particles of the same mass merge (which of two velocities that differ by
// rounding a cluster of equal halves takes is decided from the left); a velocity added to all particles changes nothing
// but where they are; lengths, speeds and masses may be measured in other units (powers of two: exact).
#include <gtest/gtest.h>

#include <algorithm>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace wet_symmetry_test {

using namespace cradle;
using namespace cradle::test;

using Values = std::vector<double>;

struct State {
  Values x, v, m;
};

template <class Change> Values changed(Values values, Change change) {
  std::transform(values.begin(), values.end(), values.begin(), change);
  return values;
}
Values reversed(Values values) {
  std::reverse(values.begin(), values.end());
  return values;
}
State mirrored(const State& s) {
  const auto negate = [](double a) { return -a; };
  return {changed(reversed(s.x), negate), changed(reversed(s.v), negate), reversed(s.m)};
}

// `mass` of a particle by its number.
template <class Mass> State state_of(const Particles<double>& particles, Mass mass) {
  State s;
  for (ParticleIndex b = 0; b < particles.count(); ++b) {
    s.x.push_back(particles.position(b));
    s.v.push_back(particles.velocity(b));
    s.m.push_back(mass(b));
  }
  return s;
}
double one(ParticleIndex) { return 1; }
// All different, as are their sums: multiples of 2^-20, so that all sums are exact.
double unlike(ParticleIndex b) { return 1 + static_cast<double>(bits_of(b, 40, 0xFFFFF)) * 0x1p-20; }
// Of an even number of particles in all a power of two, if that is one: the mean velocity is exact.
double one_or_three(ParticleIndex b) { return b % 2 == 0 ? 1 : 3; }

struct Result {
  Configuration<double> c;
  Counts counts;
  double energy_lost;
};
Result run(const State& s, double loss, double end) {
  Simulation run(Wet<double>(loss), ClusterChain<double>(list(s.x, s.v, s.m), 0.));
  EXPECT_EQ(run.advance(end), Status::reached);
  EXPECT_EQ(run.account().simultaneous, 0U);
  return {run.configuration(end), run.counts(), run.energy_lost()};
}

struct Case {
  State state;
  double loss, end;
};

TEST(WetSymmetry, Mirror) {
  const Case passes{state_of(*rshock<double>(300), one), 1e-4, 120};
  EXPECT_EQ(run(passes.state, passes.loss, passes.end).counts.merges, 0U);
  const Case merges{state_of(*rmix<double>(200), unlike), 0.02, 200},
      sticks{state_of(*rshock<double>(200), unlike), 0.05, 300};
  EXPECT_GT(run(merges.state, merges.loss, merges.end).counts.merges, 100U);
  for (const Case& scene : {passes, merges, sticks}) {
    const Result original = run(scene.state, scene.loss, scene.end);
    const Result mirror = run(mirrored(scene.state), scene.loss, scene.end);
    EXPECT_GT(original.counts.collisions, 300U);
    EXPECT_TRUE(same_collisions(original.counts, mirror.counts));
    EXPECT_EQ(reversed(mirror.c.gap), original.c.gap);
    EXPECT_EQ(reversed(mirror.c.closing_speed), original.c.closing_speed);
    EXPECT_EQ(changed(reversed(mirror.c.v), [](double v) { return -v; }), original.c.v);
    EXPECT_EQ(reversed(mirror.c.m), original.c.m);
    std::vector<ParticleIndex> other_end;
    for (const ParticleIndex b : mirror.c.index)
      other_end.push_back(static_cast<ParticleIndex>(scene.state.x.size()) - 1 - b);
    std::reverse(other_end.begin(), other_end.end());
    EXPECT_EQ(other_end, original.c.index);
    // Losses add up in the order of collisions, which need not be that of the mirror where two commute, and a merger's
    // is a product of four numbers, from the left: four roundings.
    EXPECT_NEAR(mirror.energy_lost, original.energy_lost,
                4 * std::numeric_limits<double>::epsilon() * original.energy_lost);
  }
}

// Velocities are multiples of 2^-13, and the total mass is a power of two: adding 1000.25 to them, and so to their
// mean, is exact.
TEST(WetSymmetry, GalileanFrame) {
  for (const Case& scene :
       {Case{state_of(*rmix<double>(256), one), 0.01, 300}, Case{state_of(*rshock<double>(256), one), 0.01, 300},
        Case{state_of(*rmix<double>(256), one_or_three), 0.05, 300}}) {
    State moving = scene.state;
    moving.v = changed(moving.v, [](double v) { return v + 1000.25; });
    const Result original = run(scene.state, scene.loss, scene.end), moved = run(moving, scene.loss, scene.end);
    EXPECT_GT(original.counts.merges, 100U);
    EXPECT_TRUE(identical(original.counts, moved.counts));
    EXPECT_EQ(moved.c.gap, original.c.gap);
    EXPECT_EQ(moved.c.closing_speed, original.c.closing_speed);
    EXPECT_EQ(moved.c.m, original.c.m);
    EXPECT_EQ(moved.c.index, original.c.index);
    EXPECT_EQ(moved.energy_lost, original.energy_lost);
    // Positions are given in the requested frame: here rounded at 1000.25 times the time.
    for (std::size_t j = 0; j < original.c.x.size(); ++j)
      ASSERT_NEAR(moved.c.x[j] - 1000.25 * scene.end, original.c.x[j],
                  4 * std::numeric_limits<double>::epsilon() * 1000.25 * scene.end);
  }
}

TEST(WetSymmetry, Units) {
  for (const Case& scene :
       {Case{state_of(*rmix<double>(200), unlike), 0.02, 200}, Case{state_of(*rshock<double>(200), one), 0.01, 200}}) {
    State scaled = scene.state;
    scaled.x = changed(scaled.x, [](double x) { return 1024 * x; });
    scaled.v = changed(scaled.v, [](double v) { return v / 64; });
    scaled.m = changed(scaled.m, [](double m) { return 8 * m; });
    const Result original = run(scene.state, scene.loss, scene.end);
    const Result other = run(scaled, scene.loss * 8 / 64 / 64, scene.end * 1024 * 64);
    EXPECT_GT(original.counts.merges, 100U);
    EXPECT_TRUE(identical(original.counts, other.counts));
    EXPECT_EQ(changed(other.c.gap, [](double g) { return g / 1024; }), original.c.gap);
    EXPECT_EQ(changed(other.c.closing_speed, [](double w) { return w * 64; }), original.c.closing_speed);
    EXPECT_EQ(changed(other.c.x, [](double x) { return x / 1024; }), original.c.x);
    EXPECT_EQ(other.energy_lost / 8 * 64 * 64, original.energy_lost);
  }
}

}  // namespace wet_symmetry_test
