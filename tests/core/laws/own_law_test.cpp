// A law and an observer written by a user, as core/README.md describes them: a restitution that depends on the closing
// speed, eps = 1 - w/(2(w + w0)), 1 for slow collisions and 1/2 for fast ones. Proves: the engine needs to know nothing
// else of a law; outcomes are those computed by hand, the ledger is the direct sum, momentum is kept, and gaps and
// positions make the same collisions at every particle.
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::own_law_test {

template <Real T> class Softening {
 public:
  static constexpr bool bounces_only = true;

  explicit Softening(const T& half_way) : half_way_(half_way) {}  // w0 > 0, a speed

  template <class Masses> Outcome<T> operator()(const T& w, const Masses& masses) const {
    const T lack = w / (T(2) * (w + half_way_));  // 1 - eps
    const T half = w - w * lack / T(2);           // (1 + eps) w/2, of which the change of closing speed is twice
    const T after = w - (half + half);            // -eps w, and exact, since eps >= 1/2
    const Shares<T> shares = masses.shares(half);
    return {after, shares.left, shares.right, masses.reduced() * (lack * (T(2) - lack)) * (w * w) / T(2)};
  }

 private:
  T half_way_;
};
static_assert(Law<Softening<double>, double>);

// Two particles that meet at w = w0 = 1, so eps = 3/4: all numbers are exact.
TEST(OwnLaw, OutcomesAreThoseByHand) {
  const double unit = 1, half = 0.5, heavy = 3;
  const Softening<double> law(1);
  const Outcome<double> equal = law(1.0, EqualMasses<double>{unit, half});
  EXPECT_EQ(equal.closing, -0.75);
  EXPECT_EQ(equal.to_left, 0.875);
  EXPECT_EQ(equal.to_right, 0.875);
  EXPECT_EQ(equal.energy_lost, 7.0 / 64);  // mu = 1/2
  const Outcome<double> unequal = law(1.0, TwoMasses<double>{unit, heavy});
  EXPECT_EQ(unequal.to_left, 21.0 / 16);  // J = mu 7/4, mu = 3/4
  EXPECT_EQ(unequal.to_right, 7.0 / 16);
  EXPECT_EQ(unequal.energy_lost, 21.0 / 128);
}

TEST(OwnLaw, GapsAndPositionsAgreeAndTheLedgerIsTheDirectSum) {
  const auto particles = rshock<double>(400);
  const Softening<double> law(10);
  Simulation gaps(law, GapChain<double>(particles, 0.0));
  Simulation positions(law, PositionChain<double>(particles, 0.0));
  EXPECT_EQ(sequence_to(gaps, 150.0), sequence_to(positions, 150.0));
  EXPECT_GT(gaps.counts().collisions, 5000U);
  EXPECT_EQ(gaps.account().order_lost, 0U);

  // A collision rounds two closing speeds, of size at most 1, by 2^-54 each, and the velocities of all particles on one
  // side with them.
  const double rounding = static_cast<double>(gaps.counts().collisions) * 2 * 0x1p-54 * 400;
  const auto now = gaps.configuration(150.0);
  EXPECT_NEAR(kinetic_energy(now, *particles, now.time), particles->kinetic_energy() - gaps.energy_lost(), rounding);
  EXPECT_NEAR(momentum_gained(now, *particles), 0, rounding);
}

}  // namespace cradle::test::own_law_test
