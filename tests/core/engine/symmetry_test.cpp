// Symmetries of the dynamics that the arithmetic of gaps and velocities keeps to the last bit. Proves: mirrored initial
// states give mirrored runs (with the wet law as long as no two particles of the same mass merge: the left one decides
// which of two slightly different velocities the cluster takes); a velocity added to all particles changes only
// positions; lengths, speeds and masses may be measured in other units (powers of two: exact). So nothing prefers a
// direction or a scale, except the documented tie rule (the leftmost of simultaneous collisions first), which these
// states do not use.
#include <gtest/gtest.h>

#include <algorithm>
#include <variant>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::symmetry_test {

using Values = std::vector<double>;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct State {
  Values x, v, m;
};
template <class Change> Values changed(Values values, Change change) {
  std::transform(values.begin(), values.end(), values.begin(), change);
  return values;
}
Values times(const Values& values, double factor) {
  return changed(values, [&](double value) { return factor * value; });
}
template <class Item> std::vector<Item> reversed(std::vector<Item> items) {
  std::reverse(items.begin(), items.end());
  return items;
}
State mirrored(const State& s) { return {times(reversed(s.x), -1), times(reversed(s.v), -1), reversed(s.m)}; }

// `mass` of a particle by its number.
template <class Mass> State state_of(const Scene<double>& particles, Mass mass) {
  State s;
  for (ParticleIndex b = 0; b < particles->count(); ++b) {
    s.x.push_back(particles->position(b));
    s.v.push_back(particles->velocity(b));
    s.m.push_back(mass(b));
  }
  return s;
}
double one(ParticleIndex) { return 1; }
double one_to_eight(ParticleIndex b) { return static_cast<double>(1 + bits_of(b, 40, 7)); }
// All different, as are their sums: multiples of 2^-20, so that all sums are exact.
double unlike(ParticleIndex b) { return 1 + static_cast<double>(bits_of(b, 40, 0xFFFFF)) * 0x1p-20; }
// The total of an even number of particles is a power of two if their number is one: the mean velocity is exact.
double one_or_three(ParticleIndex b) { return b % 2 == 0 ? 1 : 3; }

using Law = std::variant<Inelastic<double>, Wet<double>>;
struct Case {
  State state;
  Law law;
  double end;
  std::uint64_t least_collisions = 0, least_merges = 0;
};
bool wet(const Law& law) { return std::holds_alternative<Wet<double>>(law); }

struct Result {
  Configuration<double> c;
  Counts counts;
  double energy_lost;
};
Result run(const State& s, const Law& law, double end) {
  const auto finished = [&](auto run) -> Result {
    EXPECT_EQ(run.advance(end), Status::reached);
    EXPECT_EQ(run.account().simultaneous, 0U);
    return {run.configuration(end), run.counts(), run.energy_lost()};
  };
  const auto particles = list(s.x, s.v, s.m);
  if (wet(law)) return finished(Simulation(std::get<Wet<double>>(law), ClusterChain<double>(particles, 0.)));
  return finished(mass_run(particles, std::get<Inelastic<double>>(law)));
}
Result run(const Case& scene) {
  const Result result = run(scene.state, scene.law, scene.end);
  EXPECT_GE(result.counts.collisions, scene.least_collisions);
  EXPECT_GE(result.counts.merges, scene.least_merges);
  return result;
}

const std::vector<Case>& dry_cases() {
  static const std::vector<Case> cases{{state_of(rmix<double>(200), one), Inelastic(0.9375, 1e-6), 1000},
                                       {state_of(rshock<double>(300), one), Inelastic(0.98, 1e-5), 310},
                                       {state_of(rshock<double>(200), one), Inelastic(0.9, 1e-3), 90},
                                       {state_of(rshock<double>(200), one), Inelastic(0.3, 1e-3), 20},
                                       {state_of(rmix<double>(100), one_to_eight), Inelastic(0.9375, 1e-4), 30},
                                       {state_of(rshock<double>(200), one_to_eight), Inelastic(0.98, 1e-4), 60}};
  return cases;
}

// Losses add up in the order of collisions, which need not be that of the mirror where two commute: two sums exact to
// two roundings each; and a merger's is a product of four numbers, from the left: four roundings.
void expect_mirror(const Case& scene) {
  const Result original = run(scene), mirror = run(mirrored(scene.state), scene.law, scene.end);
  EXPECT_TRUE(same_collisions(original.counts, mirror.counts));
  EXPECT_EQ(reversed(mirror.c.gap), original.c.gap);
  EXPECT_EQ(reversed(mirror.c.closing_speed), original.c.closing_speed);
  EXPECT_EQ(reversed(mirror.c.m), original.c.m);
  EXPECT_NEAR(mirror.energy_lost, original.energy_lost, (wet(scene.law) ? 4 : 2) * epsilon * original.energy_lost);
  if (!wet(scene.law)) return;
  EXPECT_EQ(times(reversed(mirror.c.v), -1), original.c.v);
  std::vector<ParticleIndex> other_end = reversed(mirror.c.index);
  for (ParticleIndex& b : other_end) b = static_cast<ParticleIndex>(scene.state.x.size()) - 1 - b;
  EXPECT_EQ(other_end, original.c.index);
}

TEST(Symmetry, Mirror) {
  for (const Case& scene : dry_cases()) expect_mirror(scene);
}
TEST(WetSymmetry, Mirror) {
  const Case passes{state_of(rshock<double>(300), one), Wet(1e-4), 120, 301};
  EXPECT_EQ(run(passes).counts.merges, 0U);
  expect_mirror(passes);
  expect_mirror({state_of(rmix<double>(200), unlike), Wet(0.02), 200, 301, 101});
  expect_mirror({state_of(rshock<double>(200), unlike), Wet(0.05), 300, 301});
}

// Positions and velocities are put together from the left: they mirror to the closure error and its own rounding.
TEST(Symmetry, MirroredPositionsDifferByTheClosureErrorAtMost) {
  for (const Case& scene : dry_cases()) {
    const Result original = run(scene), mirror = run(mirrored(scene.state), scene.law, scene.end);
    const Configuration<double>& c = original.c;
    const double rounding = 8 * epsilon * (std::abs(c.x.front()) + std::abs(c.x.back()) + scene.end);
    EXPECT_LE(largest_difference(times(reversed(mirror.c.x), -1), c.x), std::abs(c.closure_gap.value()) + rounding);
    EXPECT_LE(largest_difference(times(reversed(mirror.c.v), -1), c.v),
              std::abs(c.closure_speed.value()) + 8 * epsilon);
  }
}

// Velocities are multiples of 2^-13, and the total mass of particles that merge is a power of two: adding 1000.25 to
// them, and so to their mean, is exact, and so are their differences.
void expect_same_in_a_moving_frame(const Case& scene) {
  State moving = scene.state;
  moving.v = changed(moving.v, [](double v) { return v + 1000.25; });
  const Result original = run(scene), moved = run(moving, scene.law, scene.end);
  EXPECT_TRUE(identical(original.counts, moved.counts));
  EXPECT_EQ(moved.c.gap, original.c.gap);
  EXPECT_EQ(moved.c.closing_speed, original.c.closing_speed);
  EXPECT_EQ(moved.energy_lost, original.energy_lost);
  if (!wet(scene.law)) return;
  EXPECT_EQ(moved.c.m, original.c.m);
  EXPECT_EQ(moved.c.index, original.c.index);
  // Positions are given in the requested frame: here rounded at 1000.25 times the time.
  const double shift = 1000.25 * scene.end;
  for (std::size_t j = 0; j < original.c.x.size(); ++j)
    ASSERT_NEAR(moved.c.x[j] - shift, original.c.x[j], 4 * epsilon * shift);
}

TEST(Symmetry, GalileanFrame) {
  for (const Case& scene : dry_cases()) expect_same_in_a_moving_frame(scene);
}
TEST(WetSymmetry, GalileanFrame) {
  expect_same_in_a_moving_frame({state_of(rmix<double>(256), one), Wet(0.01), 300, 0, 101});
  expect_same_in_a_moving_frame({state_of(rshock<double>(256), one), Wet(0.01), 300, 0, 101});
  expect_same_in_a_moving_frame({state_of(rmix<double>(256), one_or_three), Wet(0.05), 300, 0, 101});
}

void expect_same_in_other_units(const Case& scene, const Law& law) {
  const State scaled{times(scene.state.x, 1024), times(scene.state.v, 1. / 64), times(scene.state.m, 8)};
  const Result original = run(scene), other = run(scaled, law, scene.end * 1024 * 64);
  EXPECT_TRUE(identical(original.counts, other.counts));
  EXPECT_EQ(times(other.c.gap, 1. / 1024), original.c.gap);
  EXPECT_EQ(times(other.c.closing_speed, 64), original.c.closing_speed);
  EXPECT_EQ(times(other.c.x, 1. / 1024), original.c.x);
  EXPECT_EQ(other.energy_lost / 8 * 64 * 64, original.energy_lost);
}

TEST(Symmetry, Units) {
  for (const Case& scene : dry_cases()) {
    const auto& law = std::get<Inelastic<double>>(scene.law);
    expect_same_in_other_units(scene, Inelastic<double>(law.restitution(), law.cutoff() / 64));
  }
}
TEST(WetSymmetry, Units) {
  expect_same_in_other_units({state_of(rmix<double>(200), unlike), Wet(0.02), 200, 0, 101}, Wet(0.02 * 8 / 64 / 64));
  expect_same_in_other_units({state_of(rshock<double>(200), one), Wet(0.01), 200, 0, 101}, Wet(0.01 * 8 / 64 / 64));
}

}  // namespace cradle::test::symmetry_test
