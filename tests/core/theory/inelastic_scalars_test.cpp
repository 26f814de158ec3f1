// The theories of the inelastic shock and of the collapse, over scalars.
// Proves: that nothing in them assumes a built-in scalar, since a strict type without conversions to or from double
// goes through everything with the bits of the type it wraps; and that the built-in ones are as precise as they can be.
#include <gtest/gtest.h>

#include <limits>

#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/tests/core/digits.hpp"

namespace inelastic_scalars_test {

using namespace cradle::theory;
using namespace cradle::test;

// Identities evaluated in Wide: a few hundred roundings of 2^-168, some after factors of up to 1e4.
const Wide tiny = pow(Wide(10), -44);

/// Arithmetic of Wide, an int to build one, ADL maths, and nothing else.
class Strict {
 public:
  explicit Strict(int value) : value_(value) {}
  explicit Strict(const Wide& value) : value_(value) {}
  const Wide& wide() const { return value_; }

  friend Strict operator+(const Strict& a, const Strict& b) { return Strict(Wide(a.value_ + b.value_)); }
  friend Strict operator-(const Strict& a, const Strict& b) { return Strict(Wide(a.value_ - b.value_)); }
  friend Strict operator*(const Strict& a, const Strict& b) { return Strict(Wide(a.value_ * b.value_)); }
  friend Strict operator/(const Strict& a, const Strict& b) { return Strict(Wide(a.value_ / b.value_)); }
  friend Strict operator-(const Strict& a) { return Strict(Wide(-a.value_)); }
  friend bool operator<(const Strict& a, const Strict& b) { return a.value_ < b.value_; }
  friend bool operator>(const Strict& a, const Strict& b) { return b < a; }
  friend bool operator==(const Strict& a, const Strict& b) { return a.value_ == b.value_; }
  friend Strict sqrt(const Strict& a) { return Strict(Wide(sqrt(a.value_))); }
  friend Strict log(const Strict& a) { return Strict(Wide(log(a.value_))); }
  friend Strict atan(const Strict& a) { return Strict(Wide(atan(a.value_))); }
  friend Strict cos(const Strict& a) { return Strict(Wide(cos(a.value_))); }

 private:
  Wide value_;
};

TEST(TheoryScalars, StrictTypeGivesTheBitsOfTheTypeItWraps) {
  const Strict eps = Strict(999) / Strict(1000);
  const Strict t(700);
  InelasticShock<Strict> strict{eps, Strict(1) / Strict(2), Strict(1), Strict(1), 8000};
  const InelasticShock<Wide> wide{.restitution = Wide(Wide(999) / 1000), .particles = 8000};
  const Wide wide_t(700);
  EXPECT_EQ(front_position(strict, t).wide(), front_position(wide, wide_t));
  EXPECT_EQ(front_velocity(strict, t).wide(), front_velocity(wide, wide_t));
  EXPECT_EQ(turnover_time(strict)->wide(), *turnover_time(wide));
  EXPECT_EQ(maximal_front(strict)->wide(), *maximal_front(wide));
  EXPECT_EQ(turnover_collision(strict)->position.wide(), turnover_collision(wide)->position);
  EXPECT_EQ(front_position_discrete(strict, t).wide(), front_position_discrete(wide, wide_t));
  EXPECT_EQ(interaction_density(strict, t).wide(), interaction_density(wide, wide_t));
  EXPECT_EQ(left_mover_density(strict, Strict(3), t).wide(), left_mover_density(wide, Wide(3), wide_t));
  EXPECT_EQ(left_mover_velocity(strict, Strict(3), t).wide(), left_mover_velocity(wide, Wide(3), wide_t));
  EXPECT_EQ(mean_velocity(strict, Strict(3), t).wide(), mean_velocity(wide, Wide(3), wide_t));
  EXPECT_EQ(mean_velocity_slope_early(strict).wide(), mean_velocity_slope_early(wide));
  EXPECT_EQ(energy(strict, t).wide(), energy(wide, wide_t));
  EXPECT_EQ(sticky_energy(strict, t).wide(), sticky_energy(wide, wide_t));
  EXPECT_EQ(collapse_onset_time(strict)->wide(), *collapse_onset_time(wide));
  FrontRecursion<Strict> recursion(strict);
  recursion.advance();
  EXPECT_LE(abs(recursion.now().position.wide()), tiny);
  const Strict small = Strict(1) / Strict(20);
  const auto time = three_particle_collapse_time(small, Strict(1), Strict(1), Strict(2), Strict(1));
  expect_close(time->wide(), Wide(Wide(12) / 7), tiny, "three particles");
  CollapseSequence<Strict> sequence(small, checkerboard_coupling(small, 5), Strict(0), Strict(1), Strict(1), Strict(1));
  EXPECT_TRUE(sequence.advance());
  EXPECT_TRUE(collapse_limit<Strict>(7) > collapse_limit<Strict>(6));
}

template <class T> class BuiltIn : public testing::Test {};
using BuiltInTypes = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(BuiltIn, BuiltInTypes);

TYPED_TEST(BuiltIn, AgreesWithWideToItsOwnPrecision) {
  using T = TypeParam;
  const T eps = T(999) / T(1000);
  const InelasticShock<T> shock{.restitution = eps, .particles = 8000};
  const InelasticShock<Wide> wide{.restitution = Wide(eps), .particles = 8000};
  const Wide few = 30 * Wide(std::numeric_limits<T>::epsilon());
  expect_close(*maximal_front(shock), *maximal_front(wide), few, "x_max");
  expect_close(front_displacement(shock, T(700)), front_displacement(wide, Wide(700)), few, "(5)");
  expect_close(energy(shock, T(700)), energy(wide, Wide(700)), few, "(7)");
  expect_close(*collapse_onset_time(shock), *collapse_onset_time(wide), few, "onset");
  expect_close(three_particle_collapse_limit<T>(), three_particle_collapse_limit<Wide>(), few, "7 - 4 sqrt 3");
}

}  // namespace inelastic_scalars_test
