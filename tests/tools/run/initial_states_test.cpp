// Scenes with random initial states, a gas between walls, and the last state of another result: the same bytes on any
// number of threads, the same particles in every precision, proofs, and continuation of another run. (Refusals:
// tests/tools/messages.txt.)
#include <cmath>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tests::initial_states_test {

const std::string bouncing = "law = { type = 'inelastic', restitution = 0.95, cutoff = 1e-3 }\nrun.until = 4\n";
const std::string gas = bouncing + "initial.type = 'gas'\ninitial.particles = 60\ninitial.positions = 'poisson'\n";
const std::string cold = bouncing + "initial = { type = 'cold', particles = 61, density_exponent = 0.4, speed = 9, ";
const std::string output = "output.snapshots = [0, 4]\noutput.series.points = 3\n";

const std::string random_scenes[] = {
    gas + output,
    gas + "initial.random_masses = [1, 3]\n" + output,
    bouncing + "initial = { type = 'ring', particles = 60, positions = 'poisson', random_masses = [1, 3] }\n" + output,
    bouncing + "initial = { type = 'rows', particles = 60, positions = 'poisson', random_masses = [1, 3] }\n" + output,
    cold + "positions = 'poisson' }\n" + output,
    cold + "perturbation = 0.3, random_masses = [1, 3] }\n" + output};

using InitialStates = ProgramTest;

TEST_F(InitialStates, AreTheSameInEveryPrecision) {
  for (const std::string& scene : random_scenes) {
    const auto of_double = numbers(result_of(scene), "snapshots/0000", "x");
    ASSERT_GT(of_double.size(), 1U);
    in_wide_types(scene, "", [&](const tools::Result& result) {
      const auto wide = numbers(result, "snapshots/0000", "x");
      ASSERT_EQ(wide.size(), of_double.size());
      // A unit, a product, an end of the gas: of numbers up to the greatest position.
      const double most = std::max(std::abs(wide.front()), std::abs(wide.back()));
      for (std::size_t k = 0; k < wide.size(); ++k) ASSERT_NEAR(wide[k], of_double[k], 4 * 0x1p-52 * most);
    });
  }
}

TEST_F(InitialStates, AreTheSameOnAnyNumberOfThreads) {
  for (const std::string& scene : random_scenes) {
    write("s.toml", scene);
    expect_same_on_threads("cradle run s.toml --set initial.particles=4000");
  }
}

TEST_F(InitialStates, ReplicasDiffer) {
  for (const std::string& scene : random_scenes) {
    write("s.toml", scene);
    const Printed printed = shell("cradle ensemble s.toml --replicas 2 --quiet -o e.h5", 0);
    EXPECT_FALSE(has(printed.err, "nothing is random"));
    const tools::Result result = read("e.h5");
    EXPECT_NE(numbers(result, "ensemble/series/front_right", "min").back(),
              numbers(result, "ensemble/series/front_right", "max").back());
    std::filesystem::remove(folder / "e.h5");
  }
}

TEST_F(InitialStates, CanBeProved) {
  for (const std::string& scene : random_scenes) {
    write("s.toml", scene);
    shell("cradle certify s.toml --quiet --force -o proved.h5", 0);
  }
}

TEST_F(InitialStates, WallsOfAGasFollowFromNumberAndDensity) {
  const auto wall = [](const std::string& scene, bool right) {
    const tools::Scene read = tools::parse_scene(scene, "s.toml");
    return (right ? read.walls.right : read.walls.left).position->text;
  };
  EXPECT_EQ(wall(gas, false), "0");
  EXPECT_EQ(wall(gas, true), "60");
  EXPECT_EQ(wall(gas + "initial.density = 0.8\nwalls.left.position = -5\n", true), "70");
  EXPECT_EQ(wall(gas + "initial.density = 9\n", true), "6.666666666666666666666666666666666666667");
  EXPECT_EQ(wall(gas + "walls.right.position = 7\n", true), "7");
  // What a result holds reads back as the same scene.
  for (const std::string density : {"", "initial.density = 9\n"}) {
    const tools::Scene scene = tools::parse_scene(gas + density, "s.toml");
    EXPECT_TRUE(tools::parse_scene(effective_toml(scene), "s.toml") == scene);
  }
  // Elastic walls keep the energy; positions stay between them.
  const tools::Result elastic = result_of(gas + output, "--set law.restitution=1");
  const auto energy = numbers(elastic, "series", "energy");
  EXPECT_NEAR(energy.back(), energy.front(), 1e-12 * energy.front());
  for (const std::string snapshot : {"snapshots/0000", "snapshots/0001"}) {
    const auto x = numbers(elastic, snapshot, "x");
    ASSERT_EQ(x.size(), 60U);
    EXPECT_GT(x.front(), 0);
    EXPECT_LT(x.back(), 60);
  }
}

TEST_F(InitialStates, LastStateOfAnotherResultContinuesIt) {
  const std::string ring = bouncing + "initial = { type = 'ring', particles = 50, masses = [1, 2] }\n";
  for (const std::string& scene : {gas + output, ring + output})
    for (const bool wide : {false, true}) {
      const std::string precision = wide ? "--set run.precision=double-double " : "";
      const tools::Result whole = result_of(scene, precision + "--set run.until=8 --set output.snapshots=[4,8]");
      result_of(scene, precision);
      shell("mv result.h5 first.h5", 0);
      const tools::Result second = result_of(
          "law = { type = 'inelastic', restitution = 0.95, cutoff = 1e-3 }\nrun = { start = 4, until = 8 }\n"
          "initial = { type = 'list', file = 'first.h5' }\noutput = { snapshots = [8], series.points = 3 }\n" +
              std::string(has(scene, "'gas'") ? "walls = { left.position = 0, right.position = 60 }\n" : ""),
          precision);
      for (const std::string column : {"x", "v", "m"}) {
        const auto of_whole = numbers(whole, "snapshots/0001", column),
                   of_second = numbers(second, "snapshots/0000", column);
        ASSERT_EQ(of_whole.size(), of_second.size());
        // Positions up to 60 are rounded where one run ends, and at each of some hundred collisions after that.
        for (std::size_t k = 0; k < of_whole.size(); ++k)
          EXPECT_NEAR(of_second[k], of_whole[k], wide ? 1e-14 : 1e-11) << column;
      }
      EXPECT_GT(numbers(second, "series", "energy").back(), 0);
    }
}

}  // namespace cradle::tests::initial_states_test
