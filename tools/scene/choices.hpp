// What a scene chooses among: collision laws, initial states and scalar types. What it says of its law and of its
// particles, and what the program needs to know of each choice, a row each. How one is added is on the pages of
// core/laws, core/initial and core. What the paper predicts for a law, and what that costs, is a row in
// tools/theory/laws.cpp.
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

// ---- collision laws

enum class LawType { inelastic, wet, sticky };

namespace scene {

struct Law {
  LawType type = LawType::inelastic;
  Decimal restitution;  // inelastic
  Decimal cutoff;       // inelastic: closing speed below which collisions are elastic; 0: none
  std::optional<Decimal>
      cutoff_exponent;  // inelastic: the power of the speed with which the restitution falls; none: sharp
  Decimal loss;         // wet: E_loss
  bool operator==(const Law&) const = default;
};

}  // namespace scene

struct LawRow {
  LawType type;
  std::string_view name;     // as in scenes
  bool merges = false;       // particles stick or pass through each other; otherwise they bounce, also off walls
  bool needs_events = true;  // false: the state at any time follows without collisions
  bool policies = false;     // run.collapse can be merge or contact-time
  bool provable = false;     // `certify` has its map in balls (tools/proof)
};

inline constexpr LawRow law_rows[] = {
    {.type = LawType::inelastic, .name = "inelastic", .policies = true, .provable = true},
    {.type = LawType::wet, .name = "wet", .merges = true, .provable = true},
    {.type = LawType::sticky, .name = "sticky", .merges = true, .needs_events = false, .provable = true},
};
static_assert(rows_in_order(law_rows));

/// The row of the scene's law.
const LawRow& law_row(const Scene& scene);

/// Whether particles stick or pass through each other, by the law or by the collapse policy.
bool particles_merge(const Scene& scene);
/// Whether inelastic collapse is possible and ends the run.
bool stops_at_collapse(const Scene& scene);
/// Whether the state at each time is computed directly, without collisions.
bool without_collisions(const Scene& scene);

// ---- initial states

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

// ---- scalar types

enum class Precision { double_, long_double, double_double, float128, cpp_bin_float, mpfr };

struct ScalarRow {
  // A quantity that grows linearly with the digits, for types with a variable number of digits.
  struct Linear {
    double fixed, per_digit = 0;
    constexpr double at(std::uint64_t digits) const { return fixed + per_digit * static_cast<double>(digits); }
  };

  Precision type;
  std::string_view name;  // as in scenes and precision/
  unsigned digits;        // decimal ones that every number has; 0: as many as the scene says
  // Time per collision in gaps and in positions, relative to gaps in double (Fig. 2 to t = 4000, bench_precision), and
  // bytes per number.
  Linear gaps, absolute, bytes;
  // The range of positive numbers; empty: practically without limit.
  std::string_view largest, least;
};

// Largest and least numbers of types whose exponents have so many bits.
inline constexpr std::string_view of_11_bits[] = {"1.7976931348623157e308", "2.2250738585072014e-308"},
                                  of_15_bits[] = {"1.18973149535723176502e4932", "3.3621031431120935063e-4932"};

inline constexpr ScalarRow scalar_rows[] = {
    {Precision::double_, "double", 15, {1}, {1.2}, {8}, of_11_bits[0], of_11_bits[1]},
    {Precision::long_double, "long double", 18, {5.3}, {4}, {16}, of_15_bits[0], of_15_bits[1]},
    {Precision::double_double, "double-double", 31, {2.6}, {6.6}, {16}, of_11_bits[0], of_11_bits[1]},
    {Precision::float128, "float128", 33, {10}, {30}, {16}, of_15_bits[0], of_15_bits[1]},
    // The exponent has 32 bits.
    {Precision::cpp_bin_float, "cpp_bin_float", 100, {41}, {104}, {64}, "1e323228496", "1e-323228496"},
    {Precision::mpfr, "mpfr", 0, {6.3, 0.112}, {22, 0.4}, {48, 1 / 2.4}, "", ""},
};
static_assert(rows_in_order(scalar_rows));

constexpr const ScalarRow& scalar_row(Precision type) { return scalar_rows[static_cast<std::size_t>(type)]; }

}  // namespace cradle::tools
