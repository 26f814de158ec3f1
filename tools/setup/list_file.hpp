// Particles in a CSV file whose first line names the columns, or in the last snapshot of a result. Their columns are x,
// v, m and, where differences of positions or velocities do not have all digits, gap and closing_speed: what these add
// up to, exactly, are then the positions and velocities. So the differences of neighbours are always those of the
// decimals in x and v.
#pragma once

#include <filesystem>
#include <istream>
#include <string>

#include "cradle/tools/scene/checks.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Positions are increasing; only neighbours that do not approach may be at one place. Masses are positive, or empty if
/// all are 1.
struct ListedParticles {
  DecimalColumn x, v, m;
};

/// Columns as they are given. With gaps, one less than particles (on a ring also that to the first particle), x may
/// hold the first particle only, or nothing if it is at 0.
struct ListedColumns {
  DecimalColumn x, v, m, gap, closing_speed;
};

/// Adds up gaps and closing speeds. Throws Error if x or v are others than that by more than rounding, where they are
/// given by hand: at a collapse the velocities of a result are nothing but rounding.
ListedParticles placed(ListedColumns listed, const Decimal& length, const Place& place, bool by_hand = true);

/// Reads CSV: columns x, v, m, gap, closing_speed (index is passed over) in any order, v and x or gap at least. Blank
/// lines, lines beginning with '#', blanks around commas and CRLF line ends are accepted. The run's working precision
/// must be able to hold the numbers. `length`: of the ring, 0 on a line. Throws Error with file, line and column.
ListedParticles parse_list(std::istream& csv, const std::string& file_name, const Run& run,
                           const Decimal& length = Decimal());

/// The particles of the last snapshot of a result, which must have all of them. The scene gets the circumference of the
/// ring that they are on, unless it has one.
ListedParticles last_state(const std::string& file, Scene& scene);

/// Puts the particles of the file into the scene, in place of the file's name. Throws Error, Exit::io if the file
/// cannot be read.
void read_list(const std::filesystem::path& file, Scene& scene);

/// Throws Error if the particles of a scene cannot be set up, in double or in any wider type. Here, not in a command:
/// the particles of all initial states take seconds to compile.
void check_particles(const Scene& scene);

}  // namespace cradle::tools
