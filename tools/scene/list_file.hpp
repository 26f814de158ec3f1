// Particles in a CSV file whose first line names the columns, x,v or x,v,m, or in the last snapshot of a result.
#pragma once

#include <filesystem>
#include <istream>
#include <string>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Positions are strictly increasing. Masses are positive, or empty if all are 1.
struct ListedParticles {
  DecimalColumn x, v, m;
};

/// Reads CSV. Blank lines, lines beginning with '#', blanks around commas and CRLF line ends are accepted. The run's
/// working precision must be able to hold the numbers. Throws Error with file, line and column.
ListedParticles parse_list(std::istream& csv, const std::string& file_name, const Run& run);

/// Puts the particles of the file into the scene, in place of the file's name; those of a result on a ring with its
/// circumference, unless the scene has one. A snapshot must have all particles. Throws Error, Exit::io if the file
/// cannot be read.
void read_list(const std::filesystem::path& file, Scene& scene);

}  // namespace cradle::tools
