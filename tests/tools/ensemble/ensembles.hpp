#pragma once
// Small scenes for ensembles, and functions that read their files.

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tests {

using tools::attribute;
using tools::Column;
using tools::Exit;
using tools::read_result;
using tools::Result;
using tools::Scene;

inline constexpr const char* shock = R"(
law = { type = "inelastic", restitution = 0.99, cutoff = 1e-5 }
initial = { type = "rows", particles = 300, speed = 0.5, perturbation = 0.05 }
run.until = 200
[output]
series = { points = 50 }
snapshots = [100]
profiles = { times = [50, 100], bins = 20, range = [-30, 30] }
averages = { every = 1.5, bins = 4, range = [-30, 30] }
histograms = ["free_flight", "cluster"]
correlations = { every = 3, longest = 60, tag_every = 5 }
structure = { every = 50, times = [120], waves = 12, length = 300 }
counting = { from = 40, range = [0.01, 10], every = 50, cluster_gap = 0.1 }
)";

// Two of the three particles collapse before `until`, at a time that depends on the replica.
inline constexpr const char* collapse = R"(
law = { type = "inelastic", restitution = 0.05 }
initial = { type = "rows", particles = 4, speed = 1, perturbation = 0.4 }
run = { until = 2, collapse = "stop" }
output.series = { points = 41 }
output.profiles = { times = [0.5, 1.5], bins = 2, range = [-2, 2] }
)";

// Has two columns for clusters (left and right), empty until there are clusters; and an average over the interaction
// zone.
inline constexpr const char* wet = R"(
law = { type = "wet", loss = 0.05 }
initial = { type = "rows", particles = 400, speed = 0.5, perturbation = 0.05 }
run.until = 380
output.series = { points = 20 }
output.profiles = { times = [300], bins = 10, range = [-20, 20] }
output.zone = { from = 200, samples = 16, bins = 8 }
)";

// A gas that falls between a hot wall and a shaken one, with all measurements.
inline constexpr const char* falling = R"(
law = { type = "inelastic", restitution = 0.95, cutoff = 0.1 }
initial = { type = "gas", particles = 50, perturbation = 0.2 }
gravity.acceleration = -0.1
walls.left.temperature = 2
walls.right = { motion = "sine", amplitude = 0.25, frequency = 3, restitution = 0.9 }
run.until = 8
[output]
series = { points = 3 }
snapshots = [4]
every_replica = true
profiles = { times = [4], bins = 10, range = [0, 50] }
averages = { every = 0.2, bins = 7, range = [0, 50] }
histograms = ["free_flight", "closing_speed", "dissipative_closing_speed", "collisions_per_particle", "gap", "cluster"]
correlations = { every = 0.25 }
structure = { every = 2, times = [1, 7], waves = 20 }
pair_distribution = { every = 2, times = [1, 7], distance = 3 }
counting = { from = 2, until = 7, every = 2.5, cluster_gap = 0.1 }
)";

constexpr std::uint64_t endless_replicas = 1'000'000'000'000;

class Ensembles : public ProgramTest {
 protected:
  Ensembles() {
    write("wet.toml", wet);
    write("shock.toml", shock);
    write("collapse.toml", collapse);
    write("falling.toml", falling);
  }

  Scene scene(const std::string& name) const { return tools::read_scene(path(name)); }

  void run(const std::string& command, int status = 0) const { shell("cradle " + command, status); }

  // One more than the largest index of a replica in the journals of an endless ensemble: an ensemble of that size
  // contains all of them and one that is missing.
  std::string enough_for(const std::string& file) const {
    // Reads copies, since reading the journals of ranks removes them.
    std::filesystem::create_directory(folder / "copies");
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().filename().string().starts_with(file + ".part"))
        std::filesystem::copy(entry.path(), folder / "copies", std::filesystem::copy_options::overwrite_existing);
    tools::EnsembleStore store(tools::ensemble_of(scene("shock.toml")), path("copies/" + file));
    store.load();
    const auto missing = store.states()[0]->replicas().missing({0, endless_replicas});
    return std::to_string(missing.back().first + 1);
  }

  // The journals of an endless ensemble are continued to the same bytes as without an interruption. Returns what the
  // program printed.
  Printed expect_continued(const std::string& file) const {
    const std::string all = " --replicas " + enough_for(file);
    run("ensemble shock.toml -o whole.h5" + all);
    const Printed go_on = shell("cradle ensemble shock.toml --threads 2 -o " + file + all, 0);
    expect_same("whole.h5", file);
    EXPECT_FALSE(exists(file + ".part"));
    return go_on;
  }

  // Of a column of real or of whole numbers.
  static std::vector<double> numbers(const Result& result, std::string_view group, std::string_view name) {
    const tools::Numbers& values = column(result, group, name).values;
    if (const auto* whole = std::get_if<std::vector<std::uint64_t>>(&values)) return {whole->begin(), whole->end()};
    return std::get<std::vector<double>>(values);
  }
};

// Runs an endless ensemble until its journal has grown by some replicas; then sends it a signal.
inline std::string until_journalled(const std::string& file, const std::string& signal, const std::string& more = "") {
  return "size() { stat -c %s " + file + ".part 2>/dev/null || echo 0; }; enough=$(($(size) + 300000)); " +
         "cradle ensemble shock.toml --replicas " + std::to_string(endless_replicas) + " --threads 2 -o " + file +
         more + " & pid=$!; while [ $(size) -lt $enough ]; do sleep 0.01; done; kill -" + signal + " $pid; wait $pid";
}

}  // namespace cradle::tests
