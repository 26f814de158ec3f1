// What a command may replace. It replaces a result only if it would make the same again: the same command with the same
// options and the same scene. Anything else in that place (a result of other settings, of another command, a file of
// somebody else) is refused before anything is computed, unless --force is given.
#pragma once

#include <string>

#include "cradle/tools/result/result.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Whether to replace whatever is there.
enum class Force { no, yes };

/// Says in a result of `certify`, say, how it was made: `command` has the options that the scene does not have
/// ("certify --digits 50"), and `requested` is the scene as it was given, whose precision the command may have raised.
void say_how_made(Result& result, const std::string& command, const Scene& requested);

/// The words after `cradle` that made a result, without the scene: a plain run has no attributes that say so.
std::string command_of(const Result& result);

/// Throws Error (Exit::bad_input) if `file` is there and holds anything but a result of this command and scene; without
/// a scene the command says all.
void check_overwrite(const std::string& file, const std::string& command, const Scene* scene, Force force);

/// The same for a result that is made already, of any command.
void check_overwrite(const std::string& file, const Result& made, Force force);

/// The same for the saved state of a simulation: it replaces any checkpoint.
void check_overwrite(const std::string& file, Force force);

}  // namespace cradle::tools
