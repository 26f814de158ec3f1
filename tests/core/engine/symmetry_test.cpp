// Symmetries of the dynamics that the arithmetic of gaps and velocities keeps to the last bit. Proves: mirrored initial
// states give mirrored runs (with the wet law as long as no two particles of the same mass merge: the left one decides
// which of two slightly different velocities the cluster takes); a velocity added to all particles changes only
// positions; lengths, speeds and masses may be measured in other units (powers of two: exact). So nothing prefers a
// direction or a scale, except the documented tie rule (the leftmost of simultaneous collisions first), which these
// states do not use.
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::symmetry_test {

using Values = std::vector<double>;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

Values times(Values values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}
template <class Item> std::vector<Item> reversed(std::vector<Item> items) {
  std::reverse(items.begin(), items.end());
  return items;
}

// Masses of a particle by its number.
double one_to_eight(ParticleIndex b) { return static_cast<double>(1 + bits_of(b, 40, 7)); }
// All different, as are their sums: multiples of 2^-20, so that all sums are exact.
double unlike(ParticleIndex b) { return 1 + static_cast<double>(bits_of(b, 40, 0xFFFFF)) * 0x1p-20; }
// The total of an even number of particles is a power of two if their number is one: the mean velocity is exact.
double one_or_three(ParticleIndex b) { return b % 2 == 0 ? 1 : 3; }

template <class Law> struct Case {
  Scene<double> particles;
  Law law;
  double end;
  std::uint64_t least_collisions = 0, least_merges = 0;
};
using Dry = Inelastic<double>;

struct Result {
  Configuration<double> c;
  Counts counts;
  double energy_lost;
};
template <class Law> Result run(const Scene<double>& particles, const Law& law, double end) {
  const auto finished = [&](auto run) -> Result {
    EXPECT_EQ(run.advance(end), Status::reached);
    EXPECT_EQ(run.account().simultaneous, 0U);
    return {run.configuration(end), run.counts(), run.energy_lost()};
  };
  if constexpr (Law::bounces_only)
    return finished(mass_run(particles, law));
  else
    return finished(Simulation(law, ClusterChain<double>(particles, 0.)));
}
template <class Law> Result run(const Case<Law>& scene) {
  const Result result = run(scene.particles, scene.law, scene.end);
  EXPECT_GE(result.counts.collisions, scene.least_collisions);
  EXPECT_GE(result.counts.merges, scene.least_merges);
  return result;
}

const std::vector<Case<Dry>>& dry_cases() {
  static const std::vector<Case<Dry>> cases{{rmix<double>(200), Dry(0.9375, 1e-6), 1000},
                                            {rshock<double>(300), Dry(0.98, 1e-5), 310},
                                            {rshock<double>(200), Dry(0.9, 1e-3), 90},
                                            {rshock<double>(200), Dry(0.3, 1e-3), 20},
                                            {as_list(*rmix<double>(100), one_to_eight), Dry(0.9375, 1e-4), 30},
                                            {as_list(*rshock<double>(200), one_to_eight), Dry(0.98, 1e-4), 60}};
  return cases;
}

// Losses add up in the order of collisions, which need not be that of the mirror where two commute: two sums exact to
// two roundings each; and a merger's is a product of four numbers, from the left: four roundings.
template <class Law> void expect_mirror(const Case<Law>& scene) {
  const Result original = run(scene), mirrored = run(seen_in(*scene.particles, mirror_frame), scene.law, scene.end);
  EXPECT_TRUE(same_collisions(original.counts, mirrored.counts));
  EXPECT_EQ(reversed(mirrored.c.gap), original.c.gap);
  EXPECT_EQ(reversed(mirrored.c.closing_speed), original.c.closing_speed);
  EXPECT_EQ(reversed(mirrored.c.m), original.c.m);
  EXPECT_NEAR(mirrored.energy_lost, original.energy_lost, (Law::bounces_only ? 2 : 4) * epsilon * original.energy_lost);
  if (Law::bounces_only) {
    // Places and velocities are put together from the left: they mirror to the closure error and its own rounding.
    const Configuration<double>& c = original.c;
    const double rounding = 8 * epsilon * (std::abs(c.x.front()) + std::abs(c.x.back()) + scene.end);
    EXPECT_LE(largest_difference(times(reversed(mirrored.c.x), -1), c.x), std::abs(*c.closure_gap) + rounding);
    EXPECT_LE(largest_difference(times(reversed(mirrored.c.v), -1), c.v), std::abs(*c.closure_speed) + 8 * epsilon);
    return;
  }
  EXPECT_EQ(times(reversed(mirrored.c.v), -1), original.c.v);
  std::vector<ParticleIndex> other_end = reversed(mirrored.c.index);
  for (ParticleIndex& b : other_end) b = scene.particles->count() - 1 - b;
  EXPECT_EQ(other_end, original.c.index);
}

TEST(Symmetry, Mirror) {
  for (const auto& scene : dry_cases()) expect_mirror(scene);
}
TEST(WetSymmetry, Mirror) {
  const Case<Wet<double>> passes{rshock<double>(300), Wet(1e-4), 120, 301};
  EXPECT_EQ(run(passes).counts.merges, 0U);
  expect_mirror(passes);
  expect_mirror<Wet<double>>({as_list(*rmix<double>(200), unlike), Wet(0.02), 200, 301, 101});
  expect_mirror<Wet<double>>({as_list(*rshock<double>(200), unlike), Wet(0.05), 300, 301});
}

// Velocities are multiples of 2^-13, and the total mass of particles that merge is a power of two: what they are less
// their mean is exact. At 2^60 all velocities are equal, and only their differences are known.
template <class Law> void expect_same_in_a_moving_frame(const Case<Law>& scene, double drift) {
  const Result original = run(scene), moved = run(seen_in(*scene.particles, {.drift = drift}), scene.law, scene.end);
  EXPECT_TRUE(identical(original.counts, moved.counts));
  EXPECT_EQ(moved.c.gap, original.c.gap);
  EXPECT_EQ(moved.c.closing_speed, original.c.closing_speed);
  EXPECT_EQ(moved.energy_lost, original.energy_lost);
  if (Law::bounces_only) return;
  EXPECT_EQ(moved.c.m, original.c.m);
  EXPECT_EQ(moved.c.index, original.c.index);
  // Positions are given in the requested frame: rounded at the way gone together.
  const double shift = drift * scene.end;
  for (std::size_t j = 0; j < original.c.x.size(); ++j)
    ASSERT_NEAR(moved.c.x[j] - shift, original.c.x[j], 4 * epsilon * shift);
}

TEST(Symmetry, GalileanFrame) {
  for (const double drift : {1000.25, 0x1p60})
    for (const auto& scene : dry_cases()) expect_same_in_a_moving_frame(scene, drift);
}
TEST(WetSymmetry, GalileanFrame) {
  for (const auto& [particles, loss] : {std::pair(rmix<double>(256), 0.01),
                                        {rshock<double>(256), 0.01},
                                        {as_list(*rmix<double>(256), one_or_three), 0.05}})
    for (const double drift : {1000.25, 0x1p60})
      expect_same_in_a_moving_frame<Wet<double>>({particles, Wet(loss), 300, 0, 101}, drift);
}
TEST(StickyGas, GalileanFrame) {
  const Scene<double> particles = rmix<double>(256);
  StickyGas<double> original(particles, 0.), moved(seen_in(*particles, {.drift = 0x1p60}), 0.);
  original.advance(300), moved.advance(300);
  EXPECT_EQ(moved.counts().merges, original.counts().merges);
  const auto of_moved = moved.configuration(300), of_original = original.configuration(300);
  EXPECT_EQ(of_moved.m, of_original.m);
  EXPECT_LE(largest_difference(of_moved.gap, of_original.gap), 1e-12);
  EXPECT_LE(largest_difference(of_moved.closing_speed, of_original.closing_speed), 1e-15);
  EXPECT_NEAR(moved.energy_lost(), original.energy_lost(), 4 * epsilon * original.energy_lost());
}

template <class Law> void expect_same_in_other_units(const Case<Law>& scene, const Law& law) {
  const Scene<double> scaled = seen_in(*scene.particles, {.length = 1024, .speed = 1. / 64, .mass = 8});
  const Result original = run(scene), other = run(scaled, law, scene.end * 1024 * 64);
  EXPECT_TRUE(identical(original.counts, other.counts));
  EXPECT_EQ(times(other.c.gap, 1. / 1024), original.c.gap);
  EXPECT_EQ(times(other.c.closing_speed, 64), original.c.closing_speed);
  EXPECT_EQ(times(other.c.x, 1. / 1024), original.c.x);
  EXPECT_EQ(other.energy_lost / 8 * 64 * 64, original.energy_lost);
}

TEST(Symmetry, Units) {
  for (const auto& scene : dry_cases())
    expect_same_in_other_units(scene, Dry(scene.law.restitution(), scene.law.cutoff() / 64));
}
TEST(WetSymmetry, Units) {
  for (const auto& [particles, loss] :
       {std::pair(as_list(*rmix<double>(200), unlike), 0.02), {rshock<double>(200), 0.01}})
    expect_same_in_other_units<Wet<double>>({particles, Wet(loss), 200, 0, 101}, Wet(loss * 8 / 64 / 64));
}

}  // namespace cradle::test::symmetry_test
