// What must not change a bit of a run. Proves, for every kind of chain, law and scene below: a run has the same bits
// with output once, ten or ten thousand times, or at the very time of each collision; with and without an observer;
// with any number of index bits in the queue's keys; if it streams its rows, holds them completely, or has the same
// particles as a list; if identical particles have their masses one by one, and masses are watched or not; if it is
// saved anywhere and continued by another run; and if a run of other particles begins again with its own. And what
// holds in each of them: the guards are silent (the ledger is the direct sum, momentum, order and closure are kept),
// and no order is lost.
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/initial/poisson.hpp"
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/compare.hpp"

namespace cradle::test::same_bits_test {

using Dry = Inelastic<double>;
using Gaps = GapChain<double>;
using Masses = GapChain<double, IndividualMasses<double>>;
using Watched = GapChain<double, WatchedMasses<double>>;
using Positions = PositionChain<double>;
using Clusters = ClusterChain<double>;

// So much happens in it; `active`: particles between the outermost ones that are held at the end.
struct Least {
  std::uint64_t collisions = 100, merges = 0, close_calls = 0;
  ParticleIndex active = 0;
};
// A run that can be made anew; output is at multiples of `step`.
template <class Chain, class Law> struct Gas {
  std::string name;
  Scene<double> particles;
  Law law;
  double step, end;
  Least least = {};
  bool exact = true;  // places and velocities: a list, which knows no more, has the same gaps and closing speeds

  Simulation<double, Law, Chain> run(Options options = {}) const {
    if constexpr (StreamingChain<Chain>)
      return {law, Chain(particles, 0., options.hold_all), {}, options.least_queue_bits};
    else
      return {law, Chain(particles, 0.), {}, options.least_queue_bits};
  }
};
template <class Chain, class Law>
Gas<Chain, Law> gas(std::string name, Scene<double> particles, const Law& law, double step, double end,
                    Least least = {}, bool exact = true) {
  return {std::move(name), std::move(particles), law, step, end, least, exact};
}

// With rows of speed 1/2 collapse sets in at t = 2/(1 - (4/pi) atan sqrt eps).
const Dry law(0.98, 1e-5);    // t = 311
const Dry softer(0.9, 1e-3);  // t = 60

// From the first collision on, while rows come in, and after both are used up.
template <class Property> void for_each_of_rows(const Property& property) {
  property(gas<Gaps>("rows beyond their collapse", rshock<double>(200), softer, 2.5, 250,
                     {.collisions = 100000, .active = 200}));
  property(gas<Masses>("unequal rows", unequal_rows(), law, 12.5, 500, {.collisions = 15000, .active = 303}));
  property(gas<Gaps>("rows with a contact time", uniform_rows(400), ContactTime<double>(Dry(0.9), 1e-3), 10, 80,
                     {.collisions = 1000}));
  property(gas<Clusters>("wet rows that pass first", rshock<double>(400), Wet<double>(0.005), 2.5, 400,
                         {.merges = 101, .active = 400}));
  property(gas<Clusters>("wet rows that merge from the start", rshock<double>(400), Wet<double>(0.05), 2.5, 400,
                         {.merges = 101, .active = 400}));
  property(
      gas<Clusters>("unequal wet rows", unequal_rows(), Wet<double>(0.02), 12.5, 800, {.merges = 101, .active = 401}));
  property(gas<Clusters>("rows that merge when slow", uniform_rows(400), InelasticMerging<double>(Dry(0.9), 1e-3), 10,
                         400, {.collisions = 1000, .merges = 1}));
  property(gas<Gaps>("rows beside a piston", between(0, uniform_rows(400), Wall<double>{-205., .8}), Dry(0.99, 0.1), 20,
                     120, {.collisions = 1001}));
  property(gas<Masses>("falling rows", between(-0.01, uniform_rows(400), Wall<double>{-205., 0.25, .8}), Dry(0.99, 0.1),
                       20, 120, {.collisions = 1001}));
  for (const Shaking& motion : {Shaking(), shaken(Shape::sine, 0.25, 0.2), shaken(Shape::sawtooth, 0.05)})
    property(gas<Masses>("rows that come to rest on a floor",
                         between(-0.5, lattice_rows(30), wall(-16, motion, 0.25, 0, 0.25)), Dry(0.75, 0.01), 10, 40));
}

// Particles in random places, as far from each other as those of a Poisson process, whose density may fall.
std::int64_t half_steps(ParticleIndex particle) { return 2 * (particle - 1000); }
Scene<double> poisson_gas(double falls) {
  return std::make_shared<Cold<double>>(2001, 2., HotPlace::middle, kicked(ParticleIndex{1000}, 10.),
                                        poisson_displacement(2001, 1000, true, half_steps, 3, 0), MassPattern<double>(),
                                        falls);
}
Scene<double> poisson_rows() {
  const auto odd = [](ParticleIndex particle) { return 2 * (particle - 300) + 1; };
  return displaced_rows(600, poisson_displacement(600, 300, false, odd, 7, 3));
}
template <class Property> void for_each_of_other_masses_and_places(const Property& property) {
  for (const auto& centre : {std::optional<CentralParticle<double>>(), std::optional(heavy_particle<double>())})
    property(
        gas<Masses>("rows of masses that repeat", unequal_rows<double>(centre, three_masses), Dry(0.9, 1e-2), 10, 160));
  for (const auto& [hot, place] :
       {std::pair(1, HotPlace::left), {1, HotPlace::middle}, {32, HotPlace::middle}, {7, HotPlace::left}})
    property(gas<Masses>("a cold gas", cold_gas(hot, place), Dry(0.9, 1e-2), 10, 160, {.collisions = 41}, hot == 1));
  for (const double falls : {0., 0.5})
    property(
        gas<Gaps>("a Poisson process", poisson_gas(falls), Dry(0.9, 1e-2), 10, 80, {.collisions = 21}, falls == 0));
  property(gas<Gaps>("rows of a Poisson process", poisson_rows(), Dry(0.9, 1e-2), 10, 80));
}

template <class Property> void for_each_gas(const Property& property) {
  for_each_of_rows(property);
  for (const auto& scene : {unequal_rows<double>({}, three_masses), cold_gas(8, HotPlace::middle)})
    property(gas<Clusters>("clusters of masses that repeat", scene, Sticky<double>(), 10, 200,
                           {.collisions = 6, .merges = 6}));
  property(gas<Gaps>("mixed velocities", rmix<double>(32), Dry(0.9375), 10, 100));
  for (const double mass : {3., .1})
    property(gas<Gaps>("equal masses", unequal_rows<double>({}, MassPattern<double>({mass})), Dry(0.4, 1e-3), 10, 80));
  property(gas<Gaps>("rows in epochs", uniform_rows(1200), Dry(0.95, 1e-2), 4, 40));
  property(gas<Gaps>("a ring", gaussian_ring(20, 20), Dry(0.9, 1e-4), 4, 40));
  property(gas<Clusters>("a wet ring", gaussian_ring(20, 20), Wet<double>(0.01), 4, 40));
  property(gas<Masses>("particles with a contact time", uniform_rows(60), ContactTime<double>(Dry(0.9), 1e-3), 4, 40));
  property(gas<Masses>("restitutions of the speed", unequal_rows(), SpeedDependent<double>(0.5, 0.1, 2), 10, 80));
  property(gas<Positions>("rows in positions", uniform_rows(60), Dry(0.9, 1e-4), 4, 40));
  // Collisions are simultaneous all the time, two gaps apart.
  for (const double restitution : {1., .98})
    property(gas<Gaps>("lattice", lattice_rows(200), Dry(restitution, 1e-5), 0.25, 60, {.close_calls = 101}));
  property(gas<Positions>("lattice in positions", lattice_rows(200), Dry(0.98, 1e-5), 0.25, 60, {.close_calls = 101}));
  property(gas<Clusters>("wet lattice", lattice_rows(200), Wet<double>(0.001), 0.25, 60, {.close_calls = 101}));

  const auto walls = between(0, rmix<double>(40), thermal(-1, 0.5), Wall<double>{41., -0.02, .9});
  property(gas<Gaps>("between walls", walls, Dry(0.97, 1e-4), 0.37, 60));
  property(gas<Positions>("between walls in positions", walls, Dry(0.97, 1e-4), 0.37, 60));
  const auto falls = between(-0.25, rmix<double>(40), thermal(-1, 0.5), Wall<double>{41., -0.02, .9});
  property(gas<Masses>("falling", falls, Dry(0.97, 1e-3), 0.37, 60, {.collisions = 301}));
  property(gas<Positions>("falling in positions", falls, Dry(0.97, 1e-3), 0.37, 60, {.collisions = 301}));
  property(gas<Masses>("falling with a contact time", falls, ContactTime<double>(Dry(0.97, 1e-3), 1e-3), 0.37, 60,
                       {.collisions = 301}));
  for (const Shape shape : shapes) {
    const auto between_shaken =
        between(-0.25, rmix<double>(20), wall(-1, shaken(shape, 0.25, 0.3), 0.9), wall(21, shaken(shape, 0.5, 0, 2)));
    property(gas<Masses>("between shaken walls", between_shaken, Dry(0.97, 1e-3), 0.37, 20));
    property(gas<Positions>("between shaken walls, in positions", between_shaken, Dry(0.97, 1e-3), 0.37, 20));
  }
  for (const Shaking& motion : {Shaking(), shaken(Shape::sine, 0.25, 0.2), shaken(Shape::sawtooth, 0.05)})
    property(gas<Masses>(
        "a pile", between(-1, list<double>({0.3, 0.9, 1.2, 1.7}, {0.5, 0, -0.25, 0}), wall(0, motion, 0.25, 0, 0.1)),
        Dry(0.75), 0.37, 8, {.collisions = 10}));
  property(gas<Masses>("a ball that comes to rest",
                       between(-1, list<double>({0.3}, {0}), wall(0, shaken(Shape::sine, 0.2, 0.2), 0.25, 0, 0.05)),
                       Dry(1), 0.73, 12, {.collisions = 1}));
}

// Rows displaced by a few 2^-28, so that collisions all along the line come within 1e-8 of each other: a key with 18
// bits of index does not resolve that, and one with 8 does.
template <class Property> void for_each_of_nearly_simultaneous(const Property& property) {
  for (const ParticleIndex count : {100, 200, 300})
    for (ParticleIndex seed = 0; seed < 20; ++seed) {
      const auto rows =
          displaced_rows(count, [seed](ParticleIndex particle) { return bits_of(particle + 1000 * seed, 0, 0xF) - 8; });
      property(gas<Gaps>(std::to_string(count) + " particles, seed " + std::to_string(seed), rows, law, 1,
                         0.75 * static_cast<double>(count)));
    }
}

// Rows that are each other's mirror image: collisions come in pairs at the same time but for rounding, so that keys
// cannot decide which is first, and at the centre three particles meet.
template <class Property> void for_each_of_mirrored_wet_rows(const Property& property) {
  for (ParticleIndex seed = 0; seed < 20; ++seed) {
    const auto displacement = [seed](ParticleIndex particle) {
      const auto of_left = [seed](ParticleIndex b) { return bits_of(b + 1000 * seed, 0, 0xFFFFF); };
      return particle < 50 ? of_left(particle) : -of_left(99 - particle);
    };
    property(gas<Clusters>("mirrored wet rows, seed " + std::to_string(seed), displaced_rows(100, displacement),
                           Wet<double>(0.01), 1, 60));
  }
}

template <class First, class Second> void expect_same_to(double end, First& first, Second& second) {
  ASSERT_EQ(first.advance(end), Status::reached);
  ASSERT_EQ(second.advance(end), Status::reached);
  expect_same_state(first, second, end);
}

// Makes output at the exact time of each collision, found by an observed run of the same particles.
template <class Run> void expect_same_at_collisions(Run observed, Run often, Run& once, double end) {
  std::vector<double> times;
  std::uint64_t closing = 0;
  const auto observer = [&](const Collision<double>& c) {
    times.push_back(c.time.value()), closing += c.closing_speed > 0;
  };
  ASSERT_EQ(observed.advance(end, observer), Status::reached);
  expect_same_to(end, once, observed);
  EXPECT_EQ(observed.last_collision_time(), times.back());
  EXPECT_EQ(observed.counts().close_calls, once.counts().close_calls);
  EXPECT_EQ(closing, observed.counts().collisions);
  for (const double t : times) ASSERT_EQ(often.advance(t), Status::reached);
  expect_same_to(end, once, often);
  EXPECT_EQ(often.counts().close_calls, once.counts().close_calls);
}

TEST(SameBits, AtAnyCadenceAndWithAnObserverAndAccountsHold) {
  const auto expect_same = [](const auto& gas) {
    SCOPED_TRACE(gas.name);
    auto once = gas.run();
    expect_same_at_collisions(gas.run(), gas.run(), once, gas.end);
    EXPECT_TRUE(guards_hold(once, *gas.particles, gas.end));
    EXPECT_EQ(once.account().order_lost, 0U);
    EXPECT_GE(once.counts().collisions, gas.least.collisions);
    EXPECT_GE(once.counts().merges, gas.least.merges);
    EXPECT_GE(once.counts().close_calls, gas.least.close_calls);
    for (const int outputs : {10, 10000}) {
      auto often = gas.run();
      for (int k = 1; k <= outputs; ++k) {
        const double t = gas.end * k / outputs;
        ASSERT_EQ(often.advance(t), Status::reached);
        if (k % 100 == 0) often.configuration(t);
      }
      expect_same_to(gas.end, once, often);
      EXPECT_EQ(often.counts().close_calls, once.counts().close_calls);
    }
  };
  for_each_gas(expect_same);
  for_each_of_other_masses_and_places(expect_same);
}

TEST(SameBits, WithOutputBetweenNearlySimultaneousCollisions) {
  for_each_of_nearly_simultaneous([](const auto& gas) {
    SCOPED_TRACE(gas.name);
    auto once = gas.run({.least_queue_bits = 18});
    expect_same_at_collisions(gas.run({.least_queue_bits = 18}), gas.run({.least_queue_bits = 18}), once, gas.end);
  });
  std::uint64_t close_calls = 0;
  for_each_of_mirrored_wet_rows([&](const auto& gas) {
    SCOPED_TRACE(gas.name);
    auto once = gas.run();
    expect_same_at_collisions(gas.run(), gas.run(), once, gas.end);
    auto wide = gas.run({.least_queue_bits = 16});
    expect_same_to(gas.end, once, wide);
    close_calls += wide.counts().close_calls;
  });
  EXPECT_GT(close_calls, 0U);
}

TEST(SameBits, WhetherRowsAreStreamedHeldOrListed) {
  const auto expect_same = []<class Chain, class Law>(const Gas<Chain, Law>& gas) {
    SCOPED_TRACE(gas.name);
    auto streamed = gas.run(), held = gas.run({.hold_all = true}), listed = gas.run();
    EXPECT_LT(streamed.chain().last() - streamed.chain().first(), held.chain().last() - held.chain().first());
    const bool lists = gas.exact && gas.particles->wall(End::left) == nullptr;
    if (lists) listed = Gas<Chain, Law>{"", as_list(*gas.particles), gas.law, 0, 0}.run();
    for (double t = gas.step; t <= gas.end; t += gas.step) {
      SCOPED_TRACE(t);
      expect_same_to(t, streamed, held);
      if (lists) expect_same_to(t, streamed, listed);
      if constexpr (std::same_as<Law, Dry>) {
        ASSERT_EQ(streamed.counts().close_calls, held.counts().close_calls);
      }
    }
    const auto last = streamed.configuration(gas.end);
    EXPECT_GE(last.to - last.from + 1, gas.least.active);
    EXPECT_GT(streamed.counts().collisions, 2 * streamed.counts().merges);
  };
  for_each_of_rows(expect_same);
  for_each_of_other_masses_and_places(expect_same);
}

// Equal masses, whatever their size, are not treated as a special case of unequal ones, nor otherwise; and to watch
// masses that are not far apart changes nothing.
TEST(SameBits, WithMassesOneByOneAndWatched) {
  for_each_gas([]<class Chain, class Law>(const Gas<Chain, Law>& gas) {
    if constexpr (std::same_as<Chain, Gaps> || std::same_as<Chain, Masses>) {
      SCOPED_TRACE(gas.name);
      ASSERT_FALSE(far_apart(*gas.particles));
      auto first = gas.run();
      const auto expect_same = [&](auto other) {
        for (const double t : {gas.end / 3, gas.end}) {
          ASSERT_EQ(other.advance(t), first.advance(t));
          ASSERT_TRUE(same_collisions(first.counts(), other.counts())) << t;
          ASSERT_TRUE(identical(first.configuration(t), other.configuration(t))) << t;
          // The ledger forms mu = m^2/(2m) as m (m/2m): one rounding more where m is no power of two.
          ASSERT_NEAR(first.energy_lost(), other.energy_lost(), 0x1p-51 * std::abs(first.energy_lost()));
        }
      };
      expect_same(Gas<Masses, Law>{"", gas.particles, gas.law, 0, 0}.run());
      first = gas.run();
      expect_same(Gas<Watched, Law>{"", gas.particles, gas.law, 0, 0}.run());
    }
  });
}

TEST(SameBits, SavedAnywhereAndContinued) {
  for_each_gas([](const auto& gas) {
    SCOPED_TRACE(gas.name);
    expect_same_from_anywhere([&] { return gas.run(); }, gas.end / 15.3, gas.end,
                              [&](const auto& later, const auto& whole) { expect_same_state(later, whole, gas.end); });
  });
}

// `anew` is of these particles, `again` of any.
template <class Run> void expect_begun_again(Run again, Run anew, const Scene<double>& particles, double end) {
  again.advance(end);
  again.begin_again(particles);
  for (const double t : {end / 3, end}) {
    EXPECT_EQ(again.advance(t), anew.advance(t));
    EXPECT_TRUE(SavedState::of(again) == SavedState::of(anew)) << t;
    EXPECT_EQ(again.counts().close_calls, anew.counts().close_calls);
    EXPECT_EQ(again.kinetic_energy(t), anew.kinetic_energy(t));
  }
}

// A run of the gas of this kind that comes before it in the list: of more particles or fewer, on a line or a ring, with
// walls or without.
TEST(SameBits, BegunAgainAfterOtherParticles) {
  for_each_gas([]<class Chain, class Law>(const Gas<Chain, Law>& gas) {
    SCOPED_TRACE(gas.name);
    static Scene<double> before = gas.particles;
    const Gas<Chain, Law> other{"", std::exchange(before, gas.particles), gas.law, 0, 0};
    expect_begun_again(other.run(), gas.run(), gas.particles, gas.end);
  });
  const Scene<double> before = uniform_rows(6, 0.2, 1), after = uniform_rows(6, 0.2, 2);
  const Dry soft(0.05);
  const Policy<double> stop{CollapsePolicy::stop};
  expect_begun_again(gap_run(before, soft, stop), gap_run(after, soft, stop), after, 8);
  expect_begun_again(position_run(before, soft, stop), position_run(after, soft, stop), after, 8);
  const auto watched = [](const Scene<double>& particles) { return Gas<Watched, Dry>{"", particles, law, 0, 0}.run(); };
  expect_begun_again(watched(unequal_rows()), watched(cold_gas(8, HotPlace::left)), cold_gas(8, HotPlace::left), 80);
}

// 16 slots and a million are the same run: what keys cannot distinguish is decided by exact times. Returns the close
// calls of the widest.
template <class Gas> std::uint64_t close_calls_of_the_same_run(const Gas& gas, std::initializer_list<int> widths) {
  SCOPED_TRACE(gas.name);
  auto narrow = gas.run({.least_queue_bits = 3});
  std::uint64_t close_calls = 0;
  for (const int bits : widths) {
    SCOPED_TRACE(bits);
    auto wide = gas.run({.least_queue_bits = bits});
    expect_same_to(gas.end, narrow, wide);
    close_calls = wide.counts().close_calls;
  }
  return close_calls;
}

TEST(SameBits, WithAnyWidthOfTheIndex) {
  for_each_gas([](const auto& gas) { close_calls_of_the_same_run(gas, {8, 13, 20}); });
  // A queue of 8 million slots, for some hundred collisions.
  close_calls_of_the_same_run(gas<Clusters>("widest", rshock<double>(400), Wet<double>(0.05), 1, 20), {23});
  // Up to the first collapse.
  close_calls_of_the_same_run(gas<Gaps>("rows", rshock<double>(400), law, 1, 312), {13, 20});
  for (const int bits : {13, 20})
    EXPECT_GT(close_calls_of_the_same_run(gas<Gaps>("lattice", lattice_rows(200), law, 1, 150), {bits}), 0U);
  // The paper's shock.
  close_calls_of_the_same_run(gas<Gaps>("shock", rshock<double>(8000), Dry(0.999, 1e-5), 1, 4000), {20});
}

// Collisions far apart commute, but the origin of time must not move between them in another order.
TEST(SameBits, WithAnyWidthOfTheIndexWhereCollisionsAreNearlySimultaneous) {
  std::uint64_t few = 0, many = 0;
  for_each_of_nearly_simultaneous([&](const auto& gas) {
    few += close_calls_of_the_same_run(gas, {8});
    many += close_calls_of_the_same_run(gas, {18});
  });
  EXPECT_GT(many, few);
}

// Hundreds of collisions at a time, which the factor 1 - eps separates, from exactly simultaneous to what a key
// resolves.
TEST(SameBits, WithAnyWidthOfTheIndexInCrowdsOfTies) {
  for (const ParticleIndex seed : {1, 2, 3, 4}) {
    const auto particles = crowds<double>(1000, seed);
    for (const double dissipation : {1e-6, 1e-12, 1e-14}) {
      SCOPED_TRACE(testing::Message() << "1 - eps = " << dissipation << ", seed " << seed);
      const auto crowd = gas<Gaps>("a crowd", particles, Dry(1 - dissipation), 1, 20);
      close_calls_of_the_same_run(crowd, {13, 17, 20, seed == 1 ? 23 : 11});
      auto narrow = crowd.run();
      narrow.advance(20);
      EXPECT_GT(narrow.counts().close_calls, narrow.counts().collisions / 20) << "nothing to decide here";
    }
    close_calls_of_the_same_run(gas<Clusters>("wet", particles, Wet<double>(1e-9), 1, 20), {14, 20});
  }
}

}  // namespace cradle::test::same_bits_test
