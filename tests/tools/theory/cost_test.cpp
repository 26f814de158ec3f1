// What `cradle check` expects of a scene, against runs of the same initial state: elastic gases, whose mean number of
// collisions is exact, up to the spread of N velocities; and what it says where a gas clusters or a shock collapses.
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/theory/cost.hpp"

#include <cmath>
#include <vector>

#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/tests/texts.hpp"
#include "cradle/tools/setup/initial_state.hpp"

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

TEST(ExpectedCollisions, OnAFloorHaveNoPaceUnlessParticlesRestThere) {
  const std::string ball = "law = { type = 'inelastic', restitution = 1 }\nrun.until = 30\n"
                           "initial = { type = 'list', x = [1], v = [0] }\ngravity.acceleration = -1\n";
  EXPECT_FALSE(expected_cost(scene_of(ball + "walls.left = { position = 0, restitution = 0.9 }")).predictable());
  EXPECT_TRUE(expected_cost(scene_of(ball + "walls.left = { position = 0, restitution = 0.9, rest_speed = 1e-3 }"))
                  .predictable());
  EXPECT_TRUE(expected_cost(scene_of(ball + "walls.left.position = 0")).predictable());
}

// Haff's law has the energy within 3 % until t = tau (free_cooling_test.cpp), the rate within half of that;
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

// With what a run ends at a collapse of many particles.
TEST(ExpectedCollisions, SayWithWhatACollapseEnds) {
  const std::string rows =
      "law = { type = 'inelastic', restitution = 0.9 }\nrun.until = 1e4\n"
      "initial = { type = 'rows', particles = 200, speed = 0.5, spacing = 1, perturbation = 0.3 }\n";
  EXPECT_TRUE(has(expected_warning(scene_of(rows)), "a gap below 2^-100 of one beside it at the start does, too; "));
  EXPECT_TRUE(has(expected_warning(scene_of(rows + "run.stop_gap = 1e-9\n")), "a gap below run.stop_gap = 1e-9 does, too;"));
  EXPECT_TRUE(has(expected_warning(scene_of(rows + "run.coordinates = 'absolute'\n")), "which may take long"));
  EXPECT_TRUE(has(expected_warning(parse_scene(rows, "rows.toml", {"law.cutoff=1e-6"})), "to end sooner"));
}

// N_c = 4 for 0.1716: two gaps collapse to a proved end, and double ends where numbers leave its range.
TEST(ExpectedCollisions, AreWithoutEndWhereFewParticlesCollapseInTypesWithoutRange) {
  const auto warning = [](const std::string& restitution, const char* run, const std::string& particles) {
    return expected_warning(
        scene_of("law = { type = 'inelastic', restitution = " + restitution + " }\nrun = { " + run +
                 "until = 50, collapse = 'stop' }\ninitial = { type = 'ring', particles = " + particles + " }\n"));
  };
  const char* const endless = "has no end: give run.stop_gap";
  for (const char* wide : {"precision = 'mpfr', ", "precision = 'cpp_bin_float', "}) {
    EXPECT_TRUE(has(warning("0.17", wide, "4"), endless));
    EXPECT_FALSE(has(warning("0.18", wide, "4"), endless));
    EXPECT_FALSE(has(warning("0.05", wide, "3"), endless));
    EXPECT_FALSE(has(warning("0.17", wide, "17"), endless));
  }
  EXPECT_FALSE(has(warning("0.17", "", "4"), endless));
  EXPECT_FALSE(has(warning("0.17", "precision = 'mpfr', stop_gap = 1e-99, ", "4"), endless));
  // A cut-off of 0 goes past the collapse of three, which is endless as well.
  const auto past = [](const char* precision) {
    return expected_warning(
        read_scene("collapse3", {"run.collapse=cutoff", "run.stop_gap=", std::string("run.precision=") + precision}));
  };
  EXPECT_TRUE(has(past("mpfr"), "has no end: give a law.cutoff"));
  EXPECT_EQ(past("double"), "");
}

TEST(ExpectedCollisions, OfAPileOnAnInelasticFloorMayBeVeryMany) {
  const std::string pile =
      "law = { type = 'inelastic', restitution = 0.5, cutoff = 1e-9 }\ngravity.acceleration = -1\nrun.until = 200\n"
      "walls.left = { position = 0, restitution = 0.8 }\ninitial = { type = 'list', x = [1, 2], v = [0, 0.1] }\n";
  EXPECT_TRUE(has(expected_warning(scene_of(pile)), "may be very many: with walls.left.rest_speed"));
  EXPECT_EQ(expected_warning(parse_scene(pile, "pile.toml", {"walls.left.rest_speed=1e-3"})), "");
}

}  // namespace cradle::tools::cost_test
