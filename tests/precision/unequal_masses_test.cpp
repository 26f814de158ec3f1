// Masses from 1e-8 to 1e8 beside each other. Proves: runs of 2000 random systems (lines, rings, walls, every law that
// bounces, gravity, shaken walls) make the collisions of 70 digits unless they warn that rounding may have decided one,
// and state how far their energy is off; guards are silent on all of them, and find an error of 1e-6 planted into any;
// closed forms (the digits of pi) are right up to a ratio of 1e12, or 1e14 in the slow test.
#include <cstdio>
#include <random>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/initial/list.hpp"
#include "cradle/core/initial/walled.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::unequal_masses_test {

enum class Bounce { elastic, cutoff, speed_dependent, contact_time };

// All numbers are doubles, so that every type has the same system.
struct System {
  std::vector<double> x, v, m;
  double circumference = 0;
  bool left_wall = false, right_wall = false;
  double wall_restitution = 1, restitution = 1, cutoff = 0, until = 1;
  Bounce law = Bounce::elastic;
  double acceleration = 0, rest_speed = 0;  // of the wall at which particles may rest: the left one
  std::optional<Shape> shaken = {};         // so is the left wall
  double amplitude = 0, frequency = 1;
};

class Drawing {
 public:
  explicit Drawing(std::uint64_t seed) : bits_(seed) {}
  double from_to(double from, double to) {
    return from + (to - from) * std::ldexp(static_cast<double>(bits_() >> 33), -31);
  }
  std::size_t below(std::size_t end) { return bits_() % end; }
  System operator()(double decades, double longest) {
    System s;
    double x = 0;
    for (std::size_t n = 2 + below(8); n > 0; --n) {
      s.x.push_back(x += std::ldexp(std::round(std::ldexp(from_to(0.01, 2), 20)), -20));
      s.m.push_back(std::pow(10., from_to(-decades, decades)));
      s.v.push_back(from_to(-1, 1) / (below(2) == 0 ? 1 : std::sqrt(s.m.back())));  // or of like energies
    }
    if (below(3) == 0)
      s.circumference = x + 1;
    else
      s.left_wall = below(2) == 0, s.right_wall = below(2) == 0;
    s.wall_restitution = below(2) == 0 ? 1 : from_to(0.5, 1);
    s.law = static_cast<Bounce>(below(4));
    s.restitution = s.law == Bounce::elastic ? 1 : from_to(0.05, 1);
    s.cutoff = std::pow(10., s.law == Bounce::contact_time ? from_to(-6, -2) : from_to(-4, 0));
    s.until = std::pow(10., from_to(-1, longest));
    return s;
  }
  // Particles that fall on a wall, from one, or between two, which may be shaken; some may come to rest.
  System falling(double decades, double longest, bool shaken) {
    System s = (*this)(decades, longest);
    s.circumference = 0;
    s.acceleration = below(8) == 0 ? 0 : from_to(0.1, 2) * (below(3) == 0 ? 1 : -1);
    s.left_wall = shaken || s.acceleration < 0 || below(2) == 0, s.right_wall = s.acceleration >= 0 || below(2) == 0;
    if (s.law == Bounce::elastic && below(2) == 0) s.law = Bounce::cutoff, s.restitution = from_to(0.3, 1);
    if (below(3) == 0 && s.left_wall && (shaken || s.acceleration < 0)) s.rest_speed = std::pow(10., from_to(-4, -1));
    if (!shaken) return s;
    s.shaken = static_cast<Shape>(below(3));
    s.amplitude = from_to(0.01, 0.9), s.frequency = from_to(0.5, 10);
    return s;
  }

 private:
  std::mt19937_64 bits_;
};

template <class T> std::shared_ptr<const Particles<T>> particles_of(const System& s) {
  auto list = std::make_shared<List<T>>(numbers<T>(s.x), numbers<T>(s.v), numbers<T>(s.m), exactly<T>(s.circumference));
  if (!s.left_wall && !s.right_wall) return list;
  const auto wall = [&](bool there, double position) -> std::optional<Wall<T>> {
    if (!there) return {};
    return Wall<T>{exactly<T>(position), T(0), exactly<T>(s.wall_restitution)};
  };
  auto left = wall(s.left_wall, -1);
  if (left) left->rest_speed = exactly<T>(s.rest_speed);
  if (left && s.shaken)
    left->motion =
        std::make_shared<WallMotion<T>>(*s.shaken, exactly<T>(s.amplitude), exactly<T>(s.frequency), exactly<T>(0.));
  return std::make_shared<Walled<T>>(list, left, wall(s.right_wall, s.x.back() + 1), exactly<T>(s.acceleration));
}

// f(law) with the law of the system.
template <class T, class F> auto with_law(const System& s, F f) {
  const T restitution = exactly<T>(s.restitution), cutoff = exactly<T>(s.cutoff);
  if (s.law == Bounce::speed_dependent) return f(SpeedDependent<T>(restitution, cutoff, T(2)));
  if (s.law == Bounce::contact_time) return f(ContactTime<T>(Inelastic<T>(restitution), cutoff));
  return f(Inelastic<T>(restitution, s.law == Bounce::elastic ? T(0) : cutoff));
}

struct Made {
  Status status = Status::reached;
  std::uint64_t collisions = 0;
  bool warned = false, broken = false;
  std::array<double, 3> guard{};
  int missed = 0;  // planted errors that no guard has found
  double energy = 0, energy_off = 0;
};

// Ends after so many collisions.
template <class Chain> Made make(const System& s, std::uint64_t most) {
  using T = typename Chain::Scalar;
  const auto particles = particles_of<T>(s);
  return with_law<T>(s, [&](const auto& law) {
    bool enough = false;
    Policy<T> policy;
    policy.progress = [&](const T&, const Counts& counts) { enough = counts.collisions > most; };
    policy.interrupt = [&] { return enough; };
    Simulation run(law, Chain(particles, T(0)), policy);
    Made made;
    made.status = run.advance(exactly<T>(s.until));
    made.collisions = run.counts().collisions;
    const T end = made.status == Status::reached ? exactly<T>(s.until) : run.last_collision_time();
    const Account<T>& account = run.account();
    made.warned = account.uncertain + account.order_lost + account.simultaneous > 0;
    if constexpr (requires { run.chain().uncertain_at(end); })
      made.warned = made.warned || run.chain().uncertain_at(run.chain().local_time(end));
    made.energy = to_double(run.kinetic_energy(end));
    if constexpr (requires { run.chain().energy_deviation(end); })
      made.energy_off = to_double(run.chain().energy_deviation(run.chain().local_time(end)));
    const T energy = particles->kinetic_energy() - run.energy_lost();
    const auto broken = [&](const Configuration<T>& c, const T& left) {
      const auto checked =
          guarded(c, *particles, made.collisions, left, end, run.last_collision_time(), T(0), account.order_lost == 0);
      if (checked.broken)
        made.guard = {static_cast<double>(checked.broken->guard), to_double(checked.broken->found),
                      to_double(checked.broken->bound)};
      return checked.broken.has_value();
    };
    const Configuration<T> now = run.configuration(end);
    made.broken = broken(now, energy);
    // A part in a million of the energy at the start, in the ledger and in the fastest of the particles that have any;
    // of the largest speed, in what closing speeds add up to.
    const T part = T(1) / T(1000000), at_start = particles->kinetic_energy();
    made.missed += !broken(now, T(energy + part * at_start));
    T fastest(0);
    for (std::size_t j = 0; j < now.m.size(); ++j) {
      const T before = particles->velocity(now.index[j]), twice = now.m[j] * now.v[j] * now.v[j];
      for (const T& v : {before, now.v[j]})
        if (fastest < magnitude(v)) fastest = magnitude(v);
      if (twice * T(1000) < at_start) continue;
      Configuration<T> faster = now;
      faster.v[j] += part * at_start / (now.m[j] * now.v[j]);
      made.missed += !broken(faster, energy);
    }
    if (now.closure_speed) {
      Configuration<T> open = now;
      open.closure_speed = *now.closure_speed + part * fastest;
      made.missed += !broken(open, energy);
    }
    return made;
  });
}

template <class T> using Watching = GapChain<T, WatchedMasses<T>>;

// The energy is off by what is said, but for the rounding of the sum and the margin of an estimate. (A sum of closing
// speeds has no digits of particles that are far heavier than others.)
template <class T> void expect_energy(const System& s, const Made& made, const Made& right) {
  if (!std::is_same_v<T, double> || far_apart(*particles_of<T>(s))) return;
  EXPECT_LE(std::abs(made.energy - right.energy), 64 * (made.energy_off + 1e-15 * right.energy));
}

#ifdef CRADLE_WITH_MPFR
// Returns how many are warned of.
template <template <class> class Chain, class T, bool falls = false>
int expect_right_or_warned(std::uint64_t seed, int systems, double decades, double longest, bool shaken = false) {
  using Wide = std::conditional_t<falls, Mpfr<8>, Mpfr<4>>;
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(falls ? 100 : 70));
  constexpr std::uint64_t most = falls ? 3000 : 20000;
  Drawing draw(seed);
  int compared = 0, warned = 0;
  for (int k = 0; k < systems; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", system " << k);
    const System s = falls ? draw.falling(decades, longest, shaken) : draw(decades, longest);
    if (falls && far_apart(*particles_of<double>(s))) continue;
    const Made right = make<Chain<Wide>>(s, most), made = make<Chain<T>>(s, most);
    if (!falls) {  // guards know no gravity
      EXPECT_FALSE(made.broken) << "guard " << made.guard[0] << ", found " << made.guard[1] << ", bound "
                                << made.guard[2];
      EXPECT_EQ(made.missed, 0);
    }
    if (right.status != Status::reached || right.warned || made.status != Status::reached)
      continue;  // collapse, too many collisions, or too few digits
    ++compared;
    warned += made.warned;
    if (made.warned) continue;
    EXPECT_EQ(made.collisions, right.collisions);
    expect_energy<T>(s, made, right);
  }
  EXPECT_GT(compared, systems / (falls ? 3 : 2));
  std::printf("%d systems, seed %d: %d compared, %d of them warned of\n", systems, static_cast<int>(seed), compared,
              warned);
  return warned;
}

TEST(UnequalMasses, AreRightOrWarnedOf) {
  expect_right_or_warned<Watching, double>(1, 150, 8, 1.5);
  // So long that some collapse far below the rounding of their times, and recover.
  EXPECT_GT((expect_right_or_warned<Watching, double>(2, 150, 2, 3)), 0);
}
TEST(UnequalMasses, AreRightOrWarnedOfInWiderTypes) {
  expect_right_or_warned<Watching, long double>(3, 60, 8, 1.5);
  expect_right_or_warned<Watching, double_double>(4, 60, 8, 2);
}
TEST(UnequalMasses, FallRightOrWarnedOf) {
  expect_right_or_warned<Watching, double, true>(21, 100, 1.5, 2);
  expect_right_or_warned<Watching, double_double, true>(22, 30, 1.5, 2);
  expect_right_or_warned<Watching, double, true>(27, 100, 0, 2.5);  // identical masses
}
TEST(UnequalMasses, AtShakenWallsAreRightOrWarnedOf) {
  expect_right_or_warned<Watching, double, true>(23, 40, 1.5, 2, true);
  expect_right_or_warned<Watching, double, true>(28, 30, 0, 2, true);
}
TEST(SlowUnequalMasses, FallRightOrWarnedOf) {
  expect_right_or_warned<Watching, double, true>(24, 100, 1.5, 2.3);
  expect_right_or_warned<Watching, double, true>(25, 25, 1.5, 2.3, true);
  expect_right_or_warned<Watching, long double, true>(26, 20, 1.5, 2.3);
  expect_right_or_warned<Watching, double, true>(29, 100, 0, 2.5, true);
  expect_right_or_warned<Watching, double, true>(30, 60, 0, 3);
}
// In pieces that end in time on a machine with eight tests side by side.
TEST(SlowUnequalMasses, AreRightOrWarnedOf) { expect_right_or_warned<Watching, double>(5, 1000, 8, 1.5); }
TEST(SlowUnequalMasses, AreRightOrWarnedOfBySecondSeed) { expect_right_or_warned<Watching, double>(10, 1000, 8, 1.5); }
TEST(SlowUnequalMasses, AreRightOrWarnedOfAfterLongRuns) {
  expect_right_or_warned<Watching, double>(6, 500, 2, 3);
  expect_right_or_warned<Watching, double>(7, 500, 0.3, 3);
}
TEST(SlowUnequalMasses, AreRightOrWarnedOfInWiderTypes) {
  expect_right_or_warned<Watching, long double>(8, 300, 8, 2);
#ifdef CRADLE_WITH_FLOAT128
  expect_right_or_warned<Watching, float128>(9, 100, 8, 2);
#endif
}
#endif

// Closing speeds on a ring keep the rounding of the first ones: cooled to it, the run makes other collisions (31
// instead of 58, in 220 digits).
TEST(UnequalMasses, ClosedSystemsThatHaveCooledToTheirRoundingAreWarnedOf) {
  System s{.x = {0.125, 0.4375}, .v = {0.9131, -0.21}, .m = {1, 1}, .circumference = 1};
  s.law = Bounce::cutoff, s.restitution = 0.3, s.until = 1e10;
  EXPECT_FALSE(make<GapChain<double>>(s, 1000).warned);
  s.until = 1e30;
  EXPECT_TRUE(make<GapChain<double>>(s, 1000).warned);
  s.circumference = 0, s.left_wall = s.right_wall = true;
  s.x = {0.125}, s.v = {0.9131}, s.m = {1}, s.wall_restitution = 0.3;
  EXPECT_TRUE(make<GapChain<double>>(s, 1000).warned);
}

// After a collision of restitution 0 two particles move together: they collide once, whatever their masses.
template <class T> void expect_one_collision_of_restitution_0() {
  Drawing draw(31);
  for (int k = 0; k < 100; ++k) {
    System s;
    s.x = {0, 1}, s.v = {draw.from_to(1, 2), draw.from_to(-1, 1)}, s.m = {draw.from_to(0.1, 1), draw.from_to(1, 9)};
    Simulation run(InelasticMerging<T>(Inelastic<T>(T(0)), exactly<T>(1e-9)),
                   ClusterChain<T>(particles_of<T>(s), T(0)));
    run.advance(T(1000));
    EXPECT_EQ(run.counts().collisions, 1U) << k;
  }
}
TEST(UnequalMasses, OfRestitutionZeroCollideOnce) {
  expect_one_collision_of_restitution_0<double>();
  expect_one_collision_of_restitution_0<double_double>();
}

// Down to intervals of 1e-1045 and back, which ranges wider than double's have. Exact: 16753 collisions (140 digits).
TEST(UnequalMasses, AreWarnedOfBelowTheRangeOfDouble) {
  Drawing draw(9003);
  System s;
  for (int k = 0; k <= 1325; ++k) s = draw(8, 2);
  EXPECT_TRUE(make<Watching<long double>>(s, 20000).warned);
#ifdef CRADLE_WITH_FLOAT128
  EXPECT_TRUE(make<Watching<float128>>(s, 20000).warned);
#endif
#ifdef CRADLE_WITH_MPFR
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(140));
  const Made right = make<Watching<Mpfr<8>>>(s, 20000);
  EXPECT_FALSE(right.warned);
  EXPECT_EQ(right.collisions, 16753U);
#endif
}
// Galperin: a light particle between a wall and one of M times its mass that comes in makes floor(pi sqrt(M))
// collisions.
System billiard(double mass) { return {.x = {1, 2}, .v = {0, -1}, .m = {1, mass}, .left_wall = true, .until = 1000}; }
// The same and its mirror image without the wall: the light ones meet, too.
System two_billiards(double mass) {
  return {.x = {0, 1, 2, 3}, .v = {1, 0, 0, -1}, .m = {mass, 1, 1, mass}, .until = 1000};
}
template <class Chain> void expect_collisions(const System& s, std::uint64_t collisions) {
  const Made made = make<Chain>(s, 1U << 30);
  EXPECT_EQ(made.collisions, collisions) << s.m.back();
  EXPECT_FALSE(made.warned) << s.m.back();
  EXPECT_FALSE(made.broken) << s.m.back();
  EXPECT_EQ(made.missed, 0) << s.m.back();
}

TEST(UnequalMasses, CountTheDigitsOfPi) {
  expect_collisions<Watching<double>>(billiard(1e6), 3141);
  expect_collisions<Watching<double>>(billiard(1e12), 3141592);
  expect_collisions<Watching<long double>>(billiard(1e10), 314159);
  expect_collisions<Watching<double_double>>(billiard(1e10), 314159);
  expect_collisions<PositionChain<double>>(billiard(1e10), 314159);
}
TEST(SlowUnequalMasses, CountTheDigitsOfPi) {
  expect_collisions<Watching<double>>(billiard(1e13), 9934588);
  expect_collisions<Watching<double>>(billiard(1e14), 31415926);
}
TEST(UnequalMasses, GuardsAreSilentOnHeavyParticlesThatMeetBetweenNoWalls) {
  expect_collisions<Watching<double>>(two_billiards(1e9), 149018);
  expect_collisions<Watching<double>>(two_billiards(1e10), 471239);
  expect_collisions<PositionChain<double>>(two_billiards(1e10), 471239);
  expect_collisions<Watching<double_double>>(two_billiards(1e10), 471239);
}
TEST(UnequalMasses, GuardsAreSilentOnALightParticleThatHasBeenFast) {
  System s{.x = {0, 1, 2.3}, .v = {1, 0, -1}, .m = {1e3, 1e-6, 1e3}};
  s.law = Bounce::cutoff, s.cutoff = 1e-9, s.until = 4;
  const Made positions = make<PositionChain<double>>(s, 1U << 30), gaps = make<Watching<double>>(s, 1U << 30),
             plain = make<GapChain<double, IndividualMasses<double>>>(s, 1U << 30);
  EXPECT_EQ(gaps.collisions, 70248U);
  EXPECT_EQ(positions.collisions, 70248U);
  EXPECT_FALSE(positions.broken || gaps.broken || plain.broken || gaps.warned);
  EXPECT_EQ(gaps.missed + positions.missed, 0);
}
TEST(UnequalMasses, GuardsAreSilentOnManyParticles) {
  Drawing draw(3);
  System s;
  for (int k = 0; k < 520; ++k) {
    s.x.push_back(k + draw.from_to(0, 0.5));
    s.m.push_back(k % 3 == 0 ? 1e-8 : k % 3 == 1 ? 1 : 1e8);
    s.v.push_back(draw.from_to(-1, 1));
  }
  s.until = 20;
  const Made gaps = make<Watching<double>>(s, 300000), positions = make<PositionChain<double>>(s, 300000);
  EXPECT_FALSE(gaps.broken || positions.broken);
  EXPECT_EQ(gaps.missed + positions.missed, 0);
}

}  // namespace cradle::test::unequal_masses_test
