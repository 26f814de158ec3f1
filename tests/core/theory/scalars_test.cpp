// The theories over scalars. Proves: that nothing in them assumes a built-in scalar, since a strict type without
// conversions to or from double goes through everything with the bits of the type it wraps; and that the built-in ones
// are as precise as they can be.
#include <gtest/gtest.h>

#include <limits>

#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/core/theory/sticky_shock.hpp"
#include "cradle/core/theory/wet_energy.hpp"
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/strict_real.hpp"

namespace cradle::test::theory_scalars_test {

using namespace cradle::theory;

template <class... T> std::vector<double> as_doubles(const T&... numbers) { return {to_double(numbers)...}; }

// `numbers` computes in the type of its argument, which is 0.
template <class Numbers> void expect_bits_of_double(const Numbers& numbers) {
  EXPECT_EQ(numbers(StrictReal(0)), numbers(0.));
}

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

TEST(TheoriesInAStrictScalar, OfStickyShocksAndGases) {
  expect_bits_of_double([]<class T>(const T& zero) {
    const StickyShock<T> shock{T(2), T(1), T(3), zero, T(5), T(1) / T(4)};
    const auto centre = sticky_centre(shock, T(17));
    auto numbers = as_doubles(centre.mass, centre.position, centre.velocity, centre.from_left, centre.from_right,
                              centre.energy_lost, late_growth(shock), late_velocity(shock), late_power(shock));
    const auto ring = std::make_shared<Ring<T>>(60, T(60), T(1), gaussian_velocity(2, 0), still);
    for (const int t : {0, 1, 7, 50, 1000})
      for (const test::Scene<T>& particles : {test::rmix<T>(100), test::rshock<T>(100), test::Scene<T>(ring)}) {
        StickyGas<T> gas(particles, zero);
        gas.advance(T(t) / T(2));
        gas.advance(T(t));
        const auto c = gas.configuration(T(t));
        for (const auto* found : {&c.x, &c.v, &c.m, &c.gap, &c.closing_speed})
          for (const T& number : *found) numbers.push_back(to_double(number));
        // The ledger is compensated for built-in types only.
        numbers.push_back(static_cast<double>(gas.counts().merges));
      }
    return numbers;
  });
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
  expect_close(collapse_limit<T>(3), collapse_limit<Wide>(3), few, "7 - 4 sqrt 3");
}

}  // namespace cradle::test::theory_scalars_test
