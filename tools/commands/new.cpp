// Writes a scene to start from, with every key that it could use: the documentation of each key, and a line with its
// value, commented out if that is the default.
#include <fmt/format.h>

#include <filesystem>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

namespace {

struct NewArguments {
  std::string file = "shock.toml", from;
};

// Without --from: a smaller Fig. 2 that runs beyond its turn-over.
Scene to_start_from(const std::string& name) {
  if (!name.empty()) return read_scene(name, {});
  return read_scene("fig2", {"title=two rows of inelastic particles", "initial.particles=2000", "run.until=1500",
                             "output.snapshots=[100,500,1000,1500]", "output.profiles.times=[100,500,1000,1500]",
                             "output.profiles.range=[-100,100]"});
}

// Compares texts: a value that is spelled differently (1.0 instead of 1) is written, as results write it.
bool is_default(const Field& field, const Scene& scene) {
  if (field.fallback == "required") return false;
  Scene other = scene;
  if (!field.fallback.empty()) store_default(field, other);
  return field.fallback.empty() ? !value_text(field, scene) : value_text(field, other) == value_text(field, scene);
}

std::string commented(const Scene& scene, const std::string& file) {
  std::string text = fmt::format(
      "# A scene for `cradle run {0}`; `cradle check {0}` estimates its cost. A key that stands behind a #\n"
      "# has its default, or says nothing here. `cradle scenes --keys` lists all keys, those of other laws "
      "included.\n",
      file);
  std::string_view open;
  for (const Field& field : scene_fields()) {
    if (!field.when->holds(scene)) continue;
    const auto dot = field.key.find('.');
    const std::string_view table = dot == field.key.npos ? std::string_view() : field.key.substr(0, dot);
    if (table != open) text += fmt::format("\n[{}]\n", table);
    open = table;
    const auto value = value_text(field, scene);
    text += fmt::format("# {} ({})\n", field.doc, facts(field));
    text += fmt::format("{}{} = {}\n", is_default(field, scene) ? "# " : "",
                        dot == field.key.npos ? field.key : field.key.substr(dot + 1), value.value_or("..."));
  }
  return text;
}

Exit make(const NewArguments& options) {
  const Scene scene = to_start_from(options.from);
  if (std::filesystem::exists(file_behind(options.file)))
    throw Error({options.file}, "the file is there already", "", "choose another name", Exit::io);
  replace_file(options.file, commented(scene, options.file));
  fmt::print("wrote {0}: change it, then `cradle run {0}`\n", options.file);
  return Exit::done;
}

}  // namespace

void add_new(CommandLine& program) {
  Command command = program.add("new", "a commented scene to start from", "cradle new my.toml --from fig6");
  auto& options = command.runs<NewArguments>(make);
  command.argument("FILE", options.file, "the scene file to write (default: shock.toml)", Needed::no);
  command.option("--from", options.from, "the scene whose values it has: a file, or the name of a bundled scene");
}

}  // namespace cradle::tools
