// The targets, a program each: CRADLE_FUZZ_TARGET is the one that it is for. Malformed input may only throw Error. Any
// other exception that leaves a target is a failure, as are crashes, sanitizer reports, leaks and more than a minute
// for one input (-timeout=60).
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/tests/fuzz/saved_runs.hpp"
#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/setup/list_file.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::fuzz {

// ---- texts that people write

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// A scene file. What is read must read back as itself from its effective text.
void scene(const std::string& text) {
  const tools::Scene scene = tools::parse_scene(text, "fuzz.toml");
  if (!(tools::parse_scene(tools::effective_toml(scene), "effective.toml") == scene)) std::abort();
}

// A CSV list of particles.
void list(const std::string& text) {
  std::istringstream csv(text);
  tools::parse_list(csv, "particles.csv", tools::Run());
}

// Values of --set, one a line, on top of a scene.
void set(const std::string& text) {
  tools::parse_scene("law = { type = 'inelastic', restitution = 0.9 }\ninitial = { type = 'rows', particles = 80 "
                     "}\nrun.until = 100\n",
                     "fuzz.toml", lines_of(text));
}

// Values of --vary and --point, one per line; those of points have a '!' before them. A million points are allowed, but
// take seconds with sanitizers: here the limit is some thousand.
void vary(const std::string& text) {
  tools::Sweep sweep;
  for (const std::string& line : lines_of(text))
    line.starts_with('!') ? sweep.points.push_back(line.substr(1)) : sweep.vary.push_back(line);
  sweep.cuts = text.size() % 2 == 1;
  tools::sweep_points(sweep, 4096);
}

// ---- files, without their checksums, which a fuzzer would not guess; the first byte is the kind

// The header of a journal, records of a run and of an ensemble.
void journal(const std::string& bytes) {
  if (bytes.empty()) return;
  const std::string rest = bytes.substr(1);
  const int kind = bytes[0] % 3;
  if (kind == 0) {
    tools::from_bytes<tools::JournalHeader>(rest);
  } else if (kind == 1) {
    tools::GrowingTables tables(bytes[0] & 4 ? tools::Reading::ends : tools::Reading::everything);
    auto record = tools::from_bytes<tools::RunRecord>(rest);
    if (auto* pieces = std::get_if<std::vector<tools::Group>>(&record))
      for (tools::Group& rows : *pieces) tables.add(std::move(rows));
    tools::in_order(std::move(tables));
  } else {
    static const tools::Scene scene = tools::parse_scene(
        "law.type = 'sticky'\ninitial = { type = 'rows', particles = 8 }\nrun.until = 9\noutput.series.points = 3\n",
        "fuzz.toml");
    tools::EnsembleState state("", scene, {});
    state.apply(tools::from_bytes<tools::EnsembleRecord>(rest));
  }
}

// States of runs as in a checkpoint: they are refused, or the run continues from them to some end.
void checkpoint(const std::string& bytes) {
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
    with_run(bytes[0], interrupt, resume);
  } catch (const std::invalid_argument&) {
  }
}

// Results, with any names, types and shapes: every result that can be written as a file can be read from it. The seal
// protects HDF5, which crashes on damaged files.
void result(const std::string& bytes) {
  using namespace tools;
  static const std::string path = "/tmp/cradle-fuzz-" + std::to_string(::getpid()) + ".h5";
  auto [attributes, groups] = from_bytes<std::pair<std::vector<Attribute>, std::vector<Group>>>(bytes);
  std::ofstream(path, std::ios::binary) << file_image({std::move(attributes), std::move(groups)});
  read_result(path);
  read_result(path, Reading::ends);
}

}  // namespace cradle::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    cradle::fuzz::CRADLE_FUZZ_TARGET(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const cradle::tools::Error&) {
  }
  return 0;
}
