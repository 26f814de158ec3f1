// Writes initial inputs for the fuzzer: seeds FOLDER makes FOLDER/TARGET/NAME, valid ones of every kind.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/initial/ring.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_journal.hpp"

namespace {

using namespace cradle;

std::filesystem::path folder;

void put(const char* target, const std::string& name, const std::string& bytes) {
  std::filesystem::create_directories(folder / target);
  std::ofstream(folder / target / name, std::ios::binary) << bytes;
}

template <class Run> void put_state(char kind, Run&& run) {
  for (const double time : {0., 2., 9.}) {
    run.advance(time);
    put("checkpoint", std::to_string(int{kind}) + "-" + std::to_string(int(time)), kind + SavedState::of(run).bytes());
  }
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
  put("journal", "replica",
      '\2' + tools::to_bytes(tools::EnsembleRecord{
                 0, tools::ReplicaRecord{state.layout().row(3, run), state.layout().values(run)}}));

  const auto rows =
      std::make_shared<Rows<double>>(symmetric_rows<double>(12, 0.5, 1, uniform_displacement(0.05, 3, 0)));
  const auto ring =
      std::make_shared<Ring<double>>(8, 8., 1., gaussian_velocity(3, 0), uniform_displacement(0.05, 3, 0));
  using Dry = Inelastic<double>;
  const Dry dry(0.9, 1e-3);
  put_state(0, Simulation<double, Dry, GapChain<double>>(dry, GapChain<double>(rows, 0.)));
  put_state(1, Simulation<double, Dry, GapChain<double>>(dry, GapChain<double>(ring, 0.)));
  using Individual = GapChain<double, IndividualMasses<double>>;
  put_state(2,
            Simulation<double, ContactTime<double>, Individual>(ContactTime<double>(dry, 1e-3), Individual(rows, 0.)));
  put_state(3, Simulation<double, Dry, PositionChain<double>>(dry, PositionChain<double>(rows, 0.)));
  put_state(4,
            Simulation<double, Wet<double>, ClusterChain<double>>(Wet<double>(0.01), ClusterChain<double>(rows, 0.)));
  put_state(5,
            Simulation<double, Wet<double>, ClusterChain<double>>(Wet<double>(0.01), ClusterChain<double>(ring, 0.)));
  put_state(6, StickyGas<double>(ring, 0.));
  put_state(13, StickyGas<double>(rows, 0.));
}
