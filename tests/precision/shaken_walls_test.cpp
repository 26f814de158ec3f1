// Shaken walls in every scalar type: pi, sine and cosine; whole numbers of any size; the search for a collision ends; a
// column, in all types the same collisions. When gaps to them close: wall_gaps_test.cpp.
#include "cradle/core/initial/walled.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::shaken_walls_in_types_test {

PRECISION_SUITE(ShakenIn, EveryPrecision);

// sin^2 + cos^2 = 1, sin(4 y) from sin(y), and the values at quarters and twelfths of a turn: to 8 epsilon.
PRECISION_TEST(ShakenIn, SineAndCosineHaveTheirDigits) {
  const T epsilon = std::numeric_limits<T>::epsilon(), most = T(8) * epsilon;
  const Circle<T> circle;
  for (int k = -40; k < 40; ++k) {
    const T y = T(k) / T(37);
    const auto [c, s] = circle.at_turns(y);
    EXPECT_LE(magnitude(T(s * s + c * c - T(1))), most);
    EXPECT_LE(magnitude(T(circle.at_turns(T(y + y)).sin - T(2) * s * c)), most);
    const T z = circle.full_turn().value() * (T(k) / T(320));  // |z| <= pi/4
    const auto beyond = circle.beyond_linear(z);
    EXPECT_LE(magnitude(T(circle.at_turns(T(T(k) / T(320))).sin - (z + beyond.sin))), most);
    EXPECT_LE(magnitude(T(circle.at_turns(T(T(k) / T(320))).cos - (T(1) + beyond.cos))), most);
  }
  EXPECT_EQ(circle.at_turns(T(T(5) / T(4))).sin, T(1));
  EXPECT_LE(magnitude(T(circle.at_turns(T(T(1) / T(12))).sin - T(1) / T(2))), most);
  EXPECT_LE(magnitude(T(circle.at_turns(T(T(1) / T(8))).sin * circle.at_turns(T(T(1) / T(8))).cos - T(1) / T(2))),
            most);
}

// Whole numbers of turns of any size, as long as the type has digits behind the point.
PRECISION_TEST(ShakenIn, WholeNumbersOfAnySizeAreExact) {
  const T epsilon = std::numeric_limits<T>::epsilon();
  T whole(1);
  for (int k = 0; k < 1000 && whole * epsilon < T(1) / T(16); ++k, whole += whole + T(k % 2))
    for (const int eighths : {-4, -3, -1, 0, 1, 3}) {
      ASSERT_EQ(nearest_whole(T(whole + T(eighths) / T(8))), whole) << k << ' ' << eighths;
      ASSERT_EQ(nearest_whole(T(T(eighths) / T(8) - whole)), -whole) << k << ' ' << eighths;
    }
}

// The phases that follow a time are those of the later times, to the bit, after few and after very many turns.
PRECISION_TEST(ShakenIn, PhasesThatFollowATimeAreThoseOfLaterTimes) {
  constexpr int motions = std::same_as<T, double> ? 3000 : std::floating_point<T> ? 30 : 2;  // no shorter way in others
  std::uint64_t state = 11;
  const auto draw = [&] { return static_cast<double>((state = splitmix64(state)) >> 11) * 0x1p-53; };
  for (int k = 0; k < motions; ++k) {
    const WallMotion<T> motion(Shape::sine, T(1), exactly<T>(std::exp2(8 * draw() - 4)), exactly<T>(8 * draw() - 4));
    const T time = exactly<T>(std::exp2((k % 10 == 0 ? 90 : 44) * draw() - 4)) / T(3);
    const Pair<T> since = two_sum(time, T(T(std::numeric_limits<T>::epsilon()) * time * exactly<T>(draw()) / T(4)));
    const typename WallMotion<T>::Following phases(motion, since, motion.turns_at(since));
    for (int j = 0; j < 100; ++j) {
      const T wait = exactly<T>(std::exp2(60 * draw() - 55)) / T(7);
      ASSERT_EQ(phases.rest(wait), motion.at(since + wait).rest) << k << ' ' << j;
    }
  }
}

PRECISION_SUITE(ShakenColumnIn, EachKindOfPrecision);

// A particle that approaches the place of the wall as slowly as the type can tell, or is pulled there as weakly,
// collides about when it arrives there; the search ends at any time since the start and any size of the numbers.
PRECISION_TEST(ShakenColumnIn, TheSearchForACollisionEnds) {
  const T epsilon = std::numeric_limits<T>::epsilon();
  T root = T(3) / T(4);  // whose 20th power is epsilon, about
  while (std::pow(to_double(root), 20) > to_double(epsilon) && to_double(root) > 1e-15) root *= T(3) / T(4);
  for (const Shape shape : {Shape::sawtooth, Shape::parabola, Shape::sine})
    for (const int phase : {-3, 1}) {
      const WallMotion<T> motion(shape, T(1) / T(2), T(5) / T(4), T(phase));
      T u(1);
      for (int k = 0; k < 25; ++k, u *= root)
        for (const T& since : {T(0), T(T(1) / u)}) {
          const WallMoment<T> now = motion.moment({since, T(0)});
          const T distance = T(11) / T(3), gap = distance - now.wall.place;
          const auto meeting = [&](const T& closing, const T& pull) {
            return ShakenApproach<T>(gap, T(now.wall.speed + closing), pull, splitter<T>(), motion, now).meeting();
          };
          const auto met = meeting(u, T(0));
          if (u > T(1 << 20) * epsilon && since * epsilon < u) {
            ASSERT_TRUE(met);
            const T reach = motion.amplitude() + u * motion.period() + T(1) / T(1 << 10);
            ASSERT_LE(magnitude(T(met->in * u - distance)), reach) << static_cast<int>(shape) << ' ' << k;
          }
          for (const T& v : {u, T(0), T(-u)})
            for (const T& pull : {T(u * u), u, T(-u), T(-u * u)}) meeting(v, pull);
        }
    }
}

// All types make the same collisions of a column on a floor at rest and on one of each shape, of which particles may
// come to rest on it, and keep the account of the energy to their digits. A collision or a flight rounds a few numbers
// by u of the largest speed or height: on a floor at rest the energy is off by 64 epsilon of it for each at most.
PRECISION_TEST(ShakenIn, AColumnHasTheSameCollisions) {
  constexpr std::optional<Shape> floors[] = {{}, Shape::sawtooth, Shape::parabola, Shape::sine};
  for (const std::optional<Shape>& shape : floors)
    for (const bool rests : {false, true}) {
      const auto column = [&]<class S>(std::type_identity<S>) {
        Wall<S> floor{S(-1)};
        if (rests) floor.restitution = S(1) / S(4), floor.rest_speed = S(1) / S(8);
        if (shape) floor.motion = std::make_shared<WallMotion<S>>(*shape, S(1) / S(4), S(3), S(1) / S(2));
        return std::make_shared<Walled<S>>(rmix<S>(8), floor, std::nullopt, S(S(-3) / S(8)));
      };
      const std::shared_ptr<const Walled<T>> particles = column(std::type_identity<T>{});
      const T until(6);
      auto run = mass_run<T>(particles, Inelastic<T>(rests ? T(T(3) / T(4)) : T(1)));
      auto twin = mass_run<double>(column(std::type_identity<double>{}), Inelastic<double>(rests ? 0.75 : 1));
      const Sequence found = sequence_to(run, until);
      EXPECT_EQ(found, sequence_to(twin, 6.));
      EXPECT_GT(run.counts().collisions, 20U);

      const auto now = sample(run, particles->kinetic_energy(), until);
      const auto c = configuration_at(run, until);
      const T potential = potential_energy(c, *particles, until);
      const T off = now.energy + potential - (particles->mechanical_energy() - now.energy_lost + now.given);
      const T scale = shape || rests ? T(T(4) * (now.energy + magnitude(potential)))
                                     : T(particles->mechanical_energy() + particles->energy_of_fall());
      EXPECT_LE(magnitude(off), T(64 * static_cast<std::int64_t>(run.counts().collisions)) *
                                    T(std::numeric_limits<T>::epsilon()) * scale);
      const auto d = configuration_at(twin, 6.);
      for (std::size_t j = 0; j < d.x.size(); ++j) EXPECT_NEAR(to_double(c.x[j]), d.x[j], 1e-12);
      if (shape || rests) continue;
      auto places = position_run<T>(particles, Inelastic<T>(T(1)));
      EXPECT_EQ(found, sequence_to(places, until));
    }
}

}  // namespace cradle::test::shaken_walls_in_types_test
