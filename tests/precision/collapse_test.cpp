// Collapse under policy stop. Proves: for 3, 10 and 100 particles with a restitution at which three collapse, a run
// with exact dynamics ends by itself with the collapse time of the same run in 100 digits, within its stated
// uncertainty. In double, where rounding may leave the collapse open, it may also end with the type's range. Near the
// elastic limit 1e5 particles run until just before the onset of collapse; no order is lost. A mirror-symmetric pattern
// of 4 particles, in which symmetry is unstable, keeps it as long as the type's digits allow. Random systems of two to
// six particles, with walls and unequal masses, are in every type reported to collapse only if they do so with 60
// digits, down to gaps of 1e-3000; the stated error of t_c bounds the true error in each case, and is at most a hundred
// times as large in half of them.
#include <iostream>
#include <random>

#include "cradle/core/initial/walled.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::collapse_test {

PRECISION_SUITE(CollapseSizes, WidePrecision);

// Collapse sets in at t = N_c/(2 u0), N_c = 2/(1 - (4/pi) atan sqrt eps) particles being engaged.
double onset(double restitution) { return 2 / (1 - 4 / M_PI * std::atan(std::sqrt(restitution))); }

// Three particles collapse below eps = 7 - 4 sqrt 3 = 0.0718; the same doubles are exact in every type.
constexpr double soft[] = {.05, 0.01, .0625};

template <class T> std::vector<Scene<T>> scenes() {
  return {list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}), rshock<T>(10), rshock<T>(100), rmix<T>(10), rmix<T>(100)};
}

// Nothing where rounding leaves it open.
template <class T>
std::optional<CollapseReport<T>> collapse_of(const Scene<T>& particles, double restitution, std::uint64_t& collisions) {
  auto run = gap_run(particles, Inelastic<T>(T(restitution), T(0)), stop_below(T(0)));
  const Status status = run.advance(T(1000));
  EXPECT_EQ(run.chain().account().order_lost, 0U);
  // With more than 16 particles also without a proof, where a gap is very small.
  const bool settled = run.collapse().settled, many = run.chain().particles().count() > 16;
  EXPECT_TRUE(status == Status::collapsed ? settled || many : status == Status::exhausted && !settled);
  collisions = run.counts().collisions;
  return run.collapse().settled ? std::optional(run.collapse()) : std::nullopt;
}

// Returns how many collapses were not settled.
template <class T> int expect_ends_of_all_sizes() {
  const auto in_type = scenes<T>();
  const auto in_wide = scenes<bin_float>();
  int open = 0;
  for (const double restitution : soft)
    for (std::size_t k = 0; k < in_type.size(); ++k) {
      SCOPED_TRACE(testing::Message() << "eps " << restitution << ", scene " << k);
      std::uint64_t collisions = 0, in_more_digits = 0;
      const auto report = collapse_of(in_type[k], restitution, collisions);
      const auto expected = collapse_of(in_wide[k], restitution, in_more_digits);
      EXPECT_TRUE(expected.has_value());
      if (!report || !expected) {
        ++open;
        continue;
      }
      const bin_float error =
          in_100_digits(report->time.high) + in_100_digits(report->time.low) - expected->time.value();
      EXPECT_LE(magnitude(error), in_100_digits(report->uncertainty));
      EXPECT_GT(in_more_digits, collisions) << "more digits, more collisions that they distinguish";
    }
  return open;
}

PRECISION_TEST(CollapseSizes, RunsEndByThemselves) { EXPECT_EQ(expect_ends_of_all_sizes<T>(), 0); }

TEST(CollapseSizesInDouble, RunsEndByThemselves) {
  EXPECT_LE(expect_ends_of_all_sizes<double>(), 4) << "of the two rows, whose last collisions are slow";
}

TEST(SlowCollapseSizes, AHundredThousandParticlesUpToTheOnset) {
  auto run = gap_run(rshock<double>(100000), Inelastic<double>(0.999), stop_below(0.));
  EXPECT_EQ(run.advance(0.98 * onset(0.999)), Status::reached);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

// Collisions until the pattern - every second gap, then the others - breaks, in cycles; at most `most`.
template <class T> int cycles_kept(const Scene<T>& particles, const T& restitution, int most) {
  auto run = gap_run(particles, Inelastic<T>(restitution, T(0)), stop_below(from_text<T>("1e-280")));
  const int gaps = static_cast<int>(particles->count()) - 1;
  std::vector<ParticleIndex> order;
  run.advance(T(100), [&](const Collision<T>& c) {
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

// Four particles in the checkerboard pattern (Bernu and Mazighi, J. Phys. A 23, 5745 (1990)): gaps (1, 2, 1), closing
// speeds (1, 1, 1).
template <class T> Scene<T> checkerboard() {
  return list<T>({T(0), T(1), T(3), T(4)}, {T(3) / T(2), T(1) / T(2), T(-1) / T(2), T(-3) / T(2)});
}

// With eps = 0.15 a = (1 + eps) cos(pi/4), and an antisymmetric error grows by eps/lam-^2 a cycle. From one rounding it
// takes ln(1/v)/ln(eps/lam-^2) cycles to become as large as the gaps.
PRECISION_TEST(CollapseSizes, FourParticlesKeepTheirSymmetry) {
  const double eps = 0.15, a = (1 + eps) / std::sqrt(2.), slow = (a - std::sqrt(a * a - 4 * eps)) / 2;
  const double growth = eps / (slow * slow), room = -std::log(to_double(std::numeric_limits<T>::epsilon()));
  const int predicted = static_cast<int>(room / std::log(growth));
  // 64 roundings of head start: 4 cycles.
  EXPECT_GE(cycles_kept(checkerboard<T>(), from_text<T>(".15"), 1000), predicted - 4);
}

// In double the arithmetic is mirror-symmetric to the last bit: the pattern lasts until the collapse, of known time.
TEST(CollapseSizesInDouble, FourParticlesKeepTheirSymmetryToTheLastBit) {
  for (const auto& [eps, collapse] :
       {std::pair(.15, 11. / 7), std::pair(.1, 1.53471469049059024594590831142126492903)}) {
    SCOPED_TRACE(eps);
    EXPECT_EQ(cycles_kept(checkerboard<double>(), eps, 100), 100);
    auto run = gap_run(checkerboard<double>(), Inelastic<double>(eps), stop_below(1e-100));
    run.advance(2, [&](const Collision<double>& c) {
      const auto& chain = run.chain();
      if (c.left == 1) {
        ASSERT_EQ(chain.closing(chain.first()), chain.closing(chain.last()));
      }
    });
    EXPECT_NEAR(run.last_collision_time(), collapse, 1e-15 * collapse);
  }
}

// ---- random systems
//
// t_c is the last collision before a gap of 1e-6000 with 60 digits, if it agrees with the one before 1e-3000 to 45
// digits. In double-double the stated error is eight times as large: the errors of its operations are bounded by up to
// eight times those of types that round to nearest (4 epsilon instead of 1/2 in a quotient), and rarely reach that.

#ifdef CRADLE_WITH_MPFR
using Exact = Mpfr<4>;

// Decimals, so that each type rounds them for itself.
struct System {
  std::vector<std::string> x, v, m;
  std::string restitution, wall;
};

class Systems {
 public:
  explicit Systems(std::uint64_t seed) : generator_(seed) {}
  System operator()() {
    System s;
    const bool walled = uniform() < 0.3;
    const int particles = walled ? 2 + static_cast<int>(3 * uniform()) : 3 + static_cast<int>(4 * uniform());
    if (walled) s.wall = decimal(0.01 + 0.3 * uniform());
    double x = 0;
    const bool unequal = uniform() < 0.4;
    for (int k = 0; k < particles; ++k) {
      s.x.push_back(decimal(x += 0.05 + uniform()));
      s.v.push_back(decimal(2 * uniform() - 1 - 0.5 * (k - 0.5 * (particles - 1)) - (walled ? 0.5 : 0)));
      if (unequal) s.m.push_back(decimal(std::exp(6 * uniform() - 3)));
    }
    s.restitution = decimal(0.002 + 0.3 * std::pow(uniform(), 1.5));
    return s;
  }

 private:
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }
  static std::string decimal(double x) { return std::to_string(x); }
  std::mt19937_64 generator_;
};

template <class T> struct End {
  Status status;
  CollapseReport<T> report;
};
// Ends by itself, or after so many collisions.
template <class T> End<T> end_of(const System& s, const char* stop_gap) {
  Scene<T> particles = list<T>(numbers<T>(s.x), numbers<T>(s.v), numbers<T>(s.m));
  if (!s.wall.empty()) {
    Wall<T> wall{T(0)};
    wall.restitution = from_text<T>(s.wall);
    particles = std::make_shared<Walled<T>>(particles, wall, std::nullopt);
  }
  Policy<T> policy = stop_below(from_text<T>(stop_gap));
  std::uint64_t reviews = 0;
  policy.interrupt = [&] { return ++reviews > 500000; };
  auto run = mass_run<T>(particles, Inelastic<T>(from_text<T>(s.restitution), T(0)), policy);
  const Status status = run.advance(T(1000000));
  return {status, run.collapse()};
}
template <class T> Exact exact(const T& x) { return from_text<Exact>(to_text(x)); }

template <class T> void check(const System& s, const std::optional<Exact>& time, std::vector<double>& ratios) {
  const End<T> end = end_of<T>(s, "0");
  EXPECT_EQ(end.status == Status::collapsed, end.report.settled);
  if (!end.report.settled) return;
  ASSERT_TRUE(time.has_value()) << "it does not collapse";
  const Exact error = magnitude(Exact(exact(end.report.time.high) + exact(end.report.time.low) - *time));
  const Exact stated = exact(end.report.uncertainty);
  EXPECT_LE(error, stated);
  ratios.push_back(to_double(Exact(stated / (error + from_text<Exact>("1e-60")))));
}

void expect_errors_hold(int systems, std::uint64_t seed) {
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(60));
  std::cout << "seed " << seed << '\n';
  Systems next(seed);
  std::vector<double> ratios[4];
  for (int k = 0; k < systems; ++k) {
    const System s = next();
    SCOPED_TRACE(testing::Message() << "system " << k << " of seed " << seed);
    const auto deep = end_of<Exact>(s, "1e-3000"), deeper = end_of<Exact>(s, "1e-6000");
    std::optional<Exact> time;
    if (deeper.status == Status::collapsed) {
      time = deeper.report.last_collision;
      if (*time - deep.report.last_collision > from_text<Exact>("1e-45")) continue;  // too slow to be compared with
    }
    check<double>(s, time, ratios[0]);
    check<long double>(s, time, ratios[1]);
    check<double_double>(s, time, ratios[2]);
#ifdef CRADLE_WITH_FLOAT128
    check<float128>(s, time, ratios[3]);
#endif
  }
  for (auto& of_type : ratios) {
    if (of_type.empty()) continue;
    std::sort(of_type.begin(), of_type.end());
    std::cout << of_type.size() << " collapses; stated error over true one: least " << of_type.front() << ", median "
              << of_type[of_type.size() / 2] << '\n';
    EXPECT_GT(of_type.size(), static_cast<std::size_t>(systems) / 4);
    if (systems >= 100) {
      EXPECT_LE(of_type[of_type.size() / 2], &of_type == &ratios[2] ? 800 : 100);
    }
  }
}

TEST(CollapseRandom, ErrorsHold) { expect_errors_hold(6, 3); }
TEST(SlowCollapseRandom, ErrorsHold) { expect_errors_hold(200, 20261123); }

#endif

}  // namespace cradle::test::collapse_test
