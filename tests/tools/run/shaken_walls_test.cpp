// Shaken walls in scenes: the account of energy in a result, with a ball that rests on a floor; checkpoints, ensembles,
// threads; all types make the same collisions; bad input says what to do.
#include <cmath>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::shaken_walls_in_scenes_test {

const std::string law = "law = { type = 'inelastic', restitution = 0.95, cutoff = 0.01 }\n";
const std::string beads = "initial = { type = 'list', x = [1, 2, 3.5, 4, 6], v = [0.5, 0, -1, 0, 0.25] }\n";
const std::string ball = "initial = { type = 'list', x = [1], v = [0.5] }\n";
const std::string output = "run.until = 12\noutput = { series.points = 49, snapshots = [0, 3, 12], events = true }\n";
std::string floor_of(const std::string& motion, const std::string& more = "restitution = 0.9") {
  return "walls.left = { position = 0, motion = '" + motion + "', amplitude = 0.25, frequency = 3, phase = 0.5, " +
         more + " }\n";
}
const std::string falls = "gravity.acceleration = -0.5\n";

class ShakenWallsInScenes : public ProgramTest {
 protected:
  void run(const std::string& command, int status = 0) const { shell("cradle " + command, status); }
  std::string refused(const std::string& scene, const std::string& command = "run") const {
    write("refused.toml", scene);
    return shell("cradle " + command + " refused.toml --quiet -o refused.h5", 2).err;
  }
};

TEST_F(ShakenWallsInScenes, TheAccountOfEnergyBalances) {
  const std::string resting = ball + falls + floor_of("sine", "restitution = 0.25, rest_speed = 0.2");
  const std::string pile = beads + falls + floor_of("sine", "restitution = 0.9, rest_speed = 0.1");
  for (const std::string& scene :
       {beads + falls + floor_of("sine"), beads + falls + floor_of("sawtooth"), beads + falls + floor_of("parabola"),
        beads + falls + floor_of("sine") + "run.coordinates = 'absolute'\n", beads + floor_of("sine"), resting, pile}) {
    write("s.toml", law + scene + output);
    run("run s.toml --quiet --force -o s.h5");
    const tools::Result result = read("s.h5");
    const auto of = [&](const char* name) { return numbers(result, "series", name); };
    const auto kinetic = of("energy"), lost = of("energy_lost"), given = of("wall_left_energy");
    const auto potential =
        scene.find("gravity") == scene.npos ? std::vector<double>(kinetic.size()) : of("potential_energy");
    EXPECT_GT(std::abs(given.back()), 0);
    const double scale = std::abs(potential[0]) + kinetic[0] + std::abs(given.back());
    for (std::size_t k = 0; k < kinetic.size(); ++k)
      EXPECT_NEAR(kinetic[k] + potential[k] + lost[k] - given[k], kinetic[0] + potential[0], 1e-13 * scale);
  }
}

// x(t) = A sin(omega t + phi) in [-A, A] at a sample of the wall's own particle: one that rests on it.
TEST_F(ShakenWallsInScenes, ABallAtRestHasTheMotionOfTheFloor) {
  write("s.toml", law + ball + "gravity.acceleration = -4\n" +
                      floor_of("sine", "restitution = 0.25, rest_speed = 0.2") + output);  // A omega^2 = 2.25 < 4
  run("run s.toml --quiet --force -o s.h5");
  const tools::Result result = read("s.h5");
  EXPECT_NEAR(numbers(result, "snapshots/0002", "x").back(), 0.25 * std::sin(36.5), 1e-14);
  EXPECT_NEAR(numbers(result, "snapshots/0002", "v").back(), 0.75 * std::cos(36.5), 1e-14);
  EXPECT_LT(numbers<std::uint64_t>(result, "series", "collisions").back(), 20U);
}

TEST_F(ShakenWallsInScenes, TheSameBitsFromACheckpointAndOnAnyNumberOfThreads) {
  const std::string rest = "restitution = 0.9, rest_speed = 0.1";
  for (const std::string& floor :
       {floor_of("sawtooth"), floor_of("parabola"), floor_of("sine"), floor_of("sine", rest)}) {
    write("s.toml", law + beads + falls + floor + output);
    run("run s.toml --quiet --force -o whole.h5 --threads 1");
    run("run s.toml --quiet --force -o threads.h5 --threads 3");
    expect_same("whole.h5", "threads.h5");
    run("run s.toml --quiet --force -o part.h5 --set run.until=5 --set output.snapshots=[0,3]");
    run("resume part.h5 --until 12 --quiet");
    EXPECT_EQ(numbers(read("part.h5"), "events", "time"), numbers(read("whole.h5"), "events", "time"));
  }
}

TEST_F(ShakenWallsInScenes, TheSameCollisionsInEveryPrecision) {
  write("s.toml", law + beads + falls + floor_of("sine") + output);
  run("run s.toml --quiet --force -o double.h5 --set run.until=6 --set output.snapshots=[6]");
  const tools::Result of_double = read("double.h5");
  for (const std::string precision : {"'long double'", "double-double", "float128", "cpp_bin_float", "mpfr"}) {
    const Printed printed = shell("cradle run s.toml --quiet --force -o wide.h5 --set run.until=6 --set "
                                  "output.snapshots=[6] --set run.precision=" +
                                  precision);
    if (has(printed.err, "not in this build")) continue;
    ASSERT_EQ(printed.status, 0) << printed.err;
    EXPECT_EQ(numbers<std::uint64_t>(read("wide.h5"), "events", "left"),
              numbers<std::uint64_t>(of_double, "events", "left"))
        << precision;
  }
}

TEST_F(ShakenWallsInScenes, Ensembles) {
  write("s.toml", law + "initial = { type = 'gas', particles = 40 }\nrun.until = 6\noutput.series.points = 7\n"
                        "walls.right = { motion = 'sine', amplitude = 0.25, frequency = 3 }\n");
  run("ensemble s.toml --replicas 2 --quiet -o e.h5");
  const auto mean = numbers(read("e.h5"), "ensemble/series/wall_right_energy", "mean");
  double sum = 0;
  for (const std::string k : {"0", "1"}) {
    run("run s.toml --quiet --force -o r.h5 --set initial.replica=" + k);
    sum += numbers(read("r.h5"), "series", "wall_right_energy").back();
  }
  EXPECT_NEAR(mean.back(), sum / 2, 1e-12 * std::abs(sum));
}

TEST_F(ShakenWallsInScenes, BadInputSaysWhatToDo) {
  const std::string until = "run.until = 1\n", scene = law + beads + until;
  EXPECT_TRUE(has(refused(scene + "walls.left = { position = 0, motion = 'sine', amplitude = 1 }\n"),
                  "walls.left.frequency: missing"));
  EXPECT_TRUE(has(refused(scene + "walls.left = { position = 0, motion = 'sine', frequency = 1 }\n"),
                  "walls.left.amplitude: missing"));
  EXPECT_TRUE(has(refused(scene + "walls.left = { position = 0, amplitude = 1 }\n"), "key of a wall that is shaken"));
  EXPECT_TRUE(has(refused(scene + "walls.left = { position = 0, motion = 'wave' }\n"), "sawtooth"));
  // From 0 it is at 1.4 at the start, beyond the first particle.
  EXPECT_TRUE(has(refused(scene + "walls.left = { position = 0, motion = 'sine', amplitude = 2, frequency = 1, "
                                  "phase = 0.8 }\n"),
                  "move it outwards"));
  EXPECT_TRUE(has(refused(scene + "walls.left = { position = 0, motion = 'sine', amplitude = 4, frequency = 1 }\n"
                                  "walls.right = { position = 9, motion = 'sine', amplitude = 6, frequency = 1 }\n"),
                  "walls that can meet"));
  EXPECT_TRUE(has(refused(scene + floor_of("sine", "restitution = 0")), "on which particles come to rest"));
  EXPECT_TRUE(has(refused(scene + floor_of("sine", "rest_speed = 0.1") +
                          "walls.right = { position = 9, motion = 'sine', amplitude = 1, frequency = 1 }\n"),
                  "between two shaken walls"));
  EXPECT_TRUE(has(refused(scene + falls + floor_of("sine", "rest_speed = 0.1") +
                          "walls.right = { position = 9, rest_speed = 1 }\n"),
                  "two walls on which several particles can rest"));
  EXPECT_TRUE(has(refused(law + ball + until + "walls.left = { position = 0, rest_speed = 0.1 }\n"),
                  "key of a wall on which particles can rest"));
  EXPECT_TRUE(has(refused(law + ball + until + "run.coordinates = 'absolute'\n" + floor_of("sine", "rest_speed = 0.1")),
                  "give run.coordinates = \"gaps\""));
  EXPECT_TRUE(
      has(refused(scene + "walls.left = { position = 0, motion = 'sine', amplitude = 0.1, frequency = 1e16 }\n"),
          "more periods"));
  EXPECT_TRUE(has(refused(scene + floor_of("sine"), "certify"), "shaken walls are not provable"));
  const std::string far_apart = "initial = { type = 'list', x = [1, 2], v = [0, 0], m = [1, 1e5] }\n";
  EXPECT_TRUE(has(refused(law + until + far_apart + floor_of("sine")), "run.coordinates = \"absolute\""));
}

}  // namespace cradle::tests::shaken_walls_in_scenes_test
