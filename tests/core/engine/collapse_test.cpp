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

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <numbers>

#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/slow_loop.hpp"

namespace collapse_test {

using namespace cradle;
using namespace cradle::test;
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

struct Reference {
  double restitution;
  const char* collapse_time;
  int passes_e16, passes_e34, passes_e100, passes_e300;  // collision at which the gap is first below 1e-16, ...
  int plain_clock_stops;                                 // collision at which t + dt == t in plain double

  friend void PrintTo(const Reference& r, std::ostream* out) { *out << "eps=" << r.restitution; }
};
const Reference references[] = {
    {.05, "1.714285714285714285714285714285714285714285714286", 18, 38, 111, 333, 31},
    {.01, "1.6736937682559527405521559675474991365441632665957", 11, 21, 61, 179, 12},
    {1. / 16, "1.7377984054260977582367587110958928498213699562943", 22, 45, 133, 398, 49},
};

// Closing at 1 on both sides, collision at t = 1, collapse at 4/3. (0, 1, 2 would be a triple collision.)
Scene<double> three_particles() { return list<double>({0, 1, 3}, {1, 0, -1}); }

// Collisions until the gap left beside one is below `least`.
std::vector<Step<double>> collisions_down_to(double least, double restitution, const Scene<double>& particles) {
  SlowLoop loop(Inelastic<double>(restitution), GapChain<double>(particles, 0));
  std::vector<Step<double>> steps;
  do {
    const auto s = loop.next();
    if (!s) return steps;
    steps.push_back(loop.collide(*s));
  } while (steps.back().nearest_gap >= least);
  return steps;
}

int first_below(double gap, const std::vector<Step<double>>& steps) {
  for (std::size_t n = 0; n < steps.size(); ++n)
    if (steps[n].nearest_gap < gap) return static_cast<int>(n) + 1;
  return -1;
}

class ThreeParticles : public testing::TestWithParam<Reference> {};
INSTANTIATE_TEST_SUITE_P(Collapse, ThreeParticles, testing::ValuesIn(references));

TEST_P(ThreeParticles, CollisionTimesSumUpToTheCollapseTime) {
  // 15 digits, where t itself has 16: the first collisions decide, later intervals shrink by lam-/lam+ < 1/2.
  const auto steps = collisions_down_to(1e-300, GetParam().restitution, three_particles());
  const Wide collapse = Wide(GetParam().collapse_time);
  EXPECT_LE(abs(Wide(steps.back().time.value()) - collapse), Wide(1e-15) * collapse);
}

TEST_P(ThreeParticles, GapTimesClosingSpeedFallsByTheRestitution) {
  const auto steps = collisions_down_to(1e-300, GetParam().restitution, three_particles());
  Wide invariant = 1;  // g_0 = p_0 = 1
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const Wide product = Wide(steps[n].nearest_gap) * Wide(steps[n].closing_speed);
    ASSERT_LE(abs(product / invariant - 1), Wide(3 * static_cast<double>(n) * u)) << "collision " << n;
    invariant *= Wide(GetParam().restitution);
  }
}

TEST_P(ThreeParticles, GapPassesEveryDecadeAtTheRightCollision) {
  const auto steps = collisions_down_to(1e-300, GetParam().restitution, three_particles());
  EXPECT_EQ(first_below(1e-16, steps), GetParam().passes_e16);
  EXPECT_EQ(first_below(1e-34, steps), GetParam().passes_e34);
  EXPECT_EQ(first_below(1e-100, steps), GetParam().passes_e100);
  EXPECT_EQ(first_below(1e-300, steps), GetParam().passes_e300);
}

// Each p is formed from two others with three roundings, errors inherit the recursion's growth lam+; relative to p_n,
// with p_n > 0 falling by lam+ a collision, every collision adds at most 3 u (a + eps/lam+)/lam+ < 6 u for these.
TEST_P(ThreeParticles, ClosingSpeedsFollowTheRecursion) {
  const auto steps = collisions_down_to(1e-300, GetParam().restitution, three_particles());
  const Wide eps = GetParam().restitution, a = (1 + eps) / 2;
  Wide before = 1, p = 1 + a;
  for (std::size_t n = 1; n < steps.size(); ++n) {
    ASSERT_LE(abs(Wide(steps[n].closing_speed) / p - 1), Wide(6 * static_cast<double>(n) * u)) << "collision " << n;
    const Wide next = a * p - eps * before;
    before = p;
    p = next;
  }
}

TEST_P(ThreeParticles, ParticleOfEveryCollisionAlternates) {
  const auto steps = collisions_down_to(1e-300, GetParam().restitution, three_particles());
  for (std::size_t n = 0; n < steps.size(); ++n) ASSERT_EQ(steps[n].particle, static_cast<ParticleIndex>(n % 2));
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

// Unequal masses: a collision at one gap hands the share a_l = (1+eps) m_1/(m_1+m_2) of its closing speed to the right
// gap, the other way round a_r = (1+eps) m_3/(m_2+m_3). Scaling the closing speeds of every second collision by
// r = sqrt(a_l/a_r) gives the recursion above with a = sqrt(a_l a_r), so t_c = t_0 + g_0/(p_1 - r lam- p_0) and
// g_n p_n as before.
TEST(Collapse, UnequalMasses) {
  const double restitution = 0.1;
  const std::vector<double> m{3, 1, 2};
  const auto particles = list<double>({0, 1, 3}, {1, 0, -1}, m);
  SlowLoop loop(Inelastic<double>(restitution), GapChain<double, IndividualMasses<double>>(particles, 0));
  const Wide eps = restitution, to_right = (1 + eps) * 3 / 4, to_left = (1 + eps) * 2 / 3;
  const Wide r = sqrt(Wide(to_right / to_left)), a = sqrt(Wide(to_right * to_left));
  const Wide slow = (a - sqrt(Wide(a * a - 4 * eps))) / 2;
  const Wide collapse = 1 + 1 / (1 + to_right - r * slow);

  Wide invariant = 1;
  for (int n = 0;; ++n) {
    const auto s = loop.next();
    ASSERT_TRUE(s.has_value());
    const Step<double> step = loop.collide(*s);
    ASSERT_LE(abs(Wide(step.nearest_gap) * Wide(step.closing_speed) / invariant - 1), Wide(3 * n * u))
        << "collision " << n;
    invariant *= eps;
    if (step.nearest_gap > 1e-290) continue;
    EXPECT_LE(abs(Wide(step.time.value()) - collapse), Wide(1e-15) * collapse);
    break;
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
