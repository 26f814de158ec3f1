// Scenes with random initial states, a gas between walls, and the last state of another result: the same bytes on any
// number of threads, the same particles in every precision, proofs, continuation of another run, refusals.
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

class InitialStates : public ProgramTest {
 protected:
  void run(const std::string& command, int status = 0) const { shell("cradle " + command, status); }
  std::string refused(const std::string& scene, int status = 2) const {
    write("refused.toml", scene);
    return shell("cradle run refused.toml --quiet --force -o refused.h5", status).err;
  }
};

TEST_F(InitialStates, AreTheSameInEveryPrecision) {
  for (const std::string& scene : random_scenes) {
    write("s.toml", scene);
    run("run s.toml --quiet --force -o double.h5");
    const auto of_double = numbers(read("double.h5"), "snapshots/0000", "x");
    ASSERT_GT(of_double.size(), 1U);
    for (const std::string precision : {"'long double'", "double-double", "float128", "cpp_bin_float", "mpfr"}) {
      run("run s.toml --quiet --force -o wide.h5 --set run.precision=" + precision);
      const auto wide = numbers(read("wide.h5"), "snapshots/0000", "x");
      ASSERT_EQ(wide.size(), of_double.size()) << precision;
      // A unit, a product, an end of the gas: of numbers up to the greatest position.
      const double most = std::max(std::abs(wide.front()), std::abs(wide.back()));
      for (std::size_t k = 0; k < wide.size(); ++k) ASSERT_NEAR(wide[k], of_double[k], 4 * 0x1p-52 * most) << precision;
    }
  }
}

TEST_F(InitialStates, AreTheSameOnAnyNumberOfThreads) {
  for (const std::string& scene : random_scenes) {
    write("s.toml", scene);
    const std::string many = "run s.toml --quiet --force --set initial.particles=4000 --set run.until=4 ";
    run(many + "--threads 1 -o one.h5");
    run(many + "--threads 3 -o three.h5");
    expect_same("one.h5", "three.h5");
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
    if (has(scene, "'gas'")) continue;  // walls have no proof
    write("s.toml", scene);
    run("certify s.toml --quiet --force -o proved.h5");
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
  write("s.toml", gas + output);
  run("run s.toml --quiet --force --set law.restitution=1 -o a.h5");
  const auto energy = numbers(read("a.h5"), "series", "energy");
  EXPECT_NEAR(energy.back(), energy.front(), 1e-12 * energy.front());
  for (const std::string snapshot : {"snapshots/0000", "snapshots/0001"}) {
    const auto x = numbers(read("a.h5"), snapshot, "x");
    ASSERT_EQ(x.size(), 60U);
    EXPECT_GT(x.front(), 0);
    EXPECT_LT(x.back(), 60);
  }
}

TEST_F(InitialStates, LastStateOfAnotherResultContinuesIt) {
  const std::string long_gas = gas + "run.until = 8\noutput = { snapshots = [4, 8], series.points = 3 }\n";
  const std::string long_ring = bouncing + "initial = { type = 'ring', particles = 50, masses = [1, 2] }\n" +
                                "output = { snapshots = [4, 8], series.points = 3 }\n";
  for (std::string scene : {long_gas, long_ring}) {
    scene.erase(scene.find("run.until = 4\n"), 14);
    if (!has(scene, "run.until = 8")) scene += "run.until = 8\n";
    const bool walls = has(scene, "'gas'");
    for (const bool wide : {false, true}) {
      const std::string precision = wide ? " --set run.precision=double-double" : "";
      write("s.toml", scene);
      run("run s.toml --quiet --force -o whole.h5" + precision);
      run("run s.toml --quiet --force --set run.until=4 -o first.h5" + precision);
      write("t.toml",
            "law = { type = 'inelastic', restitution = 0.95, cutoff = 1e-3 }\nrun = { start = 4, until = 8 }\n" +
                std::string("initial = { type = 'list', file = 'first.h5' }\n") +
                "output = { snapshots = [8], series.points = 3 }\n" +
                (walls ? "walls = { left.position = 0, right.position = 60 }\n" : ""));
      run("run t.toml --quiet --force -o second.h5" + precision);
      for (const std::string column : {"x", "v", "m"}) {
        const auto whole = numbers(read("whole.h5"), "snapshots/0001", column),
                   second = numbers(read("second.h5"), "snapshots/0000", column);
        ASSERT_EQ(whole.size(), second.size());
        // Positions up to 60 are rounded where one run ends, and at each of some hundred collisions after that.
        for (std::size_t k = 0; k < whole.size(); ++k) EXPECT_NEAR(second[k], whole[k], wide ? 1e-14 : 1e-11) << column;
      }
      EXPECT_EQ(numbers(read("second.h5"), "series", "energy").back() > 0, true);
    }
  }
}

TEST_F(InitialStates, RefusalsSayWhatToDo) {
  const std::string list = bouncing + "initial = { type = 'list', file = 'other.h5' }\n";
  write("other.toml", "law = { type = 'inelastic', restitution = 1 }\nrun.until = 3\n"
                      "initial = { type = 'rows', particles = 100 }\noutput.series.points = 3\n");
  run("run other.toml --quiet --force -o other.h5");
  EXPECT_TRUE(has(refused(list), "other.h5: snapshots: a result without a state of its particles (found no snapshot): "
                                 "run its scene with output.snapshots at the time that is to be taken"));
  run("run other.toml --quiet --force --set output.snapshots=[2] -o other.h5");
  EXPECT_TRUE(
      has(refused(list), "other.h5: snapshots/0000: particles that no collision has reached are not in it (found "));
  write("other.h5", "\x89HDF");
  EXPECT_TRUE(has(refused(list, 4), "other.h5"));
  std::string sticky = gas;
  sticky.replace(0, sticky.find('\n'), "law.type = 'sticky'");
  EXPECT_TRUE(has(refused(sticky), "refused.toml:3: initial.type: a gas between walls needs a law that bounces (found "
                                   "law.type = \"sticky\"): give law.type = \"inelastic\" or another initial state"));
  EXPECT_TRUE(
      has(refused(gas + "initial.density = 2\nwalls.right.position = 7\n"),
          "refused.toml:6: initial.density: a density and both walls (found density 2, walls at 0 and 7): remove "
          "initial.density or walls.right.position"));
  EXPECT_TRUE(has(refused(gas + "walls.right.position = -7\n"),
                  "walls.right.position: walls without room for a gas (found from 0 to -7): "));
  EXPECT_TRUE(
      has(refused(gas + "initial.perturbation = 0.1\n"),
          "initial.perturbation: key of another initial state (found initial.positions = \"poisson\"): remove it, "));
  EXPECT_TRUE(
      has(refused(gas + "initial.random_masses = [2, 1]\n"),
          "initial.random_masses: not a range of masses (found from 2 to 1): give two masses, the smaller one"));
  EXPECT_TRUE(
      has(refused(gas + "initial.random_masses = [0, 1]\n"), "initial.random_masses: out of range (found 0): "));
  EXPECT_TRUE(has(refused(gas + "initial.random_masses = [1, 2]\ninitial.masses = [1, 2]\n"),
                  "initial.random_masses: two ways to give masses (found initial.masses too): remove one of them"));
  EXPECT_TRUE(
      has(refused(cold + "positions = 'poison' }\n"), "no such choice (found \"poison\"): give one of lattice, "));
  EXPECT_TRUE(has(refused(cold + "place = 'left' }\ninitial.density_exponent = 1\n", 2), "refused.toml"));
  EXPECT_TRUE(has(refused(bouncing + "initial = { type = 'cold', density_exponent = 1 }\n"),
                  "initial.density_exponent: out of range (found 1): "));
  EXPECT_TRUE(has(refused(bouncing + "initial = { type = 'cold', density_exponent = 0.999 }\n"), "have no distance"));
}

}  // namespace cradle::tests::initial_states_test
