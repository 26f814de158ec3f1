// The whole of core/ on a scalar without implicit conversions. Proves: core/ uses the scalar only through the concept
// Real; the general code, written for types whose queue keys are rounded times, makes the same collisions as the code
// for double and gives the same bits, and so do the theories; observers require nothing of a scalar that a rational
// lacks.
#include <compare>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/correlations.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/core/theory/sticky_shock.hpp"
#include "cradle/core/theory/wet_energy.hpp"
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test::strict_scalar_test {

// The strictest scalar that the engine must accept: only the arithmetic of double. Conversions from an int or a 64-bit
// integer and to a double are explicit; there is no default value, and std:: mathematics is found by argument-dependent
// lookup only. Code that compiles with it has no implicit conversions; its results have the bits of double.
class StrictReal {
 public:
  explicit StrictReal(int value) : value_(value) {}
  explicit StrictReal(std::int64_t value) : value_(static_cast<double>(value)) {}
  template <class Other>
  requires std::is_arithmetic_v<Other> StrictReal(Other)
  = delete;

  // For tests; the engine does not use it.
  static StrictReal of(double value) {
    StrictReal x(0);
    x.value_ = value;
    return x;
  }

  explicit operator double() const { return value_; }
  template <class Other>
  requires(std::is_arithmetic_v<Other> && !std::same_as<Other, double>) explicit operator Other() const = delete;

  friend StrictReal operator+(const StrictReal& a, const StrictReal& b) { return of(a.value_ + b.value_); }
  friend StrictReal operator-(const StrictReal& a, const StrictReal& b) { return of(a.value_ - b.value_); }
  friend StrictReal operator*(const StrictReal& a, const StrictReal& b) { return of(a.value_ * b.value_); }
  friend StrictReal operator/(const StrictReal& a, const StrictReal& b) { return of(a.value_ / b.value_); }
  friend StrictReal operator-(const StrictReal& a) { return of(-a.value_); }
  StrictReal& operator+=(const StrictReal& b) { return *this = *this + b; }
  StrictReal& operator-=(const StrictReal& b) { return *this = *this - b; }
  StrictReal& operator*=(const StrictReal& b) { return *this = *this * b; }
  StrictReal& operator/=(const StrictReal& b) { return *this = *this / b; }
  friend std::partial_ordering operator<=>(const StrictReal&, const StrictReal&) = default;

  friend StrictReal sqrt(const StrictReal& a) { return of(std::sqrt(a.value_)); }
  friend StrictReal log(const StrictReal& a) { return of(std::log(a.value_)); }
  friend StrictReal atan(const StrictReal& a) { return of(std::atan(a.value_)); }
  friend StrictReal cos(const StrictReal& a) { return of(std::cos(a.value_)); }

 private:
  double value_;
};

}  // namespace cradle::test::strict_scalar_test

template <> struct std::numeric_limits<cradle::test::strict_scalar_test::StrictReal> {
  using Real = cradle::test::strict_scalar_test::StrictReal;
  static constexpr bool is_specialized = true, is_signed = true, is_integer = false, is_exact = false;
  static constexpr int radix = 2, digits = 53;
  static Real epsilon() { return Real::of(std::numeric_limits<double>::epsilon()); }
  static Real min() { return Real::of(std::numeric_limits<double>::min()); }
  static Real max() { return Real::of(std::numeric_limits<double>::max()); }
  static Real lowest() { return Real::of(std::numeric_limits<double>::lowest()); }
};

namespace cradle::test::strict_scalar_test {

static_assert(Real<StrictReal>);
static_assert(!std::convertible_to<double, StrictReal> && !std::convertible_to<int, StrictReal>);
static_assert(!std::convertible_to<StrictReal, double> && !std::default_initializable<StrictReal>);

// A double in a type that may be this one.
template <class T> T number(double x) {
  if constexpr (std::same_as<T, StrictReal>)
    return StrictReal::of(x);
  else
    return x;
}

// `compute` works in the type of its argument, which is 0.
template <class Compute> void expect_bits_of_double(const Compute& compute) {
  EXPECT_EQ(compute(StrictReal(0)), compute(0.));
}

// ---- the engine

// All that a configuration holds.
template <class T> std::vector<double> numbers(const Configuration<T>& c) {
  std::vector<double> all{to_double(c.time)};
  for (const auto place : {c.from, c.to, ParticleIndex(c.collided_from), ParticleIndex(c.collided_to)})
    all.push_back(double(place));
  for (const ParticleIndex particle : c.index) all.push_back(double(particle));
  for (const auto* list : {&c.x, &c.v, &c.m, &c.gap, &c.closing_speed}) {
    all.push_back(double(list->size()));
    for (const T& x : *list) all.push_back(to_double(x));
  }
  for (const auto* error : {&c.closure_gap, &c.closure_speed}) all.push_back(*error ? to_double(**error) : INFINITY);
  return all;
}

template <class T> Inelastic<T> law() { return Inelastic<T>(number<T>(0.9), number<T>(1e-3)); }

// make(T) gives the same run in the scalar T.
template <class Make> void expect_the_bits_of_double(Make make, const std::vector<double>& times) {
  auto strict = make(StrictReal(0));
  auto plain = make(0.);
  for (const double t : times) {
    SCOPED_TRACE(t);
    const Status status = plain.advance(t);
    ASSERT_EQ(strict.advance(number<StrictReal>(t)), status);
    ASSERT_TRUE(same_collisions(strict.counts(), plain.counts()));
    ASSERT_EQ(strict.counts().origin_moves, plain.counts().origin_moves);
    ASSERT_EQ(numbers(configuration_at(strict, number<StrictReal>(t))), numbers(configuration_at(plain, t)));
    // In double the ledger is compensated, in unknown types it is a plain sum of positive terms.
    ASSERT_NEAR(to_double(strict.energy_lost()), plain.energy_lost(),
                static_cast<double>(plain.counts().collisions) * std::numeric_limits<double>::epsilon() *
                    plain.energy_lost());
  }
}

TEST(StrictScalar, GapsOfIdenticalParticles) {
  expect_the_bits_of_double([]<class T>(T) { return gap_run(rshock<T>(200), law<T>()); }, {.5, 20, 50, 62, 70, 100});
  expect_the_bits_of_double([]<class T>(T) { return gap_run(rmix<T>(100), law<T>()); }, {1, 10, 100, 1000});
}

TEST(StrictScalar, GapsOfUnequalMasses) {
  expect_the_bits_of_double([]<class T>(T) { return mass_run(unequal_rows<T>(), law<T>()); }, {.5, 20, 50});
}

TEST(StrictScalar, Positions) {
  expect_the_bits_of_double([]<class T>(T) { return position_run(unequal_rows<T>(), law<T>()); }, {.5, 20, 50});
}

TEST(StrictScalar, ClustersOfWetAndStickyParticles) {
  expect_the_bits_of_double(
      []<class T>(T) { return Simulation(Wet<T>(number<T>(0.01)), ClusterChain<T>(rshock<T>(200), T(0))); },
      {.5, 20, 55, 100});
  expect_the_bits_of_double(
      []<class T>(T) { return Simulation(Sticky<T>(), ClusterChain<T>(unequal_rows<T>(), T(0))); }, {.5, 20, 50});
  expect_the_bits_of_double(
      []<class T>(T) {
        return Simulation(InelasticMerging<T>(law<T>(), number<T>(1e-2)), ClusterChain<T>(rmix<T>(100), T(0)));
      },
      {1, 10, 100});
}

TEST(StrictScalar, GasesWithoutEvents) {
  expect_bits_of_double([]<class T>(const T& zero) {
    std::vector<double> all;
    const auto ring = std::make_shared<Ring<T>>(60, T(60), T(1), gaussian_velocity(2, 0), still);
    for (const int t : {0, 1, 7, 50, 1000})
      for (const Scene<T>& particles : {rmix<T>(100), rshock<T>(100), Scene<T>(ring)}) {
        StickyGas<T> gas(particles, zero);
        gas.advance(T(t) / T(2));
        gas.advance(T(t));
        const auto found = numbers(gas.configuration(T(t)));
        all.insert(all.end(), found.begin(), found.end());
        // The ledger is compensated for built-in types only.
        all.push_back(static_cast<double>(gas.counts().merges));
      }
    return all;
  });
}

TEST(StrictScalar, CollapsePolicies) {
  expect_bits_of_double([]<class T>(T zero) {
    auto run = gap_run<T>(three_particles<T>(), Inelastic<T>(number<T>(0.05)), {CollapsePolicy::stop, zero, {}});
    EXPECT_EQ(run.advance(T(100)), Status::collapsed);
    return std::pair(to_double(run.collapse().time.value()), run.counts().collisions);
  });
}

// ---- observers

TEST(StrictScalar, Observers) {
  expect_bits_of_double([]<class T>(T zero) {
    const auto particles = rshock<T>(100);
    auto run = gap_run(particles, law<T>());
    std::vector<double> seen;
    run.advance(T(20), [&](const Collision<T>& c) {
      seen.push_back(to_double(c.interval));
      seen.push_back(to_double(c.closing_speed));
    });
    const auto c = configuration_at(run, T(20));
    const auto s = sample(run, particles->kinetic_energy(), T(20));
    const auto p = profile(c, *particles, T(20), {-20, 20}, 10);
    TaggedParticles<T> tagged(*particles, 1);
    tagged.find(c, T(20));
    for (const auto& values : {p.density, p.velocity, p.temperature, tagged.displacement(), tagged.velocity()})
      seen.insert(seen.end(), values.begin(), values.end());
    for (const T& value : {*s.front_left, *s.front_right, gap_statistics(c).least, gap_statistics(c).median,
                           kinetic_energy(c, *particles), momentum_gained(c, *particles), zero})
      seen.push_back(to_double(value));
    return seen;
  });
}

// Nor do they require what rationals lack.
TEST(StrictScalar, ObserversTakeRationals) {
  const auto particles = rmix<Rational>(12);
  auto run = gap_run(particles, Inelastic<Rational>(Rational(15, 16)));
  run.advance(Rational(10));
  const auto state = configuration_at(run, Rational(10));
  EXPECT_EQ(sample(run, particles->kinetic_energy(), Rational(10)).energy, kinetic_energy(state, *particles));
  EXPECT_GT(gap_statistics(state).median, 0);
  const Profile p = profile(state, *particles, Rational(10), {-100, 100}, 1);
  EXPECT_EQ(p.density[0] * 200, 12);
}

// ---- theories

using namespace theory;

template <class... T> std::vector<double> as_doubles(const T&... numbers) { return {to_double(numbers)...}; }

TEST(TheoriesInAStrictScalar, OfInelasticShocksAndCollapse) {
  expect_bits_of_double([]<class T>(const T& zero) {
    const InelasticShock<T> shock{T(999) / T(1000), T(1) / T(2), T(1), T(1), 8000};
    const T t(700), place(3), one(1), small = T(1) / T(20);
    FrontRecursion<T> recursion(shock);
    recursion.advance();
    return as_doubles(front_position(shock, t), front_velocity(shock, t), *turnover_time(shock), *maximal_front(shock),
                      turnover_collision(shock)->position, front_position_discrete(shock, t),
                      interaction_density(shock, t), left_mover_density(shock, place, t),
                      left_mover_velocity(shock, place, t), mean_velocity(shock, place, t),
                      mean_velocity_slope(shock, t), mean_velocity_slope_early(shock), energy(shock, t),
                      sticky_energy(shock, t), *collapse_onset_time(shock), recursion.now().position,
                      *collapse_time(small, checkerboard_coupling(small, 5), zero, one, one, one), collapse_limit<T>(6),
                      collapse_limit<T>(7));
  });
  EXPECT_GT(collapse_limit<double>(7), collapse_limit<double>(6));
}

TEST(TheoriesInAStrictScalar, OfWetShocks) {
  expect_bits_of_double([]<class T>(const T& zero) {
    const WetShock<T> shock{.loss = T(1) / T(100), .particles = 40};
    const T t(30);
    const WetFront<T> front(shock);
    const WetZone<T> zone(shock);
    auto numbers =
        as_doubles(critical_closing_speed_printed(shock.loss, T(1), T(2)), turnover_collision(shock)->time,
                   *front_recursion_at(shock, t).position_at(t), front.turnover()->position, front.at_time(t)->velocity,
                   front.sticking()->collisions, energy(shock, t), half_width_from_energy(shock, T(2)),
                   collisions_to_rest(shock), zone_speed_lost(shock), zone.width(), zone.force(T(3) / T(10)),
                   zone.force_printed(T(7)), zone.right_mover_force(zero), zone.inner_force(T(9)));
    cross_rows(shock, t, [&](const T& time, int) { numbers.push_back(to_double(time)); });
    return numbers;
  });
}

TEST(TheoriesInAStrictScalar, OfStickyShocks) {
  expect_bits_of_double([]<class T>(const T& zero) {
    const StickyShock<T> shock{T(2), T(1), T(3), zero, T(5), T(1) / T(4)};
    const auto centre = sticky_centre(shock, T(17));
    return as_doubles(centre.mass, centre.position, centre.velocity, centre.from_left, centre.from_right,
                      centre.energy_lost, late_growth(shock), late_velocity(shock), late_power(shock));
  });
}

}  // namespace cradle::test::strict_scalar_test
