// Writes initial inputs for the fuzzer: seeds FOLDER makes FOLDER/TARGET/NAME, valid ones of every kind.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "cradle/core/base/state.hpp"
#include "cradle/tests/fuzz/saved_runs.hpp"
#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_files.hpp"

namespace {

using namespace cradle;

std::filesystem::path folder;

void put(const char* target, const std::string& name, const std::string& bytes) {
  std::filesystem::create_directories(folder / target);
  std::ofstream(folder / target / name, std::ios::binary) << bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "seeds FOLDER\n"), 2;
  folder = argv[1];
  for (const auto& [name, text] : tools::bundled_scenes())
    put("scene", std::filesystem::path(name).filename().string(), std::string(text));
  put("list", "two", "x,v\n0,1\n1,-1\n");
  put("list", "three", "# masses too\nx,v,m\n0,1,2\r\n 1e-3 , -1, 0.5\n");
  put("set", "a",
      "law.restitution=0.95\noutput.series={ points = 5, over = 50 }\ninitial.particles=\nrun.precision=mpfr");
  put("vary", "a",
      "law.restitution=0.9:0.99:4\nlaw.cutoff=1e-6:1e-2:3:log\ninitial.seed=1,2,3\n!law.loss=0.1 initial.seed=2");

  const tools::Scene scene = tools::parse_scene(
      "law.type = 'sticky'\ninitial = { type = 'rows', particles = 8 }\nrun.until = 9\noutput = { series.points = 3, "
      "snapshots = [5] }\n",
      "seed.toml");
  const tools::RunOutcome run = tools::run_scene(scene, {tools::Progress::Show::never});
  put("result", "bytes", tools::to_bytes(std::pair(run.result.attributes, run.result.groups)));
  put("journal", "header", '\0' + tools::to_bytes(tools::JournalHeader{"run", 7, effective_toml(scene), "seed"}));
  for (const tools::Group& group : run.result.groups) {
    std::string name = group.name;
    std::replace(name.begin(), name.end(), '/', '-');
    put("journal", name, '\1' + tools::to_bytes(tools::RunRecord(std::vector<tools::Group>{group})));
  }
  const tools::EnsembleState state("", scene, {});
  tools::EnsembleRecord replica;
  state.put(replica, state.layout().row(3, run), state.layout().values(run));
  put("journal", "replica", '\2' + tools::to_bytes(replica));

  for (const int kind : {0, 1, 2, 3, 4, 5, 6, 13})
    fuzz::with_run(kind, {}, [&](auto saved) {
      for (const double time : {0., 2., 9.}) {
        saved.advance(time);
        put("checkpoint", std::to_string(kind) + "-" + std::to_string(int(time)),
            static_cast<char>(kind) + SavedState::of(saved).bytes());
      }
    });
}
