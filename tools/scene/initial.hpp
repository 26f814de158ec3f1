// The initial states: what a scene says of its particles, and what the program needs to know of each state, one row per
// state. How a state is added is on the page of core/initial.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/tools/scene/decimal.hpp"
#include "cradle/tools/support/table.hpp"

namespace cradle::tools {

struct Scene;

enum class InitialType { rows, ring, list, clusters, cold, gas };
// The enumerators are in the order of the names in the table of fields.
enum class Velocities { gaussian, uniform };
enum class Positions { lattice, poisson };

// Scene types whose names the engine uses too.
namespace scene {

enum class HotPlace { middle, left };
enum class Meeting { energy, pass, stick };

/// One side of a general Riemann problem: particles at distance 1/density.
struct Row {
  std::uint64_t particles = 0;
  Decimal speed;  // velocity of the row: positive to the right
  Decimal density;
};

}  // namespace scene

/// The particle between two general rows, at x = 0; mass 0: none.
struct Centre {
  Decimal mass;
  Decimal speed;
};

struct Initial {
  InitialType type = InitialType::rows;
  std::uint64_t particles = 0;  // rows (both together), ring, cold, gas
  Decimal speed;    // rows: left row +speed, right row -speed; clusters: of the rows that feed them; cold: of one hot
                    // particle
  Decimal spacing;  // rows, clusters, cold
  scene::Row left, right;  // rows given as tables: see general_rows()
  Centre centre;
  Positions positions = Positions::lattice;  // rows, ring, cold, gas
  Decimal perturbation;                      // rows, ring, cold, gas: uniform in plus/minus this times the spacing
  Decimal length;                            // ring; list: 0 on a line
  std::optional<Decimal> density;            // gas: says where the right wall is
  Decimal density_exponent;                  // cold: the density falls with this power of the distance
  Velocities velocities = Velocities::gaussian;
  Decimal variance;                                 // ring, gas
  std::vector<Decimal> masses;                      // rows, ring, cold, gas: repeated from particle 0 on; empty: all 1
  std::vector<Decimal> random_masses;               // or uniform between these two
  std::uint64_t hot = 0;                            // cold: particles that move at the start
  scene::HotPlace place = scene::HotPlace::middle;  // cold: where these are
  Decimal energy;                                   // cold: of several hot particles together
  std::optional<std::string>
      file;                     // list: the file with the particles, or a result; a scene that was read has them here:
  DecimalColumn x, v, m;        // list; m empty: all 1. clusters: two x, two v
  DecimalColumn gap;            // list: instead of all x but the first; a scene that was read has them in x
  std::vector<Decimal> growth;  // clusters: share of the incoming mass that each takes up
  scene::Meeting meeting = scene::Meeting::energy;
  std::uint64_t seed = 0;
  std::uint64_t replica = 0;

  /// Rows given by [initial.left] and [initial.right] instead of particles, speed and spacing.
  bool general_rows() const { return left.particles > 0; }
  bool on_ring() const { return type == InitialType::ring || (type == InitialType::list && length > Decimal("0")); }
};

struct InitialRow {
  InitialType type;
  std::string_view name;  // as in scenes
  bool in_order = false;  // at equal distances or random ones, with patterns of masses; otherwise one by one
  bool on_line = false;   // part of the line is empty, so that there can be a dense core
  bool thermal = false;   // random velocities of a variance
};

inline constexpr InitialRow initial_rows[] = {
    {.type = InitialType::rows, .name = "rows", .in_order = true, .on_line = true},
    {.type = InitialType::ring, .name = "ring", .in_order = true, .thermal = true},
    {.type = InitialType::list, .name = "list", .on_line = true},
    {.type = InitialType::clusters, .name = "clusters"},
    {.type = InitialType::cold, .name = "cold", .in_order = true, .on_line = true},
    {.type = InitialType::gas, .name = "gas", .in_order = true, .thermal = true},
};
static_assert(rows_in_order(initial_rows));

/// The row of the scene's initial state.
const InitialRow& initial_row(const Scene& scene);

}  // namespace cradle::tools
