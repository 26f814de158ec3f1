// States of runs as in a checkpoint, after its checksum: they are refused, or the run continues from them to some end.
#include <stdexcept>

#include "cradle/core/base/state.hpp"
#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tests/fuzz/saved_runs.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle;
  return fuzz::refused_or_read(data, size, [](const std::string& bytes) {
    if (bytes.empty()) return;
    int calls = 0;
    const auto interrupt = [&] { return ++calls > 40; };
    const auto resume = [&](auto run) {
      SavedState state(bytes.substr(1));
      load(state, run);
      run.configuration(run.last_collision_time());
      run.advance(run.last_collision_time() + 3);
      run.configuration(run.last_collision_time() + 3);
    };
    try {
      fuzz::with_run(bytes[0], interrupt, resume);
    } catch (const std::invalid_argument&) {
    }
  });
}
