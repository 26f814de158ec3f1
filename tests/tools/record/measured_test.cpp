// What is measured during a run. Proves: heat flux, collision rate and closing speeds of gases whose exact
// values are known, within 4 standard errors over replicas, and the diffusion of tagged particles; accounts of walls
// that balance; nearly the same numbers in every scalar type. (The same bytes on any number of threads, in segments and
// out of them: tools/run/outputs.txt; in ensembles: tools/ensemble. Checkpoints: tools/store/resume_test. Scenes that
// are refused: tools/messages.txt.)
#include <numbers>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/ensemble/layout.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tests::measured_test {

using tools::parse_scene;
using tools::Result;
using tools::Scene;

// Of numbers from replicas that are independent of each other.
class Replicas {
 public:
  void add(double x) { n_ += 1, sum_ += x, squares_ += x * x; }
  double mean() const { return sum_ / n_; }
  double error() const { return std::sqrt((squares_ / n_ - mean() * mean()) / (n_ - 1)); }
  void expect(double exact, double largest_error) const {
    EXPECT_NEAR(mean(), exact, 4 * error());
    EXPECT_LT(error(), largest_error);
  }

 private:
  double n_ = 0, sum_ = 0, squares_ = 0;
};

template <class Use> void of_replicas(const Scene& scene, int count, const Use& use) {
  for (int k = 0; k < count; ++k)
    use(tools::run_scene(tools::replica_scene(scene, static_cast<std::uint64_t>(k)), {tools::Progress::Show::never})
            .result);
}

// Identical elastic particles pass each other. At t = 1000 a share L/(t v) of 1 % of the slow ones has not crossed the
// line yet, less than the errors.
TEST(Measured, HeatFluxOfIdenticalParticles) {
  const Scene scene = parse_scene(R"(
law = { type = "inelastic", restitution = 1 }
initial = { type = "rows", particles = 20, speed = 2, perturbation = 0.4 }
walls = { left = { position = -10, temperature = 2 }, right = { position = 10, temperature = 8 } }
run.until = 3000
output = { series.times = [0, 1000, 3000], averages = { every = 5, from = 1000, bins = 4 } }
)",
                                  "flux.toml");
  const double exact = (2 - 8) / (std::sqrt(std::numbers::pi / 2) * (1 / std::sqrt(2) + 1 / std::sqrt(8)));
  EXPECT_NEAR(exact, -4.5136, 1e-4);
  Replicas left, right, current, pressure, errors;
  of_replicas(scene, 60, [&](const Result& run) {
    const auto of_left = numbers(run, "series", "wall_left_energy"),
               of_right = numbers(run, "series", "wall_right_energy"), energy = numbers(run, "series", "energy");
    left.add((of_left[2] - of_left[1]) / 2000);
    right.add((of_right[2] - of_right[1]) / 2000);
    for (const std::size_t k : {1U, 2U}) EXPECT_NEAR(energy[0] + of_left[k] + of_right[k], energy[k], 1e-8);
    EXPECT_NEAR(numbers(run, "series", "energy_lost")[2], 0, 1e-8);
    current.add(numbers(run, "averages", "energy_current")[1]);
    // The momentum from a wall per time is the pressure at it, the same everywhere.
    const auto momentum = numbers(run, "series", "wall_left_momentum");
    pressure.add((momentum[2] - momentum[1]) / 2000 - numbers(run, "averages", "pressure")[2]);
    errors.add(numbers(run, "averages", "density_sem")[1]);
  });
  left.expect(exact, 0.05);
  right.expect(-exact, 0.05);
  current.expect(exact, 0.1);
  pressure.expect(0, 0.05);
  EXPECT_GT(errors.mean(), 0.01);
}

TEST(Measured, CollisionsOfAGasInEquilibrium) {
  const Scene scene = parse_scene(R"(
law = { type = "inelastic", restitution = 1 }
initial = { type = "ring", particles = 1000, perturbation = 0.4 }
run.until = 60
[output]
series.points = 2
histograms = ["closing_speed", "collisions_per_particle", "free_flight", "gap"]
counting = { from = 20, every = 40 }
)",
                                  "equilibrium.toml");
  Replicas rate, slow, fast, wide;
  of_replicas(scene, 40, [&](const Result& run) {
    const auto share_above = [&](const std::string& name, double x) {
      const auto low = numbers(run, "histograms/" + name, "low");
      const auto count = numbers<std::uint64_t>(run, "histograms/" + name, "count");
      double all = 0, above = 0;
      for (std::size_t k = 0; k < low.size(); ++k)
        all += static_cast<double>(count[k]), above += low[k] >= x ? static_cast<double>(count[k]) : 0;
      return std::pair(above / all, all);
    };
    rate.add(2 * share_above("closing_speed", 0).second / 1000 / 40);
    slow.add(share_above("closing_speed", 1).first);
    fast.add(share_above("closing_speed", 3).first);
    wide.add(share_above("gap", 1).first);
    EXPECT_EQ(share_above("collisions_per_particle", 0).second, 1000);
    EXPECT_EQ(share_above("gap", 0).second, 2000);
    EXPECT_EQ(share_above("free_flight", 0).second, 2 * share_above("closing_speed", 0).second);
  });
  rate.expect(2 / std::sqrt(std::numbers::pi), 0.01);
  slow.expect(std::exp(-1. / 4), 0.002);
  fast.expect(std::exp(-9. / 4), 0.003);
  wide.expect(std::exp(-1.), 0.003);
}

// Identical elastic particles at Poisson positions, rho = T = 1 (Jepsen, J. Math. Phys. 6, 405, 1965). On a ring of N
// their mean velocity, of variance T/N, is taken away, which is a displacement independent of all else: it takes t^2/N
// from the mean square. Such particles stay at independent places.
TEST(Measured, DiffusionOfTaggedParticles) {
  const Scene scene = parse_scene(R"(
law = { type = "inelastic", restitution = 1 }
initial = { type = "ring", particles = 1000, positions = "poisson" }
run.until = 60
[output]
series.points = 2
correlations = { every = 0.5, longest = 20 }
structure = { every = 10, waves = 16, times = [30] }
pair_distribution = { every = 10, distance = 4, bins = 4, times = [30] }
)",
                                  "diffusion.toml");
  constexpr std::array<std::pair<double, double>, 5> exact{
      {{1, 0.5297}, {3, 2.170}, {5, 3.787}, {10, 7.788}, {20, 15.77}}};
  std::array<Replicas, 5> displacement, of_one_run, structure, structure_at, pairs, pairs_at;
  Replicas squares;
  of_replicas(scene, 100, [&](const Result& run) {
    const auto lag = numbers(run, "correlations", "lag"), found = numbers(run, "correlations", "msd"),
               error = numbers(run, "correlations", "msd_sem");
    squares.add(numbers(run, "correlations", "vacf")[0]);
    EXPECT_EQ(found[0], 0);
    for (std::size_t k = 0; k < 5; ++k) {
      const auto at = static_cast<std::size_t>(std::find(lag.begin(), lag.end(), exact[k].first) - lag.begin());
      displacement[k].add(found.at(at));
      of_one_run[k].add(error.at(at));
    }
    for (std::size_t k = 0; k < 4; ++k) {
      structure[k].add(numbers(run, "structure_average", "s")[4 * k]);
      structure_at[k].add(numbers(run, "structure/0000", "s")[4 * k]);
      pairs[k].add(numbers(run, "pair_distribution_average", "pair_distribution")[k]);
      pairs_at[k].add(numbers(run, "pair_distribution/0000", "pair_distribution")[k]);
    }
  });
  squares.expect(1 - 1 / 1000., 0.01);
  for (std::size_t k = 0; k < 5; ++k) {
    const auto [t, value] = exact[k];
    displacement[k].expect(value - t * t / 1000, 0.025 * value);
    // Errors of one run come from batches of 31 particles. Over 20 units of time these are not independent any more.
    const double over_replicas = displacement[k].error() * 10;
    if (t <= 5) {
      EXPECT_NEAR(of_one_run[k].mean(), over_replicas, 0.35 * over_replicas);
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    structure[k].expect(1, 0.15), structure_at[k].expect(1, 0.15);
    pairs[k].expect(1, 0.005), pairs_at[k].expect(1, 0.01);
  }
}

using Measuring = ProgramTest;

constexpr std::pair<const char*, const char*> of_particles[] = {{"correlations", "msd"},
                                                                {"correlations", "vacf"},
                                                                {"structure_average", "s"},
                                                                {"structure/0000", "s"},
                                                                {"pair_distribution_average", "pair_distribution"},
                                                                {"pair_distribution/0000", "pair_distribution"}};

TEST_F(Measuring, IsNearlyTheSameInEveryScalarType) {
  const std::string scene = R"(
law = { type = "inelastic", restitution = 0.9, cutoff = 1e-3 }
initial = { type = "ring", particles = 60, positions = "poisson" }
run.until = 4
[output]
series.points = 2
correlations.every = 0.25
structure = { every = 1, times = [3] }
pair_distribution = { every = 1, times = [3], distance = 20, bins = 8 }
)";
  const Result wanted = result_of(scene);
  in_wide_types(scene, [&](const Result& found) {
    for (const auto& [group, name] : of_particles) {
      const auto a = numbers(wanted, group, name), b = numbers(found, group, name);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-9 * (1 + a[k])) << group << " " << k;
    }
  });
}

}  // namespace cradle::tests::measured_test
