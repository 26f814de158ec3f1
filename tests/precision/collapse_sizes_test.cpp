// Collapse of many bodies under policy stop. Proves: from 3 to 1e5 bodies a run with exact dynamics ends by itself,
// with a collapse time or because all bodies part, and no order is lost on the way. Mirror-symmetric patterns of 4 and
// 6 bodies, in which symmetry is unstable, keep it as long as the type's digits allow.
#include <gtest/gtest.h>

#include <cmath>

#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace collapse_sizes_test {

using namespace cradle;
using namespace cradle::test;

template <class T, class Run> void expect_an_end(Run run, const T& until, double onset) {
  const Status status = run.advance(until);
  EXPECT_TRUE(status == Status::collapsed || status == Status::reached) << static_cast<int>(status);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
  if (onset == 0) return;
  ASSERT_EQ(status, Status::collapsed);
  EXPECT_TRUE(run.collapse().extrapolated);
  EXPECT_GE(to_double(run.collapse().time.value()), .98 * onset);
  EXPECT_LE(to_double(run.collapse().time.value()), 1.1 * onset);
}

template <class P> using CollapseSizes = InPrecision<P>;
TYPED_TEST_SUITE(CollapseSizes, WidePrecision, PrecisionName);

// Collapse sets in at t = N_c/(2 u0), N_c = 2/(1 - (4/pi) atan sqrt eps) bodies being engaged.
double onset(double restitution) { return 2 / (1 - 4 / M_PI * std::atan(std::sqrt(restitution))); }

template <class T> void expect_ends_of_all_sizes() {
  for (const char* restitution : {".05", ".01", ".0625"}) {
    const Inelastic<T> law(from_text<T>(restitution), T(0));
    expect_an_end(gap_run(list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}), law, stop_below(T(0))), T(1000), 0);
    for (const BodyIndex n : {10, 100}) {
      expect_an_end(gap_run(rshock<T>(n), law, stop_below(T(0))), T(1000), 0);
      expect_an_end(gap_run(rmix<T>(n), law, stop_below(T(0))), T(1000), 0);
    }
  }
}

TYPED_TEST(CollapseSizes, RunsEndByThemselves) { expect_ends_of_all_sizes<typename TypeParam::Scalar>(); }

TEST(CollapseSizesInDouble, RunsEndByThemselves) {
  expect_ends_of_all_sizes<double>();
  // Close to the elastic limit many bodies collapse together, from t = N_c/(2 u0) on; a run to just before that ends
  // too.
  auto before = gap_run(rshock<double>(100), Inelastic<double>(.9), stop_below(0.));
  EXPECT_EQ(before.advance(.98 * onset(.9)), Status::reached);
}

TEST(SlowCollapseSizes, AHundredThousandBodiesUpToTheOnset) {
  auto run = gap_run(rshock<double>(100000), Inelastic<double>(.999), stop_below(0.));
  EXPECT_EQ(run.advance(.98 * onset(.999)), Status::reached);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

// Contacts until the pattern - every second gap, then the others - breaks, in cycles; at most `most`.
template <class T> int cycles_kept(const Scene<T>& bodies, const T& restitution, int most) {
  auto run = gap_run(bodies, Inelastic<T>(restitution, T(0)), stop_below(from_text<T>("1e-280")));
  const int gaps = static_cast<int>(bodies->count()) - 1;
  std::vector<BodyIndex> order;
  run.advance(T(100), [&](const Contact<T>& c) {
    if (static_cast<int>(order.size()) < most * gaps) order.push_back(c.left);
  });
  EXPECT_EQ(run.chain().account().order_lost, 0U);
  int cycles = 0;
  for (std::size_t at = 0; at + static_cast<std::size_t>(gaps) <= order.size(); ++cycles) {
    for (int k = 0; k < gaps; ++k, ++at) {
      const bool first_half = k <= gaps / 2;  // gaps 0, 2, ... are one more than the others
      if ((order[at] % 2 == 0) != first_half) return cycles;
    }
  }
  return cycles;
}

// Gaps (1, 2, 1), closing speeds (1, 1, 1), eps = .15: a = (1 + eps) cos(pi/4), and an antisymmetric error grows by
// eps/lam-^2 a cycle. From one rounding it takes ln(1/v)/ln(eps/lam-^2) cycles to become as large as the gaps.
TYPED_TEST(CollapseSizes, FourBodiesKeepTheirSymmetry) {
  using T = typename TypeParam::Scalar;
  const double eps = .15, a = (1 + eps) / std::sqrt(2.), slow = (a - std::sqrt(a * a - 4 * eps)) / 2;
  const double growth = eps / (slow * slow), room = -std::log(to_double(std::numeric_limits<T>::epsilon()));
  const int predicted = static_cast<int>(room / std::log(growth));
  const auto bodies = list<T>({T(0), T(1), T(3), T(4)}, {T(3) / T(2), T(1) / T(2), T(-1) / T(2), T(-3) / T(2)});
  EXPECT_GE(cycles_kept(bodies, from_text<T>(".15"), 1000), predicted - 4);  // 64 roundings of head start: 4 cycles
}

}  // namespace collapse_sizes_test
