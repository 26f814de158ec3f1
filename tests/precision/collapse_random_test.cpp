// Random systems of two to six particles, with walls and unequal masses, under policy stop. Proves: in every type, a
// system is reported to collapse only if it does so with 60 digits, down to gaps of 1e-3000; the stated error of t_c
// bounds the true error in each case, and is at most a hundred times as large in half of them. t_c is the last
// collision before a gap of 1e-6000 with 60 digits, if it agrees with the one before 1e-3000 to 45 digits.
//
// In double-double the stated error is eight times as large: the errors of its operations are bounded by up to eight
// times those of types that round to nearest (4 epsilon instead of 1/2 in a quotient), and rarely reach that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "cradle/core/initial/walled.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

#ifdef CRADLE_WITH_MPFR
namespace cradle::test::collapse_random_test {

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

}  // namespace cradle::test::collapse_random_test
#endif
