// The two heaviest clusters in the force of the wet zone, equation (16), and its simple version (17).
// Proves: the integrated motion is that of closed forms (constant mass: parabolas of known period; growing mass:
// flights with a logarithm) to its tolerance, although the force jumps; energy in the zone at constant mass; what
// happens where the clusters meet; that order and mirror images change nothing. (Oscillations in the zone and the
// exponents of (17): tools/run/clusters_test.cpp; that samples change nothing: tests/tools/run/outputs.txt.)
#include "cradle/core/theory/wet_clusters.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/numeric/odeint.hpp>
#include <gtest/gtest.h>

#include <utility>

#include "cradle/core/theory/wet_zone.hpp"

namespace cradle::test::wet_clusters_test {

using namespace cradle::theory;

constexpr double ulp = std::numeric_limits<double>::epsilon();

auto stepper(double tolerance) {
  namespace odeint = boost::numeric::odeint;
  return odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<ClusterState>());
}

template <class Force>
auto motion(const Force& force, const ClusterRules& rules, const ClusterStart& first, const ClusterStart& second,
            double tolerance = 1e-10, double start = 0) {
  using Stepper = decltype(stepper(tolerance));
  return ClusterMotion<Force, Stepper>(force, rules, {first, second}, start, stepper(tolerance));
}

const ClusterRules freely{.meeting = Meeting::pass};

// The paper's zone: u0 = 1/2, E_loss = 0.05.
WetZone<double> paper_zone(double loss = 0.05) { return WetZone<double>(WetShock<double>{loss}); }
ClusterRules in_the_zone(const WetZone<double>& zone, Meeting meeting) {
  return {1, zone.shock().loss, meeting, zone.half_width(), zone.shock().speed};
}
const double edge = paper_zone().half_width();
auto in_the_papers_zone(Meeting meeting, const ClusterStart& first, const ClusterStart& second,
                        double tolerance = 1e-10) {
  const auto zone = paper_zone();
  return motion(ZoneForce(zone), in_the_zone(zone, meeting), first, second, tolerance);
}

// ---- (17) at constant mass: parabolas ----

TEST(WetClusters, ConstantMassIsPeriodicForever) {
  // x'' = -alpha sgn x from rest at a: x = a - alpha t^2/2, period 4 sqrt(2 a/alpha) = 16 for a = 1, alpha = 1/8.
  // Both cross the edge, and each other, at the same times.
  auto run = motion(SignForce(0.125), freely, {1, 0, 0}, {-1, 0, 0});
  double worst = 0;
  for (int k = 1; k <= 16000; ++k) {
    run.advance(k);
    const int phase = k % 16;
    const int since = phase < 4 || phase >= 12 ? (phase + 4) % 16 - 4 : phase - 8;  // since the last rest
    const double sign = phase < 4 || phase >= 12 ? 1 : -1;
    worst = std::max(worst, std::abs(run.first().x - sign * (1 - since * since / 16.)));
    ASSERT_EQ(run.second()->x, -run.first().x) << "mirror images to the last bit";
  }
  // A parabola is exact for the integrator. Each of 2000 crossings is found up to an ulp of t late, which makes the
  // speed, 1/2, wrong by alpha times that and each later half period by twice that: n^2 ulps of t in all.
  EXPECT_LT(worst, 2000. * 2000 * 8192 * ulp / 2);
  EXPECT_EQ(run.meetings().size(), 2000U);
}

// ---- (17) with growing mass: flights in closed form ----

// x'' = F/(1 + r t): v and x after the time t from x0, v0 at t0.
struct Flight {
  long double t0, x0, v0;
  long double force, rate;
  long double velocity(long double t) const {
    return v0 + force / rate * std::log1p(rate * (t - t0) / (1 + rate * t0));
  }
  long double position(long double t) const {
    const long double part = std::log1p(rate * (t - t0) / (1 + rate * t0));
    return x0 + v0 * (t - t0) + force / (rate * rate) * ((1 + rate * t) * part - rate * (t - t0));
  }
};

// Slow twin: from flight to flight, crossings by bisection.
class Flights {
 public:
  Flights(double alpha, double rate, double x0) : flight_{0, x0, 0, -alpha, rate} {}
  double position(double t) {
    while (true) {
      const long double end = next_crossing();
      if (end > t) return static_cast<double>(flight_.position(t));
      flight_ = {end, 0, flight_.velocity(end), -flight_.force, flight_.rate};
    }
  }

 private:
  long double next_crossing() const {
    const long double side = flight_.force < 0 ? 1 : -1;
    // beyond the turn it only comes closer
    long double low = flight_.t0, step = 1;
    while (side * flight_.velocity(low + step) > 0) low += step, step *= 2;
    long double high = low + step;
    while (side * flight_.position(high) > 0) low = high, high += step, step *= 2;
    for (int k = 0; k < 200; ++k) {
      const long double middle = (low + high) / 2;
      (side * flight_.position(middle) > 0 ? low : high) = middle;
    }
    return high;
  }
  Flight flight_;
};

double error_of(double tolerance) {
  auto run = motion(SignForce(0.05), freely, {1, 0, 0.5}, {-1, 0, 0.5}, tolerance);
  Flights exact(0.05, 0.5, 1);
  double worst = 0;
  for (int k = 1; k <= 400; ++k) {
    const double t = k * k / 16.;
    run.advance(t);
    worst = std::max(worst, std::abs(run.first().x - exact.position(t)));
  }
  return worst;
}

TEST(WetClusters, GrowingMassFollowsTheClosedForm) {
  // Up to t = 1e4, an amplitude of 14 and some 20 jumps of the force: errors of v act for all of the time left, so x is
  // not right to the tolerance but to a number of tolerances that does not depend on it.
  for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) EXPECT_LT(error_of(tolerance), 1000 * tolerance);
}

// ---- (16): the zone ----

TEST(WetClusters, ConstantMassKeepsItsEnergyInTheZone) {
  const auto zone = paper_zone();
  const ZoneForce force(zone);
  const auto potential = [&](double x) {
    const double inside = std::min(std::abs(x), edge);
    const double work = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double y) { return force(1, y); }, 0.0, inside, 8, 1e-14);
    return -work + std::max(std::abs(x) - edge, 0.0) * zone.row_force();
  };
  // around one edge, over the barrier in the middle, and fast
  for (const auto& [x, v] : {std::pair{-1.2 * edge, 0.0}, std::pair{-3 * edge, 0.0}, std::pair{0.1 * edge, 0.4}}) {
    auto run = motion(force, in_the_zone(zone, Meeting::pass), {x, v, 0}, {50 * edge, 0, 0}, 1e-11);
    const double energy = v * v / 2 + potential(x);
    for (int k = 1; k <= 100; ++k) {
      run.advance(k * 0.37);
      const Cluster now = run.first();
      // some 1e3 steps of relative error 1e-11, on energies of the order of u0^2
      EXPECT_NEAR(now.v * now.v / 2 + potential(now.x), energy, 1e3 * 1e-11 * 0.25) << k;
    }
  }
}

TEST(WetClusters, ClusterAtRestOnTheEdgeStaysThere) {
  auto run = in_the_papers_zone(Meeting::energy, {-edge, 0, 0.5}, {edge, 0, 0.5});
  run.advance(1e6);
  EXPECT_EQ(run.first().x, -edge) << "both sides push it there";
  EXPECT_EQ(run.second()->x, edge);
  EXPECT_EQ(run.second()->mass, 500001);
}

// ---- meetings: no force, masses 1 + r t, both at the centre at t = 2 ----

auto encounter(Meeting meeting, double loss, double left_rate, double right_rate) {
  return motion(SignForce(0), {.loss = loss, .meeting = meeting}, {-1, 0.5, left_rate}, {1, -0.5, right_rate});
}

TEST(ClusterMeeting, PassingCostsTheLossAndKeepsMomentum) {
  auto run = encounter(Meeting::energy, 0.25, 0.5, 1);  // masses 2 and 3 at t = 2: mu w^2/2 = 0.6
  run.advance(4);
  ASSERT_EQ(run.meetings().size(), 1U);
  const auto& meeting = run.meetings()[0];
  EXPECT_NEAR(meeting.time, 2, 4 * ulp);
  EXPECT_NEAR(meeting.x, 0, 4 * ulp);
  EXPECT_NEAR(meeting.relative_energy, 0.6, 8 * ulp);
  EXPECT_FALSE(meeting.stuck);
  EXPECT_FALSE(run.first_is_left());
  const double v = run.first().v, u = run.second()->v;
  EXPECT_NEAR(2 * v + 3 * u, 2 * 0.5 - 3 * 0.5, 8 * ulp);
  EXPECT_NEAR(0.6 * (v - u) * (v - u), 0.6 - 0.25, 8 * ulp) << "the first continues to the right, slower";
  EXPECT_GT(v, u);
  EXPECT_NEAR(run.first().x, 2 * v, 16 * ulp);
}

TEST(ClusterMeeting, SlowClustersStick) {
  for (const auto& [meeting, loss] : {std::pair{Meeting::energy, 0.7}, std::pair{Meeting::stick, 0.0}}) {
    auto run = encounter(meeting, loss, 0.5, 1);
    run.advance(1);
    EXPECT_TRUE(run.second());
    run.advance(4);
    EXPECT_TRUE(run.meetings()[0].stuck);
    EXPECT_FALSE(run.second());
    EXPECT_NEAR(run.first().mass, 8, 8 * ulp) << "1 + 1 + (.5 + 1) 4: it takes up what both took up";
    EXPECT_NEAR(run.first().v, (2 * 0.5 - 3 * 0.5) / 5, 4 * ulp);
    EXPECT_NEAR(run.first().x, 2 * run.first().v, 8 * ulp);
  }
}

TEST(ClusterMeeting, EqualityMergesAsInTheWetLaw) {
  // equal masses 1 closing at 1: mu w^2/2 = 1/4
  auto equal = encounter(Meeting::energy, 0.25, 0, 0);
  equal.advance(3);
  EXPECT_TRUE(equal.meetings()[0].stuck);
  auto above = encounter(Meeting::energy, 0.25 * (1 - 4 * ulp), 0, 0);
  above.advance(3);
  EXPECT_FALSE(above.meetings()[0].stuck);
}

TEST(ClusterMeeting, FreePassageChangesNothing) {
  auto run = encounter(Meeting::pass, 100, 0.5, 1);
  run.advance(5);
  EXPECT_EQ(run.meetings().size(), 1U);
  EXPECT_EQ(run.first().v, 0.5);
  EXPECT_EQ(run.second()->v, -0.5);
  EXPECT_FALSE(run.first_is_left());
}

TEST(ClusterMeeting, SampleAtTheMeetingIsTheStateAfterIt) {
  auto run = encounter(Meeting::stick, 0, 0, 0);
  run.advance(10);
  auto again = encounter(Meeting::stick, 0, 0, 0);
  again.advance(run.meetings()[0].time);
  EXPECT_FALSE(again.second());
  EXPECT_EQ(again.first().v, 0);
}

TEST(WetClusters, MirrorImageIsTheSame) {
  auto run = in_the_papers_zone(Meeting::energy, {-2 * edge, 0.3, 0.2}, {1.5 * edge, 0, 0.8});
  auto mirror = in_the_papers_zone(Meeting::energy, {2 * edge, -0.3, 0.2}, {-1.5 * edge, 0, 0.8});
  for (int k = 1; k <= 500; ++k) {
    run.advance(k * 0.5);
    mirror.advance(k * 0.5);
    ASSERT_EQ(run.first().x, -mirror.first().x) << k;
    ASSERT_EQ(run.second().has_value(), mirror.second().has_value());
    ASSERT_NE(run.first_is_left(), mirror.first_is_left());
  }
  EXPECT_FALSE(run.meetings().empty());
}

}  // namespace cradle::test::wet_clusters_test
