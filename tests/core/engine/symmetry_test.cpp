// Symmetries of the dynamics that the arithmetic of gaps and closing speeds keeps to the last bit. Proves: mirrored
// initial states give mirrored runs; a velocity added to all particles changes no gap and no closing speed; lengths,
// speeds and masses may be measured in other units (powers of two: exact); and that nothing prefers a direction or a
// scale, except the documented tie rule (the leftmost of simultaneous collisions first), which these states do not
// meet.
#include <gtest/gtest.h>

#include <algorithm>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace symmetry_test {

using namespace cradle;
using namespace cradle::test;

using Values = std::vector<double>;

struct State {
  Values x, v, m;
  Scene<double> scene() const { return list(x, v, m); }
};

template <class Change> Values changed(Values values, Change change) {
  std::transform(values.begin(), values.end(), values.begin(), change);
  return values;
}
Values reversed(Values values) {
  std::reverse(values.begin(), values.end());
  return values;
}

State state_of(const Particles<double>& particles) {
  State s;
  for (ParticleIndex b = 0; b < particles.count(); ++b) {
    s.x.push_back(particles.position(b));
    s.v.push_back(particles.velocity(b));
    s.m.push_back(particles.mass(b));
  }
  return s;
}
State with_masses(State s) {
  for (std::size_t b = 0; b < s.m.size(); ++b)
    s.m[b] = static_cast<double>(1 + bits_of(static_cast<ParticleIndex>(b), 40, 7));
  return s;
}
State mirrored(const State& s) {
  const auto negate = [](double a) { return -a; };
  return {changed(reversed(s.x), negate), changed(reversed(s.v), negate), reversed(s.m)};
}

struct Case {
  State state;
  Inelastic<double> law;
  double end;
};
std::vector<Case> cases() {
  return {{state_of(*rmix<double>(200)), Inelastic(0.9375, 1e-6), 1000},
          {state_of(*rshock<double>(300)), Inelastic(0.98, 1e-5), 310},
          {state_of(*rshock<double>(200)), Inelastic(0.9, 1e-3), 90},
          {state_of(*rshock<double>(200)), Inelastic(0.3, 1e-3), 20},
          {with_masses(state_of(*rmix<double>(100))), Inelastic(0.9375, 1e-4), 30},
          {with_masses(state_of(*rshock<double>(200))), Inelastic(0.98, 1e-4), 60}};
}

struct Result {
  Configuration<double> c;
  Counts counts;
  double energy_lost;
};
Result run(const State& state, const Inelastic<double>& law, double end) {
  auto run = mass_run(state.scene(), law);
  EXPECT_EQ(run.advance(end), Status::reached);
  EXPECT_EQ(run.chain().account().simultaneous, 0U);
  return {configuration_at(run, end), run.counts(), run.energy_lost()};
}

TEST(Symmetry, Mirror) {
  for (const Case& scene : cases()) {
    const Result original = run(scene.state, scene.law, scene.end);
    const Result mirror = run(mirrored(scene.state), scene.law, scene.end);
    EXPECT_TRUE(same_collisions(original.counts, mirror.counts));
    EXPECT_EQ(reversed(mirror.c.gap), original.c.gap);
    EXPECT_EQ(reversed(mirror.c.closing_speed), original.c.closing_speed);
    EXPECT_EQ(reversed(mirror.c.m), original.c.m);
    // Losses add up in the order of collisions, which need not be that of the mirror where two commute: two sums exact
    // to two roundings each.
    EXPECT_NEAR(mirror.energy_lost, original.energy_lost,
                2 * std::numeric_limits<double>::epsilon() * original.energy_lost);
  }
}

// Positions and velocities are put together from the left: they mirror to the closure error and its own rounding.
TEST(Symmetry, MirroredPositionsDifferByTheClosureErrorAtMost) {
  for (const Case& scene : cases()) {
    const Result original = run(scene.state, scene.law, scene.end);
    const Result mirror = run(mirrored(scene.state), scene.law, scene.end);
    const double rounding = 8 * std::numeric_limits<double>::epsilon() *
                            (std::abs(original.c.x.front()) + std::abs(original.c.x.back()) + scene.end);
    const std::size_t n = original.c.x.size();
    for (std::size_t j = 0; j < n; ++j) {
      ASSERT_NEAR(-mirror.c.x[n - 1 - j], original.c.x[j], std::abs(original.c.closure_gap.value()) + rounding) << j;
      ASSERT_NEAR(-mirror.c.v[n - 1 - j], original.c.v[j],
                  std::abs(original.c.closure_speed.value()) + 8 * std::numeric_limits<double>::epsilon())
          << j;
    }
  }
}

TEST(Symmetry, GalileanFrame) {
  // Velocities are multiples of 2^-13: adding 1000.25 is exact, and so are their differences.
  for (const Case& scene : cases()) {
    State moving = scene.state;
    moving.v = changed(moving.v, [](double v) { return v + 1000.25; });
    const Result original = run(scene.state, scene.law, scene.end);
    const Result moved = run(moving, scene.law, scene.end);
    EXPECT_TRUE(identical(original.counts, moved.counts));
    EXPECT_EQ(moved.c.gap, original.c.gap);
    EXPECT_EQ(moved.c.closing_speed, original.c.closing_speed);
    EXPECT_EQ(moved.energy_lost, original.energy_lost);
  }
}

TEST(Symmetry, Units) {
  for (const Case& scene : cases()) {
    State scaled = scene.state;
    scaled.x = changed(scaled.x, [](double x) { return 1024 * x; });
    scaled.v = changed(scaled.v, [](double v) { return v / 64; });
    scaled.m = changed(scaled.m, [](double m) { return 8 * m; });
    const Inelastic<double> law(scene.law.restitution(), scene.law.cutoff() / 64);
    const Result original = run(scene.state, scene.law, scene.end);
    const Result other = run(scaled, law, scene.end * 1024 * 64);
    EXPECT_TRUE(identical(original.counts, other.counts));
    EXPECT_EQ(changed(other.c.gap, [](double g) { return g / 1024; }), original.c.gap);
    EXPECT_EQ(changed(other.c.closing_speed, [](double w) { return w * 64; }), original.c.closing_speed);
    EXPECT_EQ(changed(other.c.x, [](double x) { return x / 1024; }), original.c.x);
    EXPECT_EQ(other.energy_lost / 8 * 64 * 64, original.energy_lost);
  }
}

}  // namespace symmetry_test
