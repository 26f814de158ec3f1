// Reads a scene: text to entries (tools/scene/source.hpp), which the command line changes, entries to the struct by the
// table of fields (fields.hpp), checks that involve several keys (checks.hpp), particles of a list (list_file.hpp) or
// of a word (word_start.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Reads the scene file at this path or, if there is none, the bundled scene of this name. Each override is
/// `table.key=value`, with the value in TOML syntax (bare words are strings), and replaces the value in the file; an
/// empty value removes the key. The remarks of the scene name its times that a new run.start or run.until leaves out.
/// Throws Error: Exit::io if nothing can be read, Exit::bad_input for wrong contents.
Scene read_scene(const std::string& path_or_name, const std::vector<std::string>& overrides = {});

/// The same for commands that vary keys: if the scene lacks one of these, it is read with the first values of all.
Scene read_scene(const std::string& path_or_name, const std::vector<std::string>& overrides,
                 const std::vector<std::string>& first_values);

/// The same from text. Messages name `source_name`; its stem is the scene's name, and its folder is searched for a list
/// of particles.
Scene parse_scene(std::string_view text, const std::string& source_name,
                  const std::vector<std::string>& overrides = {});

}  // namespace cradle::tools
