// Texts that people write. CRADLE_FUZZ_TARGET is the one that a program is for.
#include <cstdlib>
#include <sstream>
#include <vector>

#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/setup/list_file.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::fuzz {

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

}  // namespace cradle::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return cradle::fuzz::refused_or_read(data, size, cradle::fuzz::CRADLE_FUZZ_TARGET);
}
