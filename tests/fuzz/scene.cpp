// A scene file. What is read must read back as itself from its effective text.
#include <cstdlib>

#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/setup/read_scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle;
  return fuzz::refused_or_read(data, size, [](const std::string& text) {
    const tools::Scene scene = tools::parse_scene(text, "fuzz.toml");
    if (!(tools::parse_scene(tools::effective_toml(scene), "effective.toml") == scene)) std::abort();
  });
}
