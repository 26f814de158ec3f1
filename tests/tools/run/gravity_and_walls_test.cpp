// Gravity and shaken walls in scenes: the account of energy in a result, with balls that rest on a floor. (The same
// bits on any number of threads, free fall: tests/tools/run/outputs.txt. Bad input: tests/tools/messages.txt.)
#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::gravity_and_walls_test {

using tools::Result;

const std::string law = "law = { type = 'inelastic', restitution = 0.95, cutoff = 0.01 }\n";
const std::string beads = "initial = { type = 'list', x = [1, 2, 3.5, 4, 6], v = [0.5, 0, -1, 0, 0.25] }\n";
const std::string ball = "initial = { type = 'list', x = [1], v = [0.5] }\n";
const std::string falls = "gravity.acceleration = -0.5\n";
const std::string output = "run.until = 12\noutput = { series.points = 49, snapshots = [0, 3, 12], events = true }\n";
std::string floor_of(const std::string& motion, const std::string& more = "restitution = 0.9") {
  return "walls.left = { position = 0, motion = '" + motion + "', amplitude = 0.25, frequency = 3, phase = 0.5, " +
         more + " }\n";
}
const std::string falling = law + beads + falls + "walls.left = { position = 0, restitution = 0.9 }\n" + output;
const std::string between = law +
                            "initial = { type = 'gas', particles = 40, perturbation = 0.2 }\nrun.until = 6\n"
                            "gravity.acceleration = 0.25\nwalls.right.temperature = 2\noutput.snapshots = [6]\n"
                            "output.series.points = 7\noutput.profiles = { times = [5], bins = 4, range = [0, 40] }\n";
std::string shaken(const std::string& floor) { return law + beads + falls + floor + output; }

using GravityAndWalls = ProgramTest;

TEST_F(GravityAndWalls, TheAccountOfEnergyBalances) {
  for (const std::string& scene :
       {falling, between, falling + "run.coordinates = 'absolute'\n", shaken(floor_of("sine")),
        shaken(floor_of("sawtooth")), shaken(floor_of("parabola")),
        shaken(floor_of("sine")) + "run.coordinates = 'absolute'\n", law + beads + floor_of("sine") + output,
        law + ball + falls + floor_of("sine", "restitution = 0.25, rest_speed = 0.2") + output,
        shaken(floor_of("sine", "restitution = 0.9, rest_speed = 0.1"))}) {
    SCOPED_TRACE(scene);
    const Result result = result_of(scene);
    const auto of = [&](const std::string& name) { return numbers(result, "series", name); };
    const std::string wall = has(scene, "walls.left") ? "wall_left_" : "wall_right_";
    const auto kinetic = of("energy"), lost = of("energy_lost"), given = of(wall + "energy");
    const auto potential = has(scene, "gravity") ? of("potential_energy") : std::vector<double>(kinetic.size());
    EXPECT_GT(numbers<std::uint64_t>(result, "series", wall + "collisions").back(), has(scene, "gravity") ? 2U : 0U);
    if (has(scene, "motion")) {
      EXPECT_NE(given.back(), 0);
    }
    EXPECT_GT(lost.back(), 0);
    const double scale = std::abs(potential[0]) + kinetic[0] + std::abs(given.back());
    for (std::size_t k = 0; k < kinetic.size(); ++k)
      EXPECT_NEAR(kinetic[k] + potential[k] + lost[k] - given[k], kinetic[0] + potential[0], 1e-13 * scale);
    for (const auto& [name, value] : result.attributes)
      if (name == "ledger_error") {
        EXPECT_LT(std::abs(std::get<double>(value)), 1e-13 * scale);
      }
  }
}

// x(t) = A sin(omega t + phi) in [-A, A] at a sample of the wall's own particle: one that rests on it.
TEST_F(GravityAndWalls, ABallAtRestHasTheMotionOfTheFloor) {
  const Result result = result_of(law + ball + "gravity.acceleration = -4\n" +  // A omega^2 = 2.25 < 4
                                  floor_of("sine", "restitution = 0.25, rest_speed = 0.2") + output);
  EXPECT_NEAR(numbers(result, "snapshots/0002", "x").back(), 0.25 * std::sin(36.5), 1e-14);
  EXPECT_NEAR(numbers(result, "snapshots/0002", "v").back(), 0.75 * std::cos(36.5), 1e-14);
  EXPECT_LT(numbers<std::uint64_t>(result, "series", "collisions").back(), 20U);
}

}  // namespace cradle::tests::gravity_and_walls_test
