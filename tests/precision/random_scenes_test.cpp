// Random small scenes of every law and type, by rapidcheck, which shrinks what fails: invariants hold (guards are
// silent, energy is never gained), a loop without a queue makes the same collisions, a run saved at random moments and
// loaded again continues with the same bits, and so does one that is inspected in between.
// RC_PARAMS="max_success=10000" makes it more; CTest sets the seed.
#include <rapidcheck.h>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/tests/core/slow_loop.hpp"
#include "cradle/tests/precision/drawn_scenes.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::random_scenes_test {

using drawn::particles_of;

// The scene in 1/64, restitution and times in 1/1024: whole numbers, so that every type gets the same scene.
struct Drawn {
  drawn::Drawn scene;
  int restitution = 0;
  std::vector<int> cuts;  // times, in order
};

Drawn draw() {
  using rc::gen::inRange;
  Drawn d;
  const auto particles = *inRange<std::size_t>(2, 9);
  d.scene.gaps = *rc::gen::container<std::vector<int>>(particles, inRange(1, 1 << 16));
  d.scene.velocities = *rc::gen::container<std::vector<int>>(particles, inRange(-(1 << 14), 1 << 14));
  d.scene.masses = *rc::gen::container<std::vector<int>>(particles, inRange(64, 1 << 14));
  d.restitution = *inRange(1, 1025);  // of 0, what particles do that stay together is rounding's to decide
  d.scene.cutoff = *inRange(32, 1024);
  d.scene.loss = *inRange(0, 2048) << 8;
  if (*rc::gen::arbitrary<bool>()) d.scene.length = std::accumulate(d.scene.gaps.begin(), d.scene.gaps.end(), 0);
  d.cuts = *rc::gen::container<std::vector<int>>(3, inRange(0, 20 << 10));
  std::sort(d.cuts.begin(), d.cuts.end());
  return d;
}

template <class T> T time_of(int cut) { return T(cut) / T(1024); }

const int until = 20;

template <class Chain, class Law> void check(const Law& law, const Drawn& d) {
  using T = typename Chain::Scalar;
  const auto particles = particles_of<T>(d.scene);
  const auto make = [&] { return Simulation<T, Law, Chain>(law, Chain(particles, T(0))); };

  // Inspected, and saved and loaded, at random moments.
  auto whole = make(), inspected = make();
  auto saved = std::make_unique<Simulation<T, Law, Chain>>(make());
  std::vector<ParticleIndex> collisions;
  // Some collapse all the same, in the type's resolution: what is to be inspected comes before that.
  if (whole.advance(T(until), [&](const Collision<T>& c) { collisions.push_back(c.left); }) != Status::reached) return;
  T collision_before(0), energy = particles->kinetic_energy();
  for (const int cut : d.cuts) {
    const T time = time_of<T>(cut);
    inspected.advance(time);
    const T left = particles->kinetic_energy() - inspected.energy_lost();
    const auto found = guarded(inspected.configuration(time), *particles, inspected.counts().collisions, left, time,
                               inspected.last_collision_time(), collision_before, inspected.account().order_lost == 0);
    if (found.broken)
      RC_LOG() << "guard " << static_cast<int>(found.broken->guard) << ": " << to_double(found.broken->found) << " > "
               << to_double(found.broken->bound) << " at " << to_double(time) << " of "
               << inspected.counts().collisions;
    RC_ASSERT(!found.broken);
    RC_ASSERT(!(energy < left));
    energy = left;
    collision_before = inspected.last_collision_time();
    saved->advance(time);
    SavedState state = SavedState::of(*saved);
    saved = std::make_unique<Simulation<T, Law, Chain>>(make());
    load(state, *saved);
    RC_ASSERT(state.left() == 0U);
  }
  inspected.advance(T(until));
  saved->advance(T(until));
  RC_ASSERT(SavedState::of(inspected) == SavedState::of(whole));
  RC_ASSERT(SavedState::of(*saved) == SavedState::of(whole));

  // Made one by one. Times differ by the rounding of other origins: as far as chaos has not blown that up.
  SlowLoop<Law, Chain> slow(law, Chain(particles, T(0)), 1 << 30);
  std::vector<ParticleIndex> one_by_one;
  const std::size_t most = std::min<std::size_t>(collisions.size(), 25);
  while (one_by_one.size() < most) {
    const auto next = slow.next();
    RC_ASSERT(next.has_value());
    one_by_one.push_back(slow.collide(*next).particle);
  }
  RC_ASSERT(one_by_one ==
            std::vector<ParticleIndex>(collisions.begin(), collisions.begin() + static_cast<std::ptrdiff_t>(most)));
}

template <class Chain, class MakeLaw> void check_drawn_scenes(MakeLaw law, bool on_rings = true) {
  EXPECT_TRUE(rc::check([&] {
    Drawn d = draw();
    if (!on_rings) d.scene.length = 0;
    check<Chain>(law(d), d);
  }));
}
template <class T> T cutoff(const Drawn& d) { return T(d.scene.cutoff) / T(64); }
template <class T> Inelastic<T> inelastic(const Drawn& d, const T& below) {
  return Inelastic<T>(T(d.restitution) / T(1024), below);
}
template <class T> Inelastic<T> with_cutoff(const Drawn& d) { return inelastic<T>(d, cutoff<T>(d)); }

PRECISION_SUITE(RandomScenes, EachKindOfPrecision);

PRECISION_TEST(RandomScenes, InelasticInGaps) { check_drawn_scenes<GapChain<T, IndividualMasses<T>>>(with_cutoff<T>); }
PRECISION_TEST(RandomScenes, InelasticInPositions) { check_drawn_scenes<PositionChain<T>>(with_cutoff<T>, false); }
PRECISION_TEST(RandomScenes, WithAContactTime) {
  check_drawn_scenes<GapChain<T, IndividualMasses<T>>>(
      [](const Drawn& d) { return ContactTime<T>(inelastic<T>(d, T(0)), time_of<T>(d.scene.cutoff)); });
}
PRECISION_TEST(RandomScenes, Wet) {
  check_drawn_scenes<ClusterChain<T>>([](const Drawn& d) { return cradle::Wet<T>(T(d.scene.loss) / T(64)); });
}
PRECISION_TEST(RandomScenes, Merging) {
  check_drawn_scenes<ClusterChain<T>>(
      [](const Drawn& d) { return InelasticMerging<T>(inelastic<T>(d, T(0)), cutoff<T>(d)); });
}

// Found here: three particles collapse down to gaps of 1e-1080, and the times of other collisions, in such units, are
// beyond the range of the queue's keys. They were taken for never.
PRECISION_TEST(RandomScenes, ACollapseBeyondTheRangeOfDoubleForgetsNoOtherCollision) {
  Drawn d{{{1, 1, 17, 1, 1, 1}, {-16384, -14252, -16384, -16384, -15276, -15679}, {64, 7790, 64, 7568, 64, 64}},
          9,
          {0, 0, 64}};
  d.scene.cutoff = 32;
  EXPECT_TRUE(rc::check([&] { check<GapChain<T, IndividualMasses<T>>>(with_cutoff<T>(d), d); }));
}

}  // namespace cradle::test::random_scenes_test
