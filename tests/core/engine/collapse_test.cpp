// Inelastic collapse of three particles in the chain of gaps, collision by collision, against closed forms (McNamara
// and Young, Phys. Fluids A 4, 496 (1992), evaluated to 40 digits): with a = (1+eps)/2 the closing speeds p_n obey
// p_{n+1} = a p_n - eps p_{n-1}, the collision times sum up to t_c = t_0 + g_0/(p_1 - lam- p_0), and g_n p_n = eps^n
// g_0 p_0.
// Proves: plain double keeps the relative precision of gaps over 300 decades and sums the collision times to 15 digits.
//
// Bound on the invariant. With the origin of time at the last collision, the next one is at g/p (one rounding), the
// other gap then is (eps p_before) times that (two roundings): three roundings of u = 2^-53 a collision, however p is
// rounded.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/slow_loop.hpp"
#include "cradle/tests/core/three_collapses.hpp"

namespace collapse_test {

using namespace cradle;
using namespace cradle::test;
using Wide = Digits<100>;

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

// Collisions until the gap left beside one is below `least`.
template <class Chain = GapChain<double>>
std::vector<Step<double>> collisions_down_to(double least, double restitution, const Scene<double>& particles) {
  SlowLoop loop(Inelastic<double>(restitution), Chain(particles, 0));
  std::vector<Step<double>> steps;
  do {
    const auto s = loop.next();
    if (!s) return steps;
    steps.push_back(loop.collide(*s));
  } while (steps.back().nearest_gap >= least);
  return steps;
}

class ThreeParticles : public testing::TestWithParam<ThreeCollapse> {};
INSTANTIATE_TEST_SUITE_P(Collapse, ThreeParticles, testing::ValuesIn(three_collapses));

TEST_P(ThreeParticles, GapPassesEveryDecadeAtTheRightCollision) {
  const auto steps = collisions_down_to(1e-300, GetParam().restitution, three_particles());
  const auto first_below = [&](double gap) {
    const auto below = [&](const Step<double>& step) { return step.nearest_gap < gap; };
    return std::find_if(steps.begin(), steps.end(), below) - steps.begin() + 1;
  };
  EXPECT_EQ(first_below(1e-16), GetParam().passes_e16);
  EXPECT_EQ(first_below(1e-34), GetParam().passes_e34);
  EXPECT_EQ(first_below(1e-100), GetParam().passes_e100);
  EXPECT_EQ(first_below(1e-300), GetParam().passes_e300);
}

// Unequal masses: a collision at one gap hands the share a_l = (1+eps) m_1/(m_1+m_2) of its closing speed to the right
// gap, the other way round a_r = (1+eps) m_3/(m_2+m_3). Scaling the closing speeds of every second collision by
// r = sqrt(a_l/a_r) gives the recursion above with a = sqrt(a_l a_r), so t_c = t_0 + g_0/(p_1 - r lam- p_0) and
// g_n p_n as before.
//
// Bound on the speeds. Each p is formed from two others with three roundings, errors inherit the recursion's growth
// lam+; relative to p_n, with p_n > 0 falling by lam+ a collision, every collision adds at most
// 3 u (a + eps/lam+)/lam+ < 6 u for these.
template <class Chain> void expect_closed_form(double restitution, const std::vector<double>& m, const Wide& collapse) {
  const auto steps = collisions_down_to<Chain>(1e-290, restitution, three_particles(m));
  const Wide eps = restitution, to_right = (1 + eps) * m[0] / (m[0] + m[1]), to_left = (1 + eps) * m[2] / (m[1] + m[2]);
  Wide invariant = 1, before = 0, p = 1;  // g_0 = p_0 = 1
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const Wide closing = steps[n].closing_speed;
    ASSERT_EQ(steps[n].particle, static_cast<ParticleIndex>(n % 2));
    ASSERT_LE(abs(Wide(steps[n].nearest_gap) * closing / invariant - 1), Wide(3 * static_cast<double>(n) * u))
        << "collision " << n;
    ASSERT_LE(abs(closing / p - 1), Wide(6 * static_cast<double>(n) * u)) << "collision " << n;
    invariant *= eps;
    const Wide next = n == 0 ? Wide(1 + to_right) : Wide((n % 2 == 0 ? to_right : to_left) * p - eps * before);
    before = p;
    p = next;
  }
  // 15 digits, where t itself has 16: the first collisions decide, later intervals shrink by lam-/lam+ < 1/2.
  EXPECT_LE(abs(Wide(steps.back().time.value()) - collapse), Wide(1e-15) * collapse);
}

TEST_P(ThreeParticles, FollowTheClosedForm) {
  expect_closed_form<GapChain<double>>(GetParam().restitution, {1, 1, 1}, Wide(GetParam().collapse_time));
}

TEST(Collapse, UnequalMasses) {
  const Wide eps = 0.1, to_right = (1 + eps) * 3 / 4, to_left = (1 + eps) * 2 / 3;
  const Wide r = sqrt(Wide(to_right / to_left)), a = sqrt(Wide(to_right * to_left));
  const Wide slow = (a - sqrt(Wide(a * a - 4 * eps))) / 2;
  expect_closed_form<GapChain<double, IndividualMasses<double>>>(0.1, {3, 1, 2}, 1 + 1 / (1 + to_right - r * slow));
}

TEST(Collapse, HappensUpToSevenMinusFourRootThree) {
  // Just below the limit both roots are equal and the approach is slow: the margin is a hundredth.
  const double limit = 7 - 4 * std::numbers::sqrt3;
  for (const double below : {limit * 0.99, limit * .9}) {
    const auto steps = collisions_down_to(1e-100, below, three_particles());
    EXPECT_LT(steps.back().nearest_gap, 1e-100) << "eps = " << below;
  }
  for (const double above : {limit * 1.01, limit * 1.1, 0.5, .999}) {
    const auto steps = collisions_down_to(1e-100, above, three_particles());
    EXPECT_GE(steps.back().nearest_gap, 1e-100) << "eps = " << above << ": all three part";
  }
}

// Four particles in the checkerboard pattern (Bernu and Mazighi, J. Phys. A 23, 5745 (1990)): a -> (1+eps)/sqrt 2. The
// pattern is unstable: an antisymmetric error grows by eps/lam-^2 a cycle, so it lasts only as long as the arithmetic
// is mirror-symmetric to the last bit.
TEST(Collapse, FourParticlesInTheCheckerboardPattern) {
  const struct {
    double restitution;
    const char* collapse_time;
  } rows[] = {{.15, "1.571428571428571428571428571428571428571428571429"},
              {.1, "1.53471469049059024594590831142126492903216"}};
  for (const auto& row : rows) {
    const auto particles = list<double>({0, 1, 3, 4}, {1.5, 0.5, -0.5, -1.5});
    SlowLoop loop(Inelastic(row.restitution), GapChain<double>(particles, 0));
    Step<double> last{};
    for (int cycle = 0; cycle < 100; ++cycle) {
      for (const ParticleIndex particle : {0, 2, 1}) {
        const auto s = loop.next();
        ASSERT_TRUE(s.has_value());
        last = loop.collide(*s);
        ASSERT_EQ(last.particle, particle) << "cycle " << cycle;
      }
      const auto c = loop.chain().configuration(loop.chain().local_time(last.time.value()));
      ASSERT_EQ(c.closing_speed[0], c.closing_speed[2]) << "cycle " << cycle;
    }
    const Wide collapse = Wide(row.collapse_time);
    EXPECT_LE(abs(Wide(last.time.value()) - collapse), Wide(1e-15) * collapse) << "eps = " << row.restitution;
  }
}

}  // namespace collapse_test
