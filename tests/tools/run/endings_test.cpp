// How runs end. Every run ends, or advances in time. A ball that falls on an inelastic floor collapses at a known time,
// in every type and in all coordinates. (What a run advises at its end is followed in outputs.txt.)
//
// Random scenes with floors, shaken walls, rows, lists and rings, with every collapse policy: CRADLE_ENDINGS=500 makes
// it more.
#include <cstdio>
#include <random>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/run/report.hpp"

namespace cradle::tests::endings_test {

using namespace tools;

class Endings : public ProgramTest {
 protected:
  // Dropped from h on a floor of restitution r, it comes to rest at sqrt(2 h/g) (1 + r)/(1 - r).
  void write_ball(const std::string& x = "[37]", const std::string& v = "[0]") const {
    write("ball.toml", "law = { type = 'inelastic', restitution = 0.7 }\ngravity.acceleration = -9.81\n"
                       "walls.left = { position = 0, restitution = 0.7 }\nrun.until = 30\n"
                       "initial = { type = 'list', x = " +
                           x + ", v = " + v + " }\n");
  }
  Printed run(const std::string& scene, const std::string& more, int status) const {
    return shell("timeout 60 cradle run " + scene + " --quiet --force -o end.h5 " + more, status);
  }
  double of_collapse(const char* name) const {
    return tools::attribute<double>(read("end.h5").find("collapse")->attributes, name, "");
  }
};

constexpr double at_rest = 15.5635628146137;

TEST_F(Endings, AStopGapEndsACollapseOnAFloor) {
  write_ball();
  for (const char* type : {"double", "double-double", "mpfr"})
    for (const char* coordinates : {"gaps", "absolute"})
      for (const double gap : {1e-6, 1e-12, 1e-300}) {
        const std::string set = fmt::format("--set run.precision={} --set run.coordinates={} --set run.stop_gap={}",
                                            type, coordinates, gap);
        SCOPED_TRACE(set);
        const Printed end = run("ball.toml", set, 3);
        EXPECT_TRUE(has(end.out, "between the left wall and particle 0")) << end.out;
        // The flights left out last 4 sqrt(2 h/g)/(1 - r) in all, for heights below the gap: with r = 0.7, 7 sqrt(h).
        EXPECT_NEAR(of_collapse("time"), at_rest, 7 * std::sqrt(gap) + 1e-13);
        EXPECT_LT(of_collapse("gap"), gap);
      }
  write_ball("[37, 80]", "[0, 0]");
  run("ball.toml", "--set run.stop_gap=1e-12", 3);
}

TEST_F(Endings, TheEnergyAtTheEndIsThatAfterTheLastCollision) {
  write_ball();
  run("ball.toml", "--set run.stop_gap=1e-28 --set output.snapshots=[]", 3);
  const tools::Result result = read("end.h5");
  EXPECT_EQ(numbers(result, "snapshots/0000", "x").back(), 0);
  EXPECT_EQ(numbers(result, "series", "potential_energy").back(), 0);
  const auto n = static_cast<double>(numbers<std::uint64_t>(result, "series", "collisions").back());
  const double energy = 9.81 * 37 * std::pow(0.49, n);  // each of n factors is rounded
  EXPECT_NEAR(numbers(result, "series", "energy").back(), energy, 1e-13 * n * energy);
}

// A floor on which flights become too short for positions to resolve: the ball stays on it.
TEST_F(Endings, NoBallFallsThroughAFloorInPositions) {
  write("floor.toml", "law = { type = 'inelastic', restitution = 0.5 }\ngravity.acceleration = -1\n"
                      "walls.left = { position = 0, restitution = 0.3, speed = -0.05 }\nrun.until = 20\n"
                      "initial = { type = 'list', x = [1], v = [0] }\nrun.coordinates = 'absolute'\n");
  for (const char* more :
       {"", "--set walls.left.speed=0 --set walls.left.motion=sine",
        "--set walls.left.speed=0 --set walls.left.motion=parabola",
        "--set walls.left.speed=0 --set walls.left.motion=sawtooth --set run.precision=double-double"}) {
    const bool shaken = has(more, "motion");
    const std::string set =
        std::string(more) + (shaken ? " --set walls.left.amplitude=0.01 --set walls.left.frequency=1" : "");
    SCOPED_TRACE(set);
    const Printed end = run("floor.toml", set, 5);
    EXPECT_TRUE(has(end.err, "resolution exhausted")) << end.err;
    const double x = numbers(read("end.h5"), "snapshots/0000", "x").back(),
                 t = numbers(read("end.h5"), "series", "time").back();
    EXPECT_NEAR(x, shaken ? 0 : -0.05 * t, shaken ? 0.0100001 : 1e-12);
    if (!shaken) {
      EXPECT_NEAR(t, 2.678, 1e-3);
    }
    run("floor.toml", set + " --set run.coordinates=gaps --set walls.left.rest_speed=1e-6", 0);
  }
}

// Three light particles collapse on a shaken floor, and positions resolve it no more.
TEST_F(Endings, NoMachineIsBlamedForWhatPositionsDoNotResolve) {
  write("light.toml", "law = { type = 'inelastic', restitution = 0.5 }\ngravity.acceleration = -9.81\n"
                      "walls.left = { position = 0, restitution = 0.9, motion = 'sawtooth', amplitude = 1.38, "
                      "frequency = 1 }\nrun = { until = 5, coordinates = 'absolute' }\noutput.series.points = 2\n"
                      "[initial]\ntype = 'list'\nx = [1.5917767517736003, 2.5121005053009196, 3.2588909230667196]\n"
                      "v = [0.4039078223793515, 0.4791866190943306, 0.7572508058793073]\n"
                      "m = [1.058586928910443e-5, 5.389717704708046e-5, 2.0298264508275672e-5]\n");
  const Printed end = run("light.toml", "", 5);
  EXPECT_FALSE(has(end.err, "at fault")) << end.err;
  EXPECT_TRUE(has(end.err, "run.coordinates = \"gaps\"")) << end.err;
  tools::Run positions;
  positions.coordinates = Coordinates::absolute;
  Account<Number> unresolved;
  unresolved.unresolved = 1;
  const ReportedGuard energy{Guard::energy, 1, 0, -1, {}}, wall{Guard::wall, -1, 0, 0, {}};
  EXPECT_FALSE(has(guard_message(energy, unresolved, positions), "at fault"));
  EXPECT_FALSE(has(guard_message(wall, {}, positions), "at fault"));
  EXPECT_TRUE(has(guard_message(energy, {}, positions), "at fault")) << "all was resolved";
  EXPECT_TRUE(has(guard_message(wall, unresolved, tools::Run()), "at fault")) << "gaps resolve it";
}

struct Reached {
  double time = 0, collisions = 0;
  explicit Reached(const Printed& interrupted) {
    const auto at = interrupted.err.find("interrupted: t = ");
    if (at != std::string::npos) std::sscanf(&interrupted.err[at], "interrupted: t = %lf, %lf", &time, &collisions);
  }
};
// With 48 particles and less so many collisions may follow each other at one time (pacing.hpp).
constexpr double most_at_one_time = (1 << 20) + 4096. * 48 * 48;

// A scene of any kind. (The engine is specified bit by bit, and so are these numbers.)
std::string random_scene(std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  };
  const auto one_of = [&](const auto&... choices) {
    const std::string all[] = {std::string(choices)...};
    return all[bits() % sizeof...(choices)];
  };
  const std::string kind = one_of("list", "list", "list", "rows", "ring"),
                    policy = one_of("cutoff", "contact-time", "merge", "stop", "stop", "");
  const auto particles = 1 + bits() % (kind == "list" ? 6 : 24);
  const bool merge = policy == "merge";
  std::string text = fmt::format("law = {{ type = 'inelastic', restitution = {}{} }}\n",
                                 one_of("1", "0.95", "0.7", "0.3", "0.05", "0"),
                                 policy == "cutoff" ? ", cutoff = " + one_of("1e-1", "1e-3", "1e-9", "1e-200") : "");
  text += fmt::format("[run]\nuntil = {:.3g}\n", uniform(1, 8));
  if (!policy.empty()) text += "collapse = '" + policy + "'\n";
  if (policy == "contact-time") text += "contact_time = " + one_of("1e-1", "1e-3", "1e-9") + "\n";
  if (merge) text += "merge_speed = " + one_of("1e-1", "1e-3", "1e-9") + "\n";
  if (policy == "stop" && bits() % 3 > 0) text += "stop_gap = " + one_of("1e-3", "1e-9", "1e-30", "1e-300") + "\n";
  const bool absolute = kind != "ring" && !merge && bits() % 3 == 0;
  if (absolute) text += "coordinates = 'absolute'\n";
  if (bits() % 6 == 0) text += "precision = 'double-double'\n";
  if (kind == "ring") {
    text += fmt::format("[initial]\ntype = 'ring'\nparticles = {}\nlength = {}\n", particles + 1, particles + 1);
    return text;
  }
  if (kind == "rows") {
    text += fmt::format("[initial]\ntype = 'rows'\nparticles = {}\nperturbation = {:.3g}\n", 2 * particles,
                        uniform(0, 0.49));
  } else {
    std::string x, v, m;
    double at = uniform(0.1, 2);
    for (std::uint64_t k = 0; k < particles; ++k, at += uniform(0.01, 1)) {
      x += fmt::format("{}{:.6g}", k > 0 ? ", " : "", at);
      v += fmt::format("{}{:.6g}", k > 0 ? ", " : "", uniform(-1, 1));
      m += fmt::format("{}{:.6g}", k > 0 ? ", " : "", std::pow(10, uniform(-3, 0)));
    }
    text += fmt::format("[initial]\ntype = 'list'\nx = [{}]\nv = [{}]\n", x, v);
    if (bits() % 3 == 0) text += "m = [" + m + "]\n";
  }
  if (merge) return text;
  const bool gravity = bits() % 3 > 0;
  if (gravity) text += "[gravity]\nacceleration = " + one_of("-9.81", "-1", "-1e-3", "1") + "\n";
  const double far = kind == "rows" ? static_cast<double>(particles) + 2 : 10;
  bool rests = false;
  for (const bool left : {true, false}) {
    if (bits() % (left ? 8 : 3) == 0 || (kind == "rows" && bits() % 2 == 0)) continue;
    const double place = left ? kind == "rows" ? -far : uniform(-0.5, 0) : far;
    text += fmt::format("[walls.{}]\nposition = {:.3g}\nrestitution = {}\n", left ? "left" : "right", place,
                        one_of("1", "0.9", "0.5", "0.1"));
    const std::string motion = one_of("", "", "sine", "parabola", "sawtooth");
    if (!motion.empty())
      text += fmt::format("motion = '{}'\namplitude = {:.3g}\nfrequency = {}\n", motion, uniform(0.001, 0.05),
                          one_of("1", "10", "100"));
    else if (bits() % 3 == 0)
      text += fmt::format("speed = {:.3g}\n", left ? uniform(-0.1, 0) : uniform(0, 0.1));
    if (!absolute && !rests && (gravity || !motion.empty()) && bits() % 4 == 0)
      text += "rest_speed = 1e-4\n", rests = true;
  }
  return text;
}

TEST_F(Endings, NoRunStaysAtOneTime) {
  const char* wanted = std::getenv("CRADLE_ENDINGS");
  const int scenes = wanted != nullptr ? std::atoi(wanted) : 40;
  int refused = 0;
  for (int seed = 0; seed < scenes; ++seed) {
    const std::string scene = random_scene(static_cast<std::uint64_t>(seed));
    write("scene.toml", scene);
    const auto for_seconds = [&](int seconds) {
      return shell(fmt::format("timeout -s INT {} cradle run scene.toml --force -o end.h5", seconds));
    };
    const Printed end = for_seconds(wanted != nullptr ? 60 : 10);
    EXPECT_NE(end.status, 1) << seed << "\n" << scene << end.err;
    // A run may have very many collisions; then its time advances. Interrupted it says how far it has come.
    if (const Reached late(end); end.status == 124 && late.collisions > most_at_one_time) {
      EXPECT_LT(Reached(for_seconds(2)).time, late.time) << seed << ": at one time\n" << scene << end.err;
    }
    EXPECT_FALSE(has(end.err, "is at fault")) << seed << "\n" << scene << end.err;
    refused += end.status == 2;
    if (end.status == 2 && wanted != nullptr) std::puts((std::to_string(seed) + " " + end.err).c_str());
  }
  EXPECT_LE(refused, scenes / 4) << "few are scenes that the program refuses";
}

}  // namespace cradle::tests::endings_test
