// Values of --set, one a line, on top of a scene.
#include <sstream>
#include <vector>

#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/setup/read_scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle;
  return fuzz::refused_or_read(data, size, [](const std::string& text) {
    std::vector<std::string> overrides;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) overrides.push_back(line);
    tools::parse_scene("law = { type = 'inelastic', restitution = 0.9 }\ninitial = { type = 'rows', particles = 80 "
                       "}\nrun.until = 100\n",
                       "fuzz.toml", overrides);
  });
}
