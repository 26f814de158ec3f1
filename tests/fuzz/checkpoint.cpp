// States of runs, as they are behind a checkpoint's checksum: they are refused, or the run goes on with whatever it was
// given, to some end.
#include <memory>
#include <stdexcept>

#include "cradle/core/cluster_chain.hpp"
#include "cradle/core/gap_chain.hpp"
#include "cradle/core/position_chain.hpp"
#include "cradle/core/ring.hpp"
#include "cradle/core/rows.hpp"
#include "cradle/core/simulation.hpp"
#include "cradle/core/state.hpp"
#include "cradle/core/sticky_gas.hpp"
#include "cradle/tests/fuzz/fuzz.hpp"

namespace {

using namespace cradle;

std::shared_ptr<const Bodies<double>> rows() {
  static const auto bodies =
      std::make_shared<Rows<double>>(symmetric_rows<double>(12, .5, 1, uniform_displacement(.05, 3, 0)));
  return bodies;
}
std::shared_ptr<const Bodies<double>> ring() {
  static const auto bodies =
      std::make_shared<Ring<double>>(8, 8., 1., gaussian_velocity(3, 0), uniform_displacement(.05, 3, 0));
  return bodies;
}

template <class Run> void go_on(Run&& run, const std::string& bytes) {
  SavedState state(bytes);
  load(state, run);
  run.configuration(run.last_contact_time());
  run.advance(run.last_contact_time() + 3);
  run.configuration(run.last_contact_time() + 3);
}
template <class Chain, class Law>
void go_on(const Law& law, const std::shared_ptr<const Bodies<double>>& bodies, const std::string& bytes) {
  int asked = 0;
  Policy<double> policy;
  policy.interrupt = [&] { return ++asked > 40; };
  go_on(Simulation<double, Law, Chain>(law, Chain(bodies, 0.), policy), bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::refused_or_read(data, size, [](const std::string& bytes) {
    if (bytes.empty()) return;
    const std::string state = bytes.substr(1);
    const Inelastic<double> dry(.9, 1e-3);
    try {
      switch (bytes[0] % 7) {
      case 0:
        return go_on<GapChain<double>>(dry, rows(), state);
      case 1:
        return go_on<GapChain<double>>(dry, ring(), state);
      case 2:
        return go_on<GapChain<double, IndividualMasses<double>>>(ContactTime<double>(dry, 1e-3), rows(), state);
      case 3:
        return go_on<PositionChain<double>>(dry, rows(), state);
      case 4:
        return go_on<ClusterChain<double>>(Wet<double>(.01), rows(), state);
      case 5:
        return go_on<ClusterChain<double>>(Wet<double>(.01), ring(), state);
      default:
        return go_on(StickyGas<double>(bytes[0] & 8 ? rows() : ring(), 0.), state);
      }
    } catch (const std::invalid_argument&) {
    }
  });
}
