// States of runs as in a checkpoint, after its checksum: they are refused, or the run continues from them to some end.
#include <memory>
#include <stdexcept>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/initial/ring.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/tests/fuzz/fuzz.hpp"

namespace {

using namespace cradle;

std::shared_ptr<const Particles<double>> rows() {
  static const auto particles =
      std::make_shared<Rows<double>>(symmetric_rows<double>(12, 0.5, 1, uniform_displacement(0.05, 3, 0)));
  return particles;
}
std::shared_ptr<const Particles<double>> ring() {
  static const auto particles =
      std::make_shared<Ring<double>>(8, 8., 1., gaussian_velocity(3, 0), uniform_displacement(0.05, 3, 0));
  return particles;
}

template <class Run> void resume(Run&& run, const std::string& bytes) {
  SavedState state(bytes);
  load(state, run);
  run.configuration(run.last_collision_time());
  run.advance(run.last_collision_time() + 3);
  run.configuration(run.last_collision_time() + 3);
}
template <class Chain, class Law>
void resume(const Law& law, const std::shared_ptr<const Particles<double>>& particles, const std::string& bytes) {
  int calls = 0;
  Policy<double> policy;
  policy.interrupt = [&] { return ++calls > 40; };
  resume(Simulation<double, Law, Chain>(law, Chain(particles, 0.), policy), bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::refused_or_read(data, size, [](const std::string& bytes) {
    if (bytes.empty()) return;
    const std::string state = bytes.substr(1);
    const Inelastic<double> dry(0.9, 1e-3);
    try {
      switch (bytes[0] % 7) {
      case 0:
        return resume<GapChain<double>>(dry, rows(), state);
      case 1:
        return resume<GapChain<double>>(dry, ring(), state);
      case 2:
        return resume<GapChain<double, IndividualMasses<double>>>(ContactTime<double>(dry, 1e-3), rows(), state);
      case 3:
        return resume<PositionChain<double>>(dry, rows(), state);
      case 4:
        return resume<ClusterChain<double>>(Wet<double>(0.01), rows(), state);
      case 5:
        return resume<ClusterChain<double>>(Wet<double>(0.01), ring(), state);
      default:
        return resume(StickyGas<double>(bytes[0] & 8 ? rows() : ring(), 0.), state);
      }
    } catch (const std::invalid_argument&) {
    }
  });
}
