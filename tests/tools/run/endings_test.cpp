// How runs end: every run ends, or advances in time. (Balls that collapse on floors, and what runs advise at their
// ends: outputs.txt.)
//
// Random scenes with floors, shaken walls, rows, lists and rings, with every collapse policy: CRADLE_ENDINGS=500 makes
// it more.
#include <cstdio>
#include <random>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/run/report.hpp"

namespace cradle::tests::endings_test {

using namespace tools;

using Endings = ProgramTest;

TEST(GuardMessages, BlameNoMachineForWhatPositionsDoNotResolve) {
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
