// Particles in a CSV file whose first line names the columns, or in the last snapshot of a result. Their columns are x,
// v, m and, where differences of positions or velocities do not have all digits, gap and closing_speed: what these add
// up to, exactly, are then the positions and velocities. So the differences of neighbours are always those of the
// decimals in x and v.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <istream>
#include <string>
#include <string_view>

#include "cradle/tools/scene/number_range.hpp"
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

/// Adds up gaps and closing speeds. Throws Error if x or v are others than that by more than rounding.
ListedParticles placed(ListedColumns listed, const Decimal& length, const Place& place);

/// A particle of a list.
struct Listed {
  std::string_view x, v;
};

/// Throws Error unless neighbours are in order, and apart in the working precision if they are not at one place. Those
/// at one place must not approach: whether one of them collides before with a third one would be open.
void check_neighbours(const Listed& left, const Listed& right, const NumberRange& range, const Place& place);

/// The same of all neighbours; `before` is the place of what is said of a particle and the one before it.
void check_order(const ListedParticles& of, const Run& run, const std::function<Place(std::size_t)>& before);

/// Reads CSV: columns x, v, m, gap, closing_speed (index is passed over) in any order, v and x or gap at least. Blank
/// lines, lines beginning with '#', blanks around commas and CRLF line ends are accepted. The run's working precision
/// must be able to hold the numbers. `length`: of the ring, 0 on a line. Throws Error with file, line and column.
ListedParticles parse_list(std::istream& csv, const std::string& file_name, const Run& run,
                           const Decimal& length = Decimal());

/// Puts the particles of the file into the scene, in place of the file's name; those of a result on a ring with its
/// circumference, unless the scene has one. A snapshot must have all particles. Throws Error, Exit::io if the file
/// cannot be read.
void read_list(const std::filesystem::path& file, Scene& scene);

}  // namespace cradle::tools
