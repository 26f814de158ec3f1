// Particles in the last snapshot of a result.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cradle/precision/bin_float.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/setup/initial_state.hpp"
#include "cradle/tools/setup/list_file.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {
namespace {

// The column of a snapshot as decimals that read back as its numbers.
DecimalColumn decimals(const Result& result, const std::string& snapshot, const std::string& name,
                       const std::string& file) {
  DecimalColumn texts;
  for (const std::string& folder : {std::string("exact/"), std::string()})
    if (const Group* group = result.find(folder + snapshot))
      for (const Column& column : group->columns) {
        if (column.name != name) continue;
        if (const auto* exact = std::get_if<std::vector<std::string>>(&column.values)) {
          for (const std::string& text : *exact)
            if (const auto number = plain_decimal(text)) texts.push_back(*number);
          return texts;
        }
        if (const auto* doubles = std::get_if<std::vector<double>>(&column.values)) {
          for (const double x : *doubles)
            if (std::isfinite(x)) texts.push_back(*plain_decimal(fmt::format("{}", x)));
          return texts;
        }
      }
  throw Error({file, 0, snapshot}, "a snapshot without a column", name, "take the file from a copy", Exit::io);
}

// Of the particle that had the lowest number, in the rows of a snapshot: on a ring they begin at any particle.
std::size_t first_row(const Result& result, const std::string& snapshot) {
  const Column* column = result.find(snapshot)->find("index");
  const auto* index = column == nullptr ? nullptr : std::get_if<std::vector<std::uint64_t>>(&column->values);
  return index == nullptr ? 0 : static_cast<std::size_t>(std::ranges::min_element(*index) - index->begin());
}

DecimalColumn rotated(const DecimalColumn& column, std::size_t first) {
  DecimalColumn turned;
  for (std::size_t i = 0; i < column.size(); ++i) turned.push_back(column[(first + i) % column.size()]);
  return turned;
}

}  // namespace

ListedParticles last_state(const std::string& file, Scene& scene) {
  const Result result = read_result(file);
  const Scene other = parse_scene(attribute<std::string>(result.attributes, "scene", file), file);
  std::string snapshot;
  for (const Group& group : result.groups)
    if (group.name.starts_with("snapshots/")) snapshot = group.name;
  if (snapshot.empty())
    throw Error({file, 0, "snapshots"}, "a result without a state of its particles", "no snapshot",
                "run its scene with output.snapshots at the time that is to be taken");
  const auto column = [&](const char* name) { return decimals(result, snapshot, name, file); };
  ListedColumns listed{column("x"), column("v"), column("m"), column("gap"), column("closing_speed")};
  if (listed.v.size() != listed.x.size() || listed.m.size() != listed.x.size())
    throw Error({file, 0, snapshot}, "columns of different lengths", std::to_string(listed.v.size()),
                "take the file from a copy", Exit::io);
  const auto all = initial_particles<double>(other);
  CompensatedSum<double> mass;
  bool ones = true;
  for (std::size_t i = 0; i < listed.m.size(); ++i) {
    const Decimal m(listed.m[i]);
    mass.add(m.value);
    ones = ones && m == Decimal("1");
  }
  // Any missing particle is heavier than what sums round.
  if (!(std::abs(mass.value() - all->total_mass()) < all->least_mass() / 2))
    throw Error({file, 0, snapshot}, "particles that no collision has reached are not in it",
                fmt::format("{:g} of the mass {:g}", mass.value(), all->total_mass()),
                "take a later snapshot, when all particles have collided");
  if (ones) listed.m = {};
  if (other.initial.on_ring()) {
    const std::size_t first = first_row(result, snapshot);
    for (DecimalColumn* numbers : {&listed.x, &listed.v, &listed.m, &listed.gap, &listed.closing_speed})
      *numbers = rotated(*numbers, first);
    listed.x = {listed.x[0]};
  }
  if (other.initial.on_ring() && !scene.initial.on_ring()) scene.initial.length = other.initial.length;
  if ((other.walls.any() && !scene.walls.any()) || (other.gravity.acts() && !scene.gravity.acts()))
    scene.remarks +=
        fmt::format("{}a state of a run with walls or gravity, which this scene lacks (found {}): repeat "
                    "[walls] and [gravity] of that run, if it is to continue\n",
                    scene.place("initial.file").prefix(), scene.walls.any() ? "no [gravity]" : "no [walls]");
  const NumberRange range(scene.run);
  for (const DecimalColumn* numbers : {&listed.x, &listed.v, &listed.m})
    for (std::size_t i = 0; i < numbers->size(); ++i) range.check((*numbers)[i], {file, 0, snapshot});
  ListedParticles particles = placed(std::move(listed), scene.initial.length, {file, 0, snapshot}, false);
  check_order(particles.x, particles.v, scene.run, [&](std::size_t) { return Place{file, 0, snapshot + "/gap"}; });
  return particles;
}

void check_particles(const Scene& scene) {
  if (scene.run.precision == Precision::double_)
    initial_particles<double>(scene);
  else
    initial_particles<bin_float>(scene);
}

}  // namespace cradle::tools
