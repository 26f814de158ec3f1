// Particles given one by one in a CSV file whose first line names the columns x,v or x,v,m.
#pragma once

#include <filesystem>
#include <istream>
#include <string>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Positions strictly increasing; masses positive, and empty where all are 1.
struct ListedParticles {
  DecimalColumn x, v, m;
};

/// Reads CSV; blank lines, lines beginning with '#', blanks around commas and CRLF line ends are accepted. Numbers must
/// be such that the working precision of a run holds them. Throws Error with file, line and column.
ListedParticles parse_list(std::istream& csv, const std::string& file_name, const Run& run);

/// Puts the particles of a file into the scene, in place of the file's name: from now on it says all. Throws Error;
/// Exit::io where the file cannot be read.
void read_list(const std::filesystem::path& file, Scene& scene);

}  // namespace cradle::tools
