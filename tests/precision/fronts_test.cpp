// The fronts of the inelastic and of the wet shock in runs, in every scalar type to its full precision, against the
// tracer's recursion, which is exact until the turnover: two rows on a lattice at plus and minus u0 = 1/2, the
// outermost particle that has collided is at
//
//   x_{n+1} = x_n + u_n dt_n,   dt_n = l/(u_n + u0),   x_0 = -l/2
//   inelastic   u_{n+1} = u_n (1+eps)/2 - u0 (1-eps)/2
//   wet         r_{n+1} = r_n/2 + sqrt(r_n^2/4 - e),   r = u + u0
//
// after n collisions ("Dry and wet granular shock waves", sections IV and V). Proves: both fronts follow it from
// collision to collision and between them, up to the turnover, in gaps and in absolute positions. (That it reaches
// farthest there, to the tabulated digits: core/theory/; an independent N-particle tracer agrees to 2e-29.) The
// recursion is computed with 1300 digits, for the very restitution or loss that the run has, not the decimal it stands
// for.
//
// Tolerance, in roundings of the type (in double-double, whose operations have larger errors, twice that). Inelastic:
// the closing speed at the front is multiplied by (1+eps)/2 once a collision: two roundings, so after n collisions it
// is off by 2 n of itself at most, as are all flights so far, which add up to t; places and times are rounded once more
// a collision: 3 n t. Absolute positions and velocities are rounded twice as often. Wet: a collision multiplies an
// error of r by at most 1 + e/r^2, r >= 1/2: over n collisions by less than 2 for the losses here (n e/r^2 of order 1);
// the law rounds some 8 times, so r_n is off by 16 n, flights l/r by as much of themselves, places by their sum: 32 n
// t.
#ifdef CRADLE_WITH_MPFR

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/core/theory/wet_shock.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::fronts_test {

PRECISION_SUITE(Fronts, EveryPrecision);

template <class T> auto tracer(const T& restitution) {
  return theory::FrontRecursion<Reference>(theory::InelasticShock<Reference>{reference(restitution)});
}
template <class T> auto wet_tracer(const T& loss) {
  return theory::WetFrontRecursion<Reference>(theory::WetShock<Reference>{reference(loss)});
}

// At a third of the way to the next collision all of this one are made.
template <class Run, class Recursion>
void expect_fronts(Run run, Recursion front, std::uint64_t turnover, std::uint64_t roundings) {
  using T = typename Run::Scalar;
  const Reference unit = reference(std::numeric_limits<T>::epsilon()) / (RoundsToNearest<T> ? 2 : 1);
  for (std::uint64_t n = 1; n <= turnover; ++n) {
    front.advance();
    const auto now = front.now();
    const auto third = static_cast<double>(now.time + 1 / (now.velocity + Reference(0.5)) / 3);
    const T t = exactly<T>(third);
    ASSERT_EQ(run.advance(t), Status::reached);
    ASSERT_EQ(run.collided_particles() + static_cast<ParticleIndex>(run.counts().merges),
              static_cast<ParticleIndex>(2 * now.collision));
    const Reference place = now.position + now.velocity * (reference(third) - now.time);
    const Reference tolerance = roundings * (now.collision + 1) * reference(third + 1) * unit;
    ASSERT_LE(abs(reference(run.front_right(t)) - place), tolerance) << third;
    ASSERT_LE(abs(reference(run.front_left(t)) + place), tolerance) << third;
  }
  EXPECT_EQ(run.account().order_lost, 0U);
  EXPECT_EQ(run.account().simultaneous, 0U) << "triple collisions, decided by the tie rule";
}

PRECISION_TEST(Fronts, OfInelasticRowsFollowTheRecursion) {
  const T restitution = from_text<T>("0.99");
  const Inelastic<T> law(restitution);
  expect_fronts(gap_run(lattice_rows<T>(500), law), tracer(restitution), 139, 3);
  expect_fronts(position_run(lattice_rows<T>(500), law), tracer(restitution), 139, 6);
}

PRECISION_TEST(Fronts, OfWetRowsFollowTheRecursion) {
  for (const auto& [divisor, turnover] : {std::pair(100, 38), std::pair(20, 8)}) {
    const T loss = T(1) / T(divisor);
    expect_fronts(Simulation(Wet<T>(loss), ClusterChain<T>(lattice_rows<T>(4 * turnover), T(0))), wet_tracer(loss),
                  static_cast<std::uint64_t>(turnover), 32);
  }
}

TEST(FrontsInDouble, FollowTheRecursionForThousandsOfCollisions) {
  expect_fronts(gap_run(lattice_rows(5000), Inelastic(.999)), tracer(.999), 1386, 3);
  expect_fronts(position_run(lattice_rows(5000), Inelastic(.999)), tracer(.999), 1386, 6);
  expect_fronts(Simulation(Wet(1e-4), ClusterChain<double>(lattice_rows(15000), 0.)), wet_tracer(1e-4), 3750, 32);
}

// Rows of particles displaced at random: the front still is within a spacing of the lattice's, as long as particles
// come at a steady rate; displacements do not add up.
TEST(FrontsInDouble, OfPerturbedRowsStayWithinASpacing) {
  for (const auto& [restitution, turnover, count] : {std::tuple(.999, 1999., 5000), std::tuple(.99, 200., 500)}) {
    auto run = gap_run(uniform_rows(count, 0.05, 1), Inelastic(restitution));
    const theory::InelasticShock<double> shock{restitution};
    for (int k = 1; k <= 10; ++k) {
      const double t = turnover * k / 10, place = theory::front_position_discrete(shock, t);
      ASSERT_EQ(run.advance(t), Status::reached);
      EXPECT_NEAR(run.front_right(t), place, 1) << t;
      EXPECT_NEAR(run.front_left(t), -place, 1) << t;
    }
  }
}

}  // namespace cradle::test::fronts_test

#endif
