// Random initial states in every scalar type: each starts from the numbers that double starts from, up to rounding, and
// gaps are as precise as the type, however far from the origin they are.
#include "cradle/core/initial/cold.hpp"
#include "cradle/core/initial/gas.hpp"
#include "cradle/core/initial/poisson.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::random_states_test {

constexpr ParticleIndex count = 301;

template <class T> std::vector<std::shared_ptr<const Particles<T>>> states() {
  const MassPattern<T> masses(T(T(1) / T(3)), T(T(10) / T(3)), count, 6, 2);
  const auto middle = [](ParticleIndex p) { return 2 * (p - 150); };
  const Displacement places = uniform_places(count, 6, 2),
                     outwards = poisson_displacement(count, 150, true, middle, 6, 2);
  const auto around = [](ParticleIndex p) { return 2 * (p - 150) + (p < 150 ? 1 : -1); };
  const VelocityDraw velocity = gaussian_velocity(6, 2);
  const T third = T(1) / T(3), length = T(1000) / T(7);
  const auto cold = [&](double falls) {
    return std::make_shared<Cold<T>>(count, third, HotPlace::middle, kicked(ParticleIndex{150}, third), outwards,
                                     masses, falls);
  };
  return {std::make_shared<cradle::Gas<T>>(count, T(-third), length, third, velocity, places, masses),
          std::make_shared<Ring<T>>(count, length, third, velocity, places, masses),
          std::make_shared<Rows<T>>(Row<T>{150, third, third}, Row<T>{150, T(-third), T(T(1) / T(7))},
                                    CentralParticle<T>{third, T(0)},
                                    poisson_displacement(count, 150, true, around, 6, 2), masses),
          cold(0),
          cold(0.6),
          cold(-0.5)};
}

PRECISION_SUITE(RandomStates, EveryPrecision);

PRECISION_TEST(RandomStates, AreThoseOfDoubleUpToRounding) {
  const auto exact = states<T>();
  const auto rounded = states<double>();
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const auto near = [&](const T& x, double y, double size) {
      // A unit, a product, an end; in Cold also a difference.
      EXPECT_LE(std::abs(to_double(T(x - exactly<T>(y)))), 4 * 0x1p-52 * size) << k << ": " << y;
    };
    for (ParticleIndex p = 0; p < count; ++p) {
      near(exact[k]->position(p), rounded[k]->position(p), std::abs(rounded[k]->position(p)) + 1);
      near(exact[k]->mass(p), rounded[k]->mass(p), 10. / 3);
      if (p + 1 == count && !exact[k]->on_ring()) continue;
      near(exact[k]->gap(p), rounded[k]->gap(p), rounded[k]->gap(p));
      ASSERT_TRUE(is_positive(exact[k]->gap(p)));
    }
    near(exact[k]->total_mass(), rounded[k]->total_mass(), rounded[k]->total_mass());
    // Sums of `count` products, each with some roundings.
    near(exact[k]->kinetic_energy(), rounded[k]->kinetic_energy(), 4 * rounded[k]->kinetic_energy());
  }
}

}  // namespace cradle::test::random_states_test
