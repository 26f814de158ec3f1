// Gravity in scenes: the numbers of a result, in every precision and on any number of threads; ensembles; a column in
// free fall is that without gravity; bad input says what to do.
#include <cmath>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tests::gravity_in_scenes_test {

const std::string law = "law = { type = 'inelastic', restitution = 0.95, cutoff = 0.01 }\n";
const std::string falling = law +
                            "initial = { type = 'list', x = [1, 2, 3.5, 4, 6], v = [0.5, 0, -1, 0, 0.25] }\n"
                            "gravity.acceleration = -0.5\nwalls.left = { position = 0, restitution = 0.9 }\n"
                            "run.until = 12\noutput = { series.points = 13, snapshots = [0, 3, 12], events = true }\n";
const std::string between = law +
                            "initial = { type = 'gas', particles = 40, perturbation = 0.2 }\nrun.until = 6\n"
                            "gravity.acceleration = 0.25\nwalls.right.temperature = 2\noutput.snapshots = [6]\n"
                            "output.series.points = 7\noutput.profiles = { times = [5], bins = 4, range = [0, 40] }\n";
const std::string rows = law + "initial = { type = 'rows', particles = 200, perturbation = 0.1 }\nrun.until = 60\n"
                               "output = { series.points = 7, snapshots = [60] }\n";

class GravityInScenes : public ProgramTest {
 protected:
  void run(const std::string& command, int status = 0) const { shell("cradle " + command, status); }
  std::string refused(const std::string& scene, const std::string& command = "run", int status = 2) const {
    write("refused.toml", scene);
    return shell("cradle " + command + " refused.toml --quiet -o refused.h5", status).err;
  }
};

TEST_F(GravityInScenes, TheAccountOfEnergyBalances) {
  for (const std::string& scene : {falling, between, falling + "run.coordinates = 'absolute'\n"}) {
    write("s.toml", scene);
    run("run s.toml --quiet --force -o s.h5");
    const tools::Result result = read("s.h5");
    const auto of = [&](const char* name) { return numbers(result, "series", name); };
    const auto kinetic = of("energy"), potential = of("potential_energy"), lost = of("energy_lost");
    const bool floor_left = scene.find("acceleration = -") != scene.npos;
    const auto given = of(floor_left ? "wall_left_energy" : "wall_right_energy");
    const char* bounces = floor_left ? "wall_left_collisions" : "wall_right_collisions";
    EXPECT_GT(numbers<std::uint64_t>(result, "series", bounces).back(), 2U);
    const double scale = std::abs(potential[0]) + kinetic[0] + std::abs(given.back());
    for (std::size_t k = 0; k < kinetic.size(); ++k)
      EXPECT_NEAR(kinetic[k] + potential[k] + lost[k] - given[k], kinetic[0] + potential[0], 1e-13 * scale);
    EXPECT_GT(lost.back(), 0);
    for (const auto& [name, value] : result.attributes)
      if (name == "ledger_error") {
        EXPECT_LT(std::abs(std::get<double>(value)), 1e-13 * scale);
      }
  }
}

// x = 1 - t^2/4 and 4 + t/2 - t^2/4; the potential energy is half of their sum.
TEST_F(GravityInScenes, APositionIsQuadratic) {
  write("s.toml", law + "initial = { type = 'list', x = [1, 4], v = [0, 0.5] }\ngravity.acceleration = -0.5\n"
                        "run.until = 4\noutput = { series.times = [0, 4], snapshots = [4] }\n");
  run("run s.toml --quiet --force -o s.h5");
  const tools::Result result = read("s.h5");
  EXPECT_EQ(numbers(result, "snapshots/0000", "x"), (std::vector<double>{-3, 2}));
  EXPECT_EQ(numbers(result, "snapshots/0000", "v"), (std::vector<double>{-2, -1.5}));
  EXPECT_EQ(numbers(result, "series", "potential_energy"), (std::vector<double>{2.5, -0.5}));
  EXPECT_EQ(numbers(result, "series", "energy"), (std::vector<double>{0.125, 3.125}));
}

TEST_F(GravityInScenes, AColumnInFreeFallHasTheGapsOfOneAtRest) {
  write("s.toml", rows);
  run("run s.toml --quiet --force -o rest.h5");
  run("run s.toml --quiet --force -o fall.h5 --set gravity.acceleration=-3");
  run("run s.toml --quiet --force -o none.h5 --set gravity.acceleration=0");
  const tools::Result rest = read("rest.h5"), fall = read("fall.h5"), none = read("none.h5");
  for (const char* name : {"gap", "closing_speed"}) {
    EXPECT_EQ(numbers(fall, "snapshots/0000", name), numbers(rest, "snapshots/0000", name));
    EXPECT_EQ(numbers(none, "snapshots/0000", name), numbers(rest, "snapshots/0000", name));
  }
  EXPECT_EQ(numbers<std::uint64_t>(fall, "series", "collisions"), numbers<std::uint64_t>(rest, "series", "collisions"));
  const auto x = numbers(fall, "snapshots/0000", "x"), still = numbers(rest, "snapshots/0000", "x");
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], still[k] - 1.5 * 3600, 1e-11);
  EXPECT_EQ(numbers(none, "series", "energy"), numbers(rest, "series", "energy"));
  EXPECT_FALSE(has(shell("cradle export none.h5 --to none && cat none/series.csv", 0).out, "potential"));
}

TEST_F(GravityInScenes, TheSameOnAnyNumberOfThreads) {
  write("s.toml", between);
  const std::string many = "run s.toml --quiet --force --set initial.particles=3000 --set run.until=2 ";
  run(many + "--threads 1 -o one.h5");
  run(many + "--threads 3 -o three.h5");
  expect_same("one.h5", "three.h5");
}

TEST_F(GravityInScenes, TheSameCollisionsInEveryPrecision) {
  write("s.toml", falling);
  run("run s.toml --quiet --force -o double.h5 --set run.until=6 --set output.snapshots=[6]");
  const tools::Result of_double = read("double.h5");
  for (const std::string precision : {"'long double'", "double-double", "float128", "cpp_bin_float", "mpfr"}) {
    const std::string wide_run =
        "cradle run s.toml --quiet --force -o wide.h5 --set run.until=6 --set output.snapshots=[6] ";
    const Printed printed = shell(wide_run + "--set run.precision=" + precision);
    if (has(printed.err, "not in this build")) continue;
    ASSERT_EQ(printed.status, 0) << printed.err;
    const tools::Result wide = read("wide.h5");
    EXPECT_EQ(numbers<std::uint64_t>(wide, "events", "left"), numbers<std::uint64_t>(of_double, "events", "left"))
        << precision;
    const auto x = numbers(wide, "snapshots/0000", "x"), wanted = numbers(of_double, "snapshots/0000", "x");
    for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], wanted[k], 1e-12) << precision;
  }
}

TEST_F(GravityInScenes, Ensembles) {
  write("s.toml", between);
  run("ensemble s.toml --replicas 3 --quiet -o e.h5");
  const auto mean = numbers(read("e.h5"), "ensemble/series/potential_energy", "mean");
  double sum = 0;
  for (const std::string k : {"0", "1", "2"}) {
    run("run s.toml --quiet --force -o r.h5 --set initial.replica=" + k);
    sum += numbers(read("r.h5"), "series", "potential_energy").back();
  }
  EXPECT_NEAR(mean.back(), sum / 3, 1e-12 * std::abs(sum));
}

TEST_F(GravityInScenes, BadInputSaysWhatToDo) {
  const std::string until = "run.until = 1\ngravity.acceleration = -1\n",
                    list = "initial = { type = 'list', x = [1, 2], v = [0, 0] }\n";
  EXPECT_TRUE(has(refused(law + until + "initial.type = 'ring'\n"), "gravity on a ring, which has no ends to fall to"));
  EXPECT_TRUE(has(refused(law + until + list + "walls.left.position = 1.5\n"), "move it outwards"));
  EXPECT_TRUE(has(refused(law + until + list + "walls.left = { position = 0, restitution = 0 }\n"),
                  "a floor on which particles come to rest"));
  EXPECT_TRUE(has(refused(law + until + list + "run.collapse = 'merge'\nrun.merge_speed = 1\n"),
                  "gravity on particles that merge"));
  EXPECT_TRUE(has(refused("law = { type = 'wet', loss = 1 }\n" + until + list), "key of another law"));
  EXPECT_TRUE(has(refused(law + until + "initial.type = 'rows'\noutput.core = true\n"), "nothing to compare"));
  const std::string far_apart = "initial = { type = 'list', x = [1, 2], v = [0, 0], m = [1, 1e5] }\n";
  EXPECT_TRUE(has(refused(law + until + far_apart), "run.coordinates = \"absolute\" or run.precision"));
  write("s.toml", law + until + far_apart);
  run("run s.toml --quiet --force -o a.h5 --set run.coordinates=absolute");
  run("run s.toml --quiet --force -o b.h5 --set run.precision=double-double");
}

}  // namespace cradle::tests::gravity_in_scenes_test
