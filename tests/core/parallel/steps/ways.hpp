#pragma once
// What the tests of steps share, whatever the numbers: runs in segments with steps, which must have the bits of the
// plain loop in every gap, closing speed, local time, lag and loss, and in what walls gave.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "cradle/core/initial/walled.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/tests/core/segmented.hpp"

namespace cradle::test {

class WithSteps : public ::testing::Test {
  void SetUp() override {
    if (all_steps().empty()) GTEST_SKIP() << "built without Highway";
  }
};

// On each kind of vectors that this processor has.
inline std::vector<SegmentsAs> on_all_vectors(Segmentation how, unsigned threads) {
  std::vector<SegmentsAs> ways;
  for (const Steps& steps : all_steps()) {
    ways.push_back({how, threads});
    ways.back().how.steps = &steps;
  }
  return ways;
}

// Every segmentation on the widest vectors, and one on each other kind.
inline std::vector<SegmentsAs> all_ways() {
  std::vector<SegmentsAs> ways = segmentations();
  for (SegmentsAs& as : ways) as.how.steps = &all_steps().front();
  for (std::size_t k = 1; k < all_steps().size(); ++k) {
    ways.push_back(segmentations()[k % segmentations().size()]);
    ways.back().how.steps = &all_steps()[k];
  }
  return ways;
}

template <class Chain, class Law, class Time = int>
SlabsMade expect_same_in_steps(const Scene<typename Chain::Scalar>& scene, const Law& law,
                               const std::vector<Time>& times, const std::vector<SegmentsAs>& ways) {
  const std::vector<typename Chain::Scalar> in_scalar(times.begin(), times.end());
  return expect_same_in_segments<Chain, true>(scene, law, ways, in_scalar);
}

template <class Chain>
void expect_same_by_all_laws(const Scene<typename Chain::Scalar>& scene, const std::vector<int>& times,
                             double least_in_steps) {
  SlabsMade all;
  const auto check = [&](const std::string& name, const auto& law) {
    SCOPED_TRACE(name);
    all += expect_same_in_steps<Chain>(scene, law, times, all_ways());
  };
  for (const auto& law : laws<typename Chain::Scalar>())
    check("restitution " + std::to_string(to_double(law.restitution())), law);
  if constexpr (std::same_as<Chain, GapChain<double, IndividualMasses<double>>>)
    check("of the speed", SpeedDependent<double>(0.8, 0.1, 0.6));
  EXPECT_GT(all.slabs, 100U);
  EXPECT_GE(static_cast<double>(all.in_steps), least_in_steps * static_cast<double>(all.collisions));
}

template <class Chain> void expect_same_between_walls(const std::vector<int>& times, double least_in_steps) {
  using T = typename Chain::Scalar;
  expect_same_by_all_laws<Chain>(gas_between_walls<T>(!std::same_as<Chain, GapChain<T>>), times, least_in_steps);
}

// Under gravity and between shaken walls.
template <class Chain> void expect_same_at_curved_walls(const std::vector<int>& times, double least_in_steps) {
  using T = typename Chain::Scalar;
  for (const Scene<T>& scene : lines_at_curved_walls<T>(800, !std::same_as<Chain, GapChain<T>>))
    expect_same_by_all_laws<Chain>(scene, times, least_in_steps);
}

// ---- random scenes

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  template <class T> T one_of(std::initializer_list<T> all) { return all.begin()[below(all.size())]; }

 private:
  std::mt19937_64 random_;
};

template <class T> Scene<T> random_scene(Dice& dice, bool unequal, double& duration, bool with_walls = true) {
  const auto n = static_cast<ParticleIndex>(20 + 2 * dice.below(dice.one_of<std::size_t>({30, 200, 800})));
  duration = dice.one_of({1., 20., 60.}) * dice.uniform();
  if (!unequal && dice.below(4) == 0) {
    duration += static_cast<double>(n) * 0.2;
    return displaced_rows<T>(n, uniform_displacement(dice.one_of({0.4, 0.05, 1e-6}), dice.below(1000), 0));
  }
  const bool ring = dice.below(3) == 0, lattice = dice.below(8) == 0;
  const double still = dice.one_of({0., 0., 0.7}), heavy = dice.one_of({1.0001, 3., 50.});
  std::vector<T> x, v, m;
  for (ParticleIndex i = 0; i < n; ++i) {
    x.push_back(T(static_cast<double>(i) + (lattice ? 0 : 0.5 * dice.uniform())));
    v.push_back(T(dice.uniform() < still ? 0 : lattice ? dice.one_of({-1., 0., 1.}) : 2 * dice.uniform() - 1));
    if (unequal) m.push_back(T(dice.below(2) == 0 ? 1 : heavy));
  }
  const double last = static_cast<double>(n);
  const Scene<T> scene = list(x, v, m, T(ring ? last : 0.));
  if (!with_walls || ring || dice.below(3) > 0) return scene;
  const auto wall = [&](double at) -> std::optional<Wall<T>> {
    if (dice.below(3) == 0) return {};
    Wall<T> made{.position = T(at), .restitution = T(dice.uniform()), .temperature = dice.one_of({0., 0.3}), .seed = 3};
    if (dice.below(3) > 0) return made;
    // Restitution 1, since particles without a cut-off would collapse on it.
    made.restitution = T(1);
    made.motion = std::make_shared<WallMotion<T>>(dice.one_of({Shape::sawtooth, Shape::parabola, Shape::sine}),
                                                  T(dice.one_of({0.01, 0.2})), T(dice.one_of({0.5, 3., 40.})), T(0));
    return made;
  };
  auto left = wall(-0.5), right = wall(last + 0.5);
  const T falls = dice.below(3) > 0 || !left ? T(0) : T(-2. / last);
  if (!(falls == T(0))) left->restitution = T(1);
  return std::make_shared<Walled<T>>(scene, left, right, falls);
}

inline std::vector<SegmentsAs> random_ways(Dice& dice) {
  std::vector<SegmentsAs> ways = on_all_vectors({.anywhere = true}, 1);
  for (auto& [how, workers, observed] : ways) {
    how.gaps = 1 + dice.below(dice.one_of<std::size_t>({8, 100, 2000}));
    how.ghosts = 1 + dice.below(80);
    how.collisions = dice.one_of({0., 0.5, 4., 20.});
    workers = static_cast<unsigned>(1 + dice.below(3));
  }
  return ways;
}

// The time of the millionth collision if that is before `until`. Particles that fall on each other may collide for ever
// below the cut-off, and the plain loop would take minutes.
template <class Chain, class Law>
double at_most_a_million(const Scene<typename Chain::Scalar>& scene, const Law& law, double until) {
  using T = typename Chain::Scalar;
  if (!scene->fall()) return until;
  Simulation run(law, Chain(scene, T(0)));
  run.head_for(T(until));
  while (run.counts().collisions < 1'000'000)
    if (!run.step()) return until;
  return to_double(run.last_collision_time());
}

template <class Chain> void expect_same_in_a_random_scene(Dice& dice) {
  using T = typename Chain::Scalar;
  constexpr bool unequal = !std::same_as<Chain, GapChain<T>>;
  double duration = 0;
  const Scene<T> scene = random_scene<T>(dice, unequal, duration);
  const std::vector<SegmentsAs> ways = random_ways(dice);
  const auto expect_same = [&](const auto& law) {
    const double until = at_most_a_million<Chain>(scene, law, duration);
    expect_same_in_steps<Chain>(scene, law, std::vector{0.6 * until, until}, ways);
  };
  const double restitution = dice.one_of({1., 0.999, 0.95, 0.6, 0.4});
  const double cutoff = restitution > 0.99 ? dice.one_of({0., 1e-5, 0.1}) : dice.one_of({0.01, 0.1});
  if constexpr (unequal && std::same_as<T, double>)
    if (dice.below(3) == 0)
      return expect_same(SpeedDependent<T>(std::max(restitution, 0.95), 0.05 + dice.uniform(), 0.1 + dice.uniform()));
  expect_same(Inelastic<T>(T{restitution}, T{cutoff}));
}

// As many as take four seconds, and so many at least; by hand as many as CRADLE_FUZZ_SECONDS says, from the scene
// CRADLE_FUZZ_SEED on.
template <class ExpectSame> void expect_same_in_random_scenes(std::uint64_t least, const ExpectSame& expect_same) {
  const char* asked = std::getenv("CRADLE_FUZZ_SECONDS");
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(asked == nullptr ? 4. : std::atof(asked));
  const char* first = std::getenv("CRADLE_FUZZ_SEED");
  std::uint64_t seed = first != nullptr   ? std::strtoull(first, nullptr, 10)
                       : asked == nullptr ? 1
                                          : std::random_device()();
  const std::uint64_t last = seed + least;
  for (; (std::chrono::steady_clock::now() < end || seed < last) && !::testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    if (asked != nullptr) std::printf("seed %llu\n", static_cast<unsigned long long>(seed)), std::fflush(stdout);
    Dice dice(seed);
    expect_same(dice);
  }
  ::testing::Test::RecordProperty("seed", std::to_string(seed));
}
template <class Equal, class Unequal> void expect_same_in_random_scenes(std::uint64_t least) {
  expect_same_in_random_scenes(least, [](Dice& dice) {
    dice.below(2) == 0 ? expect_same_in_a_random_scene<Equal>(dice) : expect_same_in_a_random_scene<Unequal>(dice);
  });
}

}  // namespace cradle::test
