// Compares a proof with its run. A quantity that both have must be the same number, except for the rounding of the run.
// This file bounds that rounding, and finds the first quantity that differs by more than the bound. Then the run or the
// program is wrong.
//
// Before anything is compared, it is proved that the run has made the collisions of the exact system and no others. So
// each collision maps the world lines of the run as it maps the exact ones (checker.hpp), and the error of the run is
// what it has rounded at each collision, carried on by the maps of later collisions. Let u be the largest speed that
// there can be. One collision rounds three closing speeds by epsilon u at most and its time t by epsilon t at most; an
// error of a closing speed shifts all particles on one side of the gap. With the factor to spare that the guards of a
// run have (observe/guards.hpp) the error of every particle is at most
//
//   Delta u  of velocities,   Delta (extent + u t)  of places,   Delta = 8 epsilon (C + N + 64)
//
// after C collisions of N particles, if no map makes an error larger than it was. There are two cases:
//
//   - Velocities after a collision are means of those before (identical particles that bounce, all particles that merge
//     or pass). Then neither errors nor speeds grow, and u is the largest speed at the start.
//   - Particles of different masses bounce. Then sum m_k delta_k^2 does not grow, where delta_k is the error of
//     particle k. A shift of all particles by delta makes this sum M delta^2, where M is the mass of all; hence
//     |delta_k| <= delta sqrt(M/m_k). Here u = sqrt(2 E_0/m_min), with the energy E_0 at the start.
//
// A reflecting wall is a particle of infinite mass whose line has no error. It multiplies the errors of a particle,
// counted from the line of the wall, by the restitution of the wall, which is at most 1. What walls give makes u
// larger. Then u is at least the largest speed that a particle has had from a wall, and E_0 + G takes the place of E_0
// above. G is the sum of what walls have given; what they have taken is not subtracted. A thermal wall does not act
// linearly on errors: the speed that it gives has none, but the time of the collision has one, and so has the place of
// the particle. Each collision with a wall, at a speed w before and w' after, adds a momentum m (w + w') and energies m
// (w + w') V and m (w^2 - w'^2)/2 to the account of the wall. Both speeds are at most 2 u and off by at most Delta u.
// With room for the rounding of these terms, the momentum is off by at most 4 M Delta u and each energy by at most 4 M
// u Delta u.
//
// Under gravity the most that particles can gain by falling, Sizes::fall_energy, is added to E_0 + G. Free fall adds
// the same to all velocities and places, so it changes no error. The speed at which a falling particle meets a wall is
// not linear; the last paragraph treats this.
//
// In a run in gaps no gap is computed from places, so their errors do not enter. The error of a gap is the rounding of
// its own size and the error of its closing speed times the time, together at most 2 Delta (gap + u t).
//
// Energies are off by at most sqrt(2 E_0 M) Delta u + M (Delta u)^2/2 because of the velocities, and by Delta E_0
// because of the sums. The time of a collision that closes at the speed w is off by the error of its particles' places
// at that time, divided by w. Wet particles, restitutions r(w), thermal walls and walls under gravity do not act
// linearly on errors. How much they enlarge an error shows in the radii of the balls of the proof: these grow in the
// same way, from roundings of the type of their midpoints or larger ones. So the radius of a number is added to its
// bound, times the ratio of the epsilon of the run's type to that of the midpoints, times N + 64 for the N particles
// held.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/core/certify/checker.hpp"
#include "cradle/precision/ball_text.hpp"
#include "cradle/tools/proof/certificate.hpp"
#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// By how much the numbers of a run may be off.
struct RunErrors {
  long double place = 0, speed = 0, energy = 0, mass = 0;
  long double gap = 0, of_gap = 0;                 // of_gap: for each unit of the gap
  long double wall_energy = 0, wall_momentum = 0;  // for each collision with a wall
  long double of_radius = 0;                       // and so many radii of the proof
};

/// The errors of a run in a type with this epsilon; `time` is the largest time that the run has computed with.
inline RunErrors run_errors(const Sizes& of, std::uint64_t collisions, bool means, long double epsilon,
                            long double time, long double circumference) {
  const long double mass = of.mass,
                    twice_energy = 2 * (static_cast<long double>(of.start_energy) + of.wall_energy + of.fall_energy),
                    delta = 8 * epsilon * (static_cast<long double>(collisions + of.particles) + 64);
  const long double fastest =
      std::max<long double>(means ? of.start_speed : std::sqrt(twice_energy / of.least_mass), of.wall_speed);
  const long double grown = means ? 1 : std::sqrt(mass / of.least_mass), speed = delta * fastest;
  // Places may have been further out, by the distance that particles have flown.
  const long double extent = of.place + circumference + 2 * fastest * time;
  return {grown * delta * (extent + fastest * time),
          grown * speed,
          delta * twice_energy / 2 + speed * std::sqrt(twice_energy * mass) + speed * speed * mass / 2,
          delta * mass,
          2 * grown * delta * fastest * time,
          2 * grown * delta,
          4 * mass * grown * speed * fastest,
          4 * mass * grown * speed,
          0};
}

/// Keeps the first disagreement of all that it is given.
template <Enclosing N> class Agreement {
 public:
  explicit Agreement(const RunErrors& errors) : errors_(errors) {}

  const RunErrors& errors() const { return errors_; }
  /// Without its time, and the collisions that are proved before it.
  const std::optional<ReportedDoubt>& broken() const { return broken_; }

  /// `quantity`: its name, or a function that makes it, which is called for a disagreement only.
  void count(const auto& quantity, std::uint64_t of_run, std::uint64_t of_proof) {
    if (of_run != of_proof) report(quantity, fmt::format("{}", of_run), fmt::format("{}", of_proof), 0);
  }
  /// `of_run`: a decimal of the run's type, with all its digits; empty: it has none.
  void number(const auto& quantity, const std::string& of_run, const std::optional<N>& of_proof, long double bound) {
    const bool finite = !of_run.empty() && of_run.find('n') == of_run.npos;  // neither nan nor inf
    compare(quantity, of_run, finite ? std::optional(from_text<N>(of_run)) : std::nullopt, of_proof, bound);
  }
  /// The same of a double of the run; NaN: it has none.
  void number(const auto& quantity, double of_run, const std::optional<N>& of_proof, long double bound) {
    if (std::isfinite(of_run))
      compare(quantity, of_run, exactly<N>(of_run), of_proof, bound);
    else
      number(quantity, std::isnan(of_run) ? "" : fmt::format("{}", of_run), of_proof, bound);
  }

 private:
  // `exact`: what the run has, if that is finite.
  template <class Number>
  void compare(const auto& quantity, const Number& of_run, const std::optional<N>& exact,
               const std::optional<N>& of_proof, long double bound) {
    const std::string none = "none";
    bool has_none = false;
    if constexpr (std::same_as<Number, std::string>) has_none = of_run.empty();
    if (has_none || !of_proof) {
      if (has_none == of_proof.has_value())
        report(quantity, has_none ? none : fmt::format("{}", of_run), of_proof ? to_text(of_proof->middle()) : none,
               bound);
      return;
    }
    if (!is_finite(*of_proof)) return;
    const auto radius = static_cast<long double>(of_proof->radius());
    const long double most = bound + errors_.of_radius * radius;
    if (exact && !(static_cast<long double>((*exact - *of_proof).least_size()) > most)) return;
    report(quantity, fmt::format("{}", of_run), to_text(of_proof->middle()), most + radius);
  }
  void report(const auto& quantity, const std::string& of_run, const std::string& of_proof, long double bound) {
    if (broken_) return;
    if constexpr (std::invocable<decltype(quantity)>)
      report(quantity(), of_run, of_proof, bound);
    else
      broken_ = ReportedDoubt{Check::agreement, true, -1, -1, 0, 0, of_run, of_proof, bound, quantity};
  }

  RunErrors errors_;
  std::optional<ReportedDoubt> broken_;
};

/// What a proof encloses of the tables of a result, which it is compared with as a whole before anything is called
/// proved: each number below /exact and each double, which may be half a unit off.
template <Enclosing N> class ProvedTables {
 public:
  /// A number of a column like "snapshots/0000/gap"; empty: the file has no number there.
  void add(const std::string& column, std::size_t row, std::optional<N> proved, long double bound) {
    columns_[column].push_back({row, std::move(proved), bound});
  }

  std::optional<ReportedDoubt> compare(Result& result, const RunErrors& errors) const {
    Agreement<N> agreement(errors);
    for_each_column(result, [&](const std::string& path, Column& column, const std::vector<Row>& rows) {
      compare(path, column, rows, agreement);
    });
    return agreement.broken();
  }
  /// Writes what is proved in place of what the run has rounded, or chaos has made of that. A number of the run that
  /// lies in its enclosure stays: it may have more digits than the enclosure, gaps and short times above all.
  void put(Result& result) const {
    for_each_column(result, [](const std::string&, Column& column, const std::vector<Row>& rows) {
      for (const Row& row : rows) {
        if (!row.proved || !is_finite(*row.proved) || row.number >= column.rows()) continue;
        if (auto* texts = std::get_if<std::vector<std::string>>(&column.values)) {
          std::string& text = (*texts)[row.number];
          if (text.find('n') != text.npos || !holds(*row.proved, from_text<N>(text)))
            text = to_text(row.proved->middle());
        } else if (auto* doubles = std::get_if<std::vector<double>>(&column.values)) {
          double& number = (*doubles)[row.number];
          if (!std::isfinite(number) || !holds(*row.proved, exactly<N>(number))) number = to_double(*row.proved);
        }
      }
    });
  }

 private:
  static bool holds(const N& proved, const N& of_run) {
    return !(static_cast<long double>((of_run - proved).least_size()) > 0);
  }
  struct Row {
    std::size_t number;
    std::optional<N> proved;
    long double bound;
  };
  // Calls f for every column of the result that has rows here: that of doubles, and that of decimals below /exact.
  template <class F> void for_each_column(Result& result, F f) const {
    for (const auto& [path, rows] : columns_) {
      const auto slash = path.rfind('/');
      for (Group& group : result.groups)
        for (const std::string& folder : {std::string(), std::string("exact/")})
          if (group.name == folder + path.substr(0, slash))
            for (Column& column : group.columns)
              if (column.name == path.substr(slash + 1)) f(folder + path, column, rows);
    }
  }
  static void compare(const std::string& path, const Column& column, const std::vector<Row>& rows,
                      Agreement<N>& agreement) {
    for (const Row& row : rows) {
      const auto compare = [&](const auto& of_run, long double rounding) {
        const auto quantity = [&] { return fmt::format("row {} of /{}", row.number, path); };
        agreement.number(quantity, of_run, row.proved, row.bound + rounding);
      };
      if (row.number >= column.rows()) return agreement.count("rows of /" + path, column.rows(), row.number + 1);
      if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values)) {
        const std::string& text = (*texts)[row.number];
        compare(text == "nan" ? std::string() : text, 0);
      } else if (const auto* counts = std::get_if<std::vector<std::uint64_t>>(&column.values)) {
        compare(fmt::format("{}", (*counts)[row.number]), 0);
      } else {
        const double number = std::get<std::vector<double>>(column.values)[row.number];
        compare(number, std::abs(number) * static_cast<long double>(std::numeric_limits<double>::epsilon()) +
                            static_cast<long double>(std::numeric_limits<double>::denorm_min()));
      }
    }
  }

  std::map<std::string, std::vector<Row>> columns_;
};

}  // namespace cradle::tools
