// What `cradle check` expects of a scene, against runs of the same initial state: elastic gases, whose mean number of
// collisions is exact, up to the spread of N velocities; few particles, by Haff's law; and what it says where a gas
// clusters. (Where a shock collapses, of which rows nothing is known: tests/tools/outputs.txt.)
#include "cradle/tools/setup/read_scene.hpp"

#include <sstream>

#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/tests/texts.hpp"
#include "cradle/tools/setup/initial_state.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools::cost_test {

using test::has;

double counted(const Scene& scene) {
  const double restitution = scene.law.restitution.value;
  Simulation run(Inelastic<double>(restitution), GapChain<double>(initial_particles<double>(scene), 0.0));
  EXPECT_EQ(run.advance(scene.run.until.value), Status::reached);
  return static_cast<double>(run.counts().collisions);
}

Scene scene_of(const std::string& text) { return parse_scene(text, "gas.toml"); }

// The sum of |v - v'| over pairs is known from N Gaussian velocities to (2/sqrt N) sqrt(zeta)/mean, zeta = 1/3 + (2
// sqrt 3 - 4)/pi and mean = 2/sqrt(pi): 0.715/sqrt(N) (variance of Gini's mean difference), less if they are uniform.
// Four of these.
double four_deviations(double velocities) { return 4 * 0.715 / std::sqrt(velocities); }

// Walls: a passage between walls with a temperature takes L/s, after which velocities are new ones; so there are t s/L
// independent states at least.
TEST(ExpectedCollisions, OfElasticGasesAreCounted) {
  const std::string law = "law = { type = 'inelastic', restitution = 1 }\n";
  const std::vector<std::pair<std::string, double>> gases{
      {"run.until = 100\ninitial = { type = 'ring', particles = 4000, length = 2000, variance = 3 }", 4000},
      {"run.until = 100\ninitial = { type = 'ring', particles = 4000, length = 2000, velocities = 'uniform' }", 4000},
      {"run.until = 100\ninitial = { type = 'gas', particles = 4000, density = 2, positions = 'poisson' }\n"
       "walls.left.position = 0",
       4000},
      {"run.until = 8000\ninitial = { type = 'gas', particles = 200, density = 1 }\n"
       "walls = { left = { position = 0, temperature = 1 }, right = { temperature = 9 } }",
       200 * 8000 / 200.}};
  for (const auto& [text, velocities] : gases) {
    const Scene scene = scene_of(law + text);
    const Cost cost = expected_cost(scene);
    ASSERT_TRUE(cost.collisions) << text;
    EXPECT_TRUE(cost.predictable());
    EXPECT_NEAR(*cost.collisions / counted(scene), 1, four_deviations(velocities)) << text;
  }
}

// Four particles, nearly elastic: on the average over states the energy by Haff's law, three degrees of freedom of
// deviation sqrt(2/3), and the collisions. Four deviations.
TEST(ExpectedCollisions, OfFewParticlesAreThoseOfTheirDegreesOfFreedom) {
  Scene scene = scene_of("law = { type = 'inelastic', restitution = 0.999 }\nrun.until = 20\n"
                         "initial = { type = 'ring', particles = 4, length = 4, positions = 'poisson' }\n");
  constexpr unsigned replicas = 4000;
  double energy = 0, collisions = 0;
  for (; scene.initial.replica < replicas; ++scene.initial.replica) {
    const auto particles = initial_particles<double>(scene);
    Simulation run(Inelastic<double>(0.999), GapChain<double>(particles, 0.0));
    ASSERT_EQ(run.advance(20), Status::reached);
    energy += (particles->kinetic_energy() - run.energy_lost()) / replicas;
    collisions += static_cast<double>(run.counts().collisions) / replicas;
  }
  const std::vector<Prediction> table = predictions(scene);
  ASSERT_EQ(table.back().quantity, "energy_haff");
  EXPECT_EQ(table.back().t, 20);
  EXPECT_NEAR(table.back().value / energy, 1, 4 * std::sqrt(2. / 3 / replicas));
  EXPECT_NEAR(*expected_cost(scene).collisions / collisions, 1, four_deviations(4 * replicas));
}

// Six elastic particles between walls: 15 pairs, not 18, and the walls.
TEST(ExpectedCollisions, OfFewParticlesBetweenWallsAreThoseOfTheirPairs) {
  Scene scene = scene_of("law = { type = 'inelastic', restitution = 1 }\nrun.until = 20\nwalls.left.position = 0\n"
                         "initial = { type = 'gas', particles = 6, density = 2, variance = 2, positions = 'poisson' }");
  constexpr unsigned replicas = 2000;
  double collisions = 0;
  for (; scene.initial.replica < replicas; ++scene.initial.replica) collisions += counted(scene) / replicas;
  EXPECT_NEAR(*expected_cost(scene).collisions / collisions, 1, four_deviations(6 * replicas));
}

// Rows that pass through each other: all pairs of both rows, and within each row once it has contracted. Between the
// two the estimate is a line, good to a quarter; near the number of a collapse it is a fit, good to a tenth.
TEST(ExpectedCollisions, OfRowsThatPassEachOtherAreThoseOfTheirPairs) {
  for (const auto& [settings, off] : std::vector<std::pair<std::string, double>>{{"0.98 60 200", 0.01},
                                                                                 {"0.98 60 2000", 0.01},
                                                                                 {"0.99 200 500", 0.25},
                                                                                 {"0.995 400 700", 0.01},
                                                                                 {"0.995 400 9000", 0.01},
                                                                                 {"0.92 60 400", 0.1},
                                                                                 {"0.99 400 2000", 0.1}}) {
    std::istringstream words(settings);
    std::string restitution, particles, until;
    words >> restitution >> particles >> until;
    const Scene scene =
        scene_of("law = { type = 'inelastic', restitution = " + restitution + " }\nrun.until = " + until +
                 "\ninitial = { type = 'rows', speed = 0.5, perturbation = 0.1, particles = " + particles + " }\n");
    EXPECT_NEAR(expected_cost(scene).collisions.value() / counted(scene), 1, off) << settings;
  }
  // Wet particles that lose nothing are elastic.
  EXPECT_EQ(expected_cost(scene_of("law = { type = 'wet', loss = 0 }\nrun.until = 200\ninitial = { type = 'rows', "
                                   "speed = 0.5, perturbation = 0.1, particles = 50 }\n"))
                .collisions,
            625);
}

TEST(ExpectedCollisions, OnAFloorHaveNoPaceUnlessParticlesRestThere) {
  const std::string ball = "law = { type = 'inelastic', restitution = 1 }\nrun.until = 30\n"
                           "initial = { type = 'list', x = [1], v = [0] }\ngravity.acceleration = -1\n";
  EXPECT_FALSE(expected_cost(scene_of(ball + "walls.left = { position = 0, restitution = 0.9 }")).predictable());
  EXPECT_TRUE(expected_cost(scene_of(ball + "walls.left = { position = 0, restitution = 0.9, rest_speed = 1e-3 }"))
                  .predictable());
  EXPECT_TRUE(expected_cost(scene_of(ball + "walls.left.position = 0")).predictable());
}

// Haff's law has the energy within 3 % until t = tau (core/theory/classics_test.cpp), the rate within half of that;
// correlations grow up to the time of clustering, where they are of order 1: their share of the collisions until a
// quarter of it is below 1/16.
TEST(ExpectedCollisions, OfACoolingGasEndWhereItClusters) {
  const std::string ring = "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-6 }\nrun.until = 1000\n"
                           "initial = { type = 'ring', particles = 10000, length = 10000 }\n";
  for (const std::string restitution : {"0.9", "0.99"}) {
    Scene scene = parse_scene(ring, "gas.toml", {"law.restitution=" + restitution, "run.until=1e6"});
    const Cost cost = expected_cost(scene);
    ASSERT_TRUE(cost.clustering);
    EXPECT_FALSE(cost.predictable());
    EXPECT_TRUE(has(expected_warning(scene), "how many follow is not known"));
    EXPECT_TRUE(has(expected_warning(scene), "to end sooner: run.collapse = \"stop\""));
    scene.run.until = Decimal(std::to_string(*cost.clustering / 4));
    EXPECT_EQ(expected_warning(scene), "");
    EXPECT_NEAR(*expected_cost(scene).collisions / counted(scene), 1, four_deviations(1e4) + 1. / 16);
  }
  // Fewer than N_c particles do not collapse.
  Scene scene = parse_scene(ring, "gas.toml", {"initial.particles=50", "initial.length=50"});
  EXPECT_FALSE(expected_cost(scene).clustering);
  // Nothing is known of unequal masses.
  scene = parse_scene(ring, "gas.toml", {"initial.masses=[1,2]"});
  EXPECT_TRUE(has(expected_lines(scene, expected_cost(scene)), "there is no estimate"));
}

}  // namespace cradle::tools::cost_test
