// The front of the inelastic shock in a run, against the tracer's recursion, which is exact until the turnover: two
// rows on a lattice at plus and minus u0 = 1/2, the outermost particle that has collided is at
//
//   u_{n+1} = u_n (1+eps)/2 - u0 (1-eps)/2,   x_{n+1} = x_n + u_n dt_n,   dt_n = l/(u_n + u0),   x_0 = -l/2
//
// after n collisions ("Dry and wet granular shock waves", section IV). Proves: both fronts follow it at every collision
// and between them, up to the turnover. (That it reaches farthest there, to the tabulated digits:
// core/theory/inelastic_shock_test.cpp; an independent N-particle tracer agrees to 2e-29.)
//
// Tolerance. The closing speed at the front is multiplied by (1+eps)/2 once a collision: two roundings, so after n
// collisions it is off by 2 n 2^-53 of itself at most, as are all flights so far, which add up to t; places and times
// are rounded once more a collision: 3 n t 2^-53.
#include <gtest/gtest.h>

#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::front_test {

using Wide = Digits<50>;

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

struct Front {
  double restitution, turnover;
  std::uint64_t collisions;  // of the tracer until then
  ParticleIndex particles;

  friend void PrintTo(const Front& r, std::ostream* out) { *out << "eps=" << r.restitution; }
};

class Fronts : public testing::TestWithParam<Front> {
 protected:
  Scene<double> lattice() const { return lattice_rows(GetParam().particles); }
  Inelastic<double> law() const { return Inelastic(GetParam().restitution); }
  // The recursion for the very restitution that the run has, not the decimal it stands for.
  theory::InelasticShock<Wide> shock() const { return {Wide(GetParam().restitution)}; }
  static double tolerance(std::uint64_t n, double t) { return 3 * static_cast<double>(n + 1) * (t + 1) * u; }
};
INSTANTIATE_TEST_SUITE_P(Restitutions, Fronts,
                         testing::Values(Front{.999, 1999.10445795704663, 1386, 5000},
                                         Front{.99, 200.433837489132534, 139, 500}));

template <class Run> void expect_front(const Run& run, double t, const Wide& exact, double tolerance) {
  const double local = run.chain().local_time(t);
  ASSERT_NEAR(run.chain().front_right(local), static_cast<double>(exact), tolerance) << "t = " << t;
  ASSERT_NEAR(run.chain().front_left(local), static_cast<double>(-exact), tolerance) << "t = " << t;
}

TEST_P(Fronts, FollowTheRecursionFromCollisionToCollision) {
  auto run = gap_run(lattice(), law());
  for (std::uint64_t n = 1; n <= GetParam().collisions; ++n) {
    const auto collision = theory::front_collision(shock(), n);
    const auto t = static_cast<double>(collision.time);
    // At a third of the way to the next collision all of this one are made.
    const double third = t + static_cast<double>(1 / (collision.velocity + Wide(0.5))) / 3;
    ASSERT_EQ(run.advance(third), Status::reached);
    ASSERT_EQ(run.chain().collided_particles(), static_cast<ParticleIndex>(2 * n));
    expect_front(run, third, collision.position + collision.velocity * (Wide(third) - collision.time),
                 tolerance(n, third));
  }
  EXPECT_EQ(run.chain().account().order_lost, 0U);
  EXPECT_EQ(run.chain().account().simultaneous, 0U) << "triple collisions, decided by the tie rule";
}

// At `outputs` times up to the turnover.
template <class Run, class Tolerance>
void expect_front_at_times(Run run, const theory::InelasticShock<Wide>& shock, double end, int outputs,
                           const Tolerance& tolerance) {
  for (int k = 1; k <= outputs; ++k) {
    const double t = std::max(1.001, end * k / outputs);
    ASSERT_EQ(run.advance(t), Status::reached);
    const auto n = theory::front_collision_before(shock, Wide(t)).collision;
    expect_front(run, t, theory::front_position_discrete(shock, Wide(t)), tolerance(n, t));
  }
}

TEST_P(Fronts, AreContinuousInTime) {
  expect_front_at_times(gap_run(lattice(), law()), shock(), GetParam().turnover, 997, tolerance);
}

// Positions and velocities are rounded twice as often.
TEST_P(Fronts, FollowTheRecursionInAbsolutePositions) {
  expect_front_at_times(position_run(lattice(), law()), shock(), GetParam().turnover, 20,
                        [](std::uint64_t n, double t) { return 2 * tolerance(n, t); });
}

// Rows of particles displaced at random: the front still is within a spacing of the lattice's, as long as particles
// come at a steady rate; displacements do not add up.
TEST_P(Fronts, OfPerturbedRowsStayWithinASpacing) {
  expect_front_at_times(gap_run(uniform_rows(GetParam().particles, 0.05, 1), law()), shock(), GetParam().turnover, 10,
                        [](std::uint64_t, double) { return 1; });
}

}  // namespace cradle::test::front_test
