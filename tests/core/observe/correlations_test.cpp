// Correlations. Proves: lags and values are those of all pairs of samples, taken one by one; errors are those of batch
// means; places on rings are not folded, as steps so small that no fold can hide in them show, in every direction and
// with masses; particles that no front has reached count, and fall; all from a saved state too.
#include "cradle/core/observe/correlations.hpp"

#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/compare.hpp"

namespace cradle::test::correlations_test {

TEST(OctaveSteps, AreEightInEveryOctave) {
  EXPECT_EQ(octave_steps(40), (std::vector<std::uint64_t>{1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13,
                                                          14, 15, 16, 18, 20, 22, 24, 26, 28, 30, 32, 36, 40}));
  const auto steps = octave_steps(1'000'000'000);
  for (std::size_t k = 8; k < steps.size(); ++k) {
    EXPECT_LE(8 * steps[k], 9 * steps[k - 1]);
    EXPECT_EQ(steps[k], k >= 15 ? 2 * steps[k - 8] : k + 1);
  }
  EXPECT_TRUE(octave_steps(0).empty());
}

// Numbers that are different for every particle and sample, with the digits of nothing in common.
struct Walk {
  std::vector<double> x, v;
};
Walk sample_of(std::size_t particles, std::size_t time) {
  Walk walk;
  for (std::size_t j = 0; j < particles; ++j) {
    const auto t = static_cast<double>(time), p = static_cast<double>(j);
    walk.x.push_back(3 * std::sin(0.013 * t * (1 + 0.1 * p)) + 0.01 * t + p);
    walk.v.push_back(std::cos(0.013 * t * (1 + 0.1 * p)) - 0.3);
  }
  return walk;
}
Correlator correlated(std::size_t particles, std::size_t samples, std::uint64_t longest) {
  Correlator correlator(particles, longest);
  for (std::size_t k = 0; k < samples; ++k) {
    const Walk now = sample_of(particles, k);
    correlator.add(now.x, now.v);
  }
  return correlator;
}

TEST(Correlator, TakesAllPairsOfSamplesThatItsLevelsHold) {
  constexpr std::size_t particles = 70, samples = 333;
  for (const std::uint64_t longest : {std::uint64_t{0}, std::uint64_t{7}, std::uint64_t{16}, std::uint64_t{200}}) {
    const Correlator correlator = correlated(particles, samples, longest);
    const auto lags = correlator.lags();
    const auto found = correlator.correlations();
    ASSERT_EQ(found.size(), lags.size());
    EXPECT_EQ(lags.front(), 0U);
    EXPECT_LE(lags.back(), longest);
    for (std::size_t k = 0; k < lags.size(); ++k) {
      std::size_t step = 1;  // from 16 samples on every second one, from 32 on every fourth
      while (lags[k] >= 16 * step) step *= 2;
      double squares = 0, products = 0, pairs = 0;
      for (std::size_t s = 0; s + lags[k] < samples; s += step) {
        const Walk from = sample_of(particles, s), to = sample_of(particles, s + lags[k]);
        for (std::size_t j = 0; j < particles; ++j) {
          squares += (to.x[j] - from.x[j]) * (to.x[j] - from.x[j]);
          products += to.v[j] * from.v[j];
          pairs += 1;
        }
      }
      EXPECT_NEAR(found[k].displacement.mean, squares / pairs, 1e-12 * squares / pairs) << lags[k];
      EXPECT_NEAR(found[k].velocity.mean, products / pairs, 1e-12) << lags[k];
    }
  }
}

TEST(Correlator, OfFreeFlightsIsExact) {
  Correlator correlator(2, 50);
  for (int k = 0; k <= 60; ++k) correlator.add({0.5 * k, -0.25 * k}, {0.5, -0.25});
  for (std::size_t k = 0; const auto& [displacement, velocity] : correlator.correlations()) {
    const auto t = static_cast<double>(correlator.lags()[k++]);
    EXPECT_EQ(velocity.mean, (0.25 + 0.0625) / 2);
    EXPECT_DOUBLE_EQ(displacement.mean, velocity.mean * t * t);
  }
}

TEST(Correlator, ErrorsAreThoseOfBatchesOfNeighbours) {
  constexpr std::size_t particles = 3 * mean_batches;
  const Correlator correlator = correlated(particles, 40, 20);
  const auto found = correlator.correlations();
  constexpr std::size_t k = 5;
  std::vector<double> means(mean_batches);
  for (std::size_t j = 0; j < particles; ++j)
    for (std::size_t s = 0; s + k < 40; ++s) {
      const double way = sample_of(particles, s + k).x[j] - sample_of(particles, s).x[j];
      means[j / 3] += way * way / (3 * 35.);
    }
  const auto [mean, error] = mean_of(means);
  EXPECT_NEAR(found[k].displacement.mean, mean, 1e-12 * mean);
  EXPECT_NEAR(found[k].displacement.error, error, 1e-10 * error);
  EXPECT_TRUE(std::isnan(correlated(1, 40, 20).correlations()[k].displacement.error));
}

TEST(Correlator, HasNoNumbersForLagsWithoutPairs) {
  const auto found = correlated(5, 10, 40).correlations();
  EXPECT_TRUE(std::isfinite(found[9].displacement.mean));
  EXPECT_TRUE(std::isnan(found[10].displacement.mean));
  EXPECT_TRUE(std::isnan(found.back().velocity.mean));
  EXPECT_TRUE(std::isnan(Correlator(5, 10).correlations()[0].velocity.mean));
}

TEST(Correlator, ContinuesFromASavedState) {
  const auto add = [](Correlator& correlator, std::size_t k) {
    const Walk now = sample_of(9, k);
    correlator.add(now.x, now.v);
  };
  expect_continues(Correlator(9, 100), 150, 77, add, {Correlator(8, 100), Correlator(9, 10), Correlator(9, 1000)});
  EXPECT_THROW(Correlator(0, 10), std::invalid_argument);
}

// ---- tagged particles

// Follows every particle through folded positions, by steps in which none moves by half of the ring.
void expect_unfolded(const Scene<double>& scene, double restitution, double until) {
  const double length = scene->circumference();
  auto run = mass_run(scene, Inelastic(restitution));
  TaggedParticles<double> all(*scene, 1), some(*scene, 3);
  std::vector<double> displacement(static_cast<std::size_t>(scene->count())), folded(displacement.size());
  for (std::size_t j = 0; j < folded.size(); ++j) folded[j] = scene->position(static_cast<ParticleIndex>(j));
  const double step = 0.01;
  double farthest = 0;
  for (int k = 1; k * step <= until; ++k) {
    run.advance(k * step);
    const Configuration<double> now = run.configuration(k * step);
    for (std::size_t j = 0; j < now.x.size(); ++j) {
      const auto particle = static_cast<std::size_t>(now.index[j]);
      const double way = now.x[j] - folded[particle];
      displacement[particle] += way - std::round(way / length) * length;
      folded[particle] = now.x[j];
    }
    all.find(now, k * step);
    some.find(now, k * step);
    for (std::size_t j = 0; j < displacement.size(); ++j) {
      ASSERT_NEAR(all.displacement()[j], displacement[j], 1e-9) << "particle " << j << " at " << k * step;
      if (j % 3 == 0) {
        ASSERT_EQ(some.displacement()[j / 3], all.displacement()[j]);
        ASSERT_EQ(some.velocity()[j / 3], all.velocity()[j]);
      }
      farthest = std::max(farthest, std::abs(displacement[j]));
    }
  }
  EXPECT_GT(farthest, 3 * length);
}

TEST(TaggedParticles, AreNotFoldedOnRings) {
  for (const double drift : {0.9, -1.3})
    for (const double restitution : {1., 0.7}) {
      std::vector<double> v{1.5, -0.5, 0.25, -2, 0.75};
      for (double& each : v) each += drift;
      expect_unfolded(list({-0.4, 0.1, 0.75, 1.5, 1.9}, v, {1, 3, 0.5, 1, 2}, 2.5), restitution, 15);
    }
}

TEST(TaggedParticles, OfRowsAreThoseThatNoFrontHasReachedToo) {
  const Scene<double> scene = uniform_rows(60);
  GapRun<double> run = gap_run(scene, Inelastic(0.9, 1e-3));
  run.advance(8.);
  const Configuration<double> now = run.configuration(8.);
  ASSERT_GT(now.from, 2);
  ASSERT_LT(now.to, 57);
  TaggedParticles<double> tagged(*scene, 2);
  ASSERT_EQ(tagged.size(), 30U);
  tagged.find(now, 8.);
  for (ParticleIndex particle = 0; particle < 60; particle += 2) {
    const auto k = static_cast<std::size_t>(particle / 2);
    if (particle < now.from || particle > now.to) {
      EXPECT_EQ(tagged.displacement()[k], scene->velocity(particle) * 8);
      EXPECT_EQ(tagged.velocity()[k], scene->velocity(particle));
    } else {
      const auto j = static_cast<std::size_t>(particle - now.from);
      EXPECT_EQ(tagged.displacement()[k], now.x[j] - scene->position(particle));
      EXPECT_EQ(tagged.velocity()[k], now.v[j]);
    }
  }
}

// Two of five particles have met, the others only fall, as far as s + 1/2 from the time s to the next; one of all flies
// at 1/2 besides, so the sums over them of squares are 4 (s + 1/2)^2 + s^2, and 4 t^2 + (t - 1/2)^2 of velocities.
TEST(TaggedParticles, FallWhetherAFrontHasReachedThemOrNot) {
  const auto particles = between(-1, list<double>({100, 101, 300, 400, 500}, {0.5, 0, 0, 0, 0}), Wall<double>{0.});
  Simulation run(Inelastic<double>(1), GapChain<double>(particles, 0.));
  TaggedParticles<double> tagged(*particles, 1);
  Correlator correlator(tagged.size(), 10);
  double ways = 0, speeds = 0;
  for (int t = 0; t <= 10; ++t) {
    run.advance(t);
    const Configuration<double> now = run.configuration(t);
    if (t >= 2) {
      ASSERT_LT(now.to, 4);
    }
    tagged.find(now, t);
    correlator.add(tagged.displacement(), tagged.velocity());
    EXPECT_DOUBLE_EQ(kinetic_energy(now, *particles, double(t)), run.kinetic_energy(t));
    speeds += (4 * t * t + (t - 0.5) * (t - 0.5)) / 55;
    if (t < 10) ways += (4 * (t + 0.5) * (t + 0.5) + t * t) / 50;
  }
  EXPECT_EQ(run.counts().collisions, 1U);
  const auto found = correlator.correlations();
  EXPECT_DOUBLE_EQ(found[1].displacement.mean, ways);  // 32.3
  EXPECT_DOUBLE_EQ(found[0].velocity.mean, speeds);    // 34.05
}

}  // namespace cradle::test::correlations_test
