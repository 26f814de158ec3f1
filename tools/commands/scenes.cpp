#include <fmt/format.h>

#include <algorithm>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

namespace {

struct ScenesArguments {
  std::string name;
  bool keys = false;
};

Exit scenes(const ScenesArguments& options) {
  if (options.keys) {
    fmt::print("{}", describe_fields());
    return Exit::done;
  }
  std::size_t longest = 0;
  for (const auto& scene : bundled_scenes()) {
    longest = std::max(longest, scene.name.size());
    if (options.name != scene.name) continue;
    fmt::print("{}", scene.text);
    return Exit::done;
  }
  if (options.name.empty()) {
    for (const auto& scene : bundled_scenes())
      fmt::print("{:<{}}  {}\n", scene.name, longest, parse_scene(scene.text, std::string(scene.name)).title);
    return Exit::done;
  }
  throw Error({}, "no bundled scene of this name", options.name, "see `cradle scenes` for those there are");
}

}  // namespace

void add_scenes(CommandLine& program) {
  Command command = program.add("scenes", "list the bundled scenes; print one", "cradle scenes fig2 > my.toml");
  auto& options = command.runs<ScenesArguments>(scenes);
  command.argument("NAME", options.name, "the scene to print", Needed::no);
  command.flag("--keys", options.keys, "every key of a scene file: type, unit, default, range, meaning");
}

}  // namespace cradle::tools
