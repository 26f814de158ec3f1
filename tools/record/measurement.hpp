// A measurement: what a run may be asked to record. Each has a file here, with a row (what others must know of it: its
// times and tables) and a class that finds and records its numbers, and at the end puts them into a table.
// The list of all is in measurements.hpp; runs, files, ensembles and comparisons follow from it.
//
// The class has, of these, the members that it needs. `now` is a RunState (engines/any_engine.hpp), `put` takes tables.
//
//   explicit X(measured)       begins
//   begin_again()              as just begun; without it, another one is made
//   find(now, stopped)         at a time that is due: changes nothing yet, and throws WalkStopped where `stopped` stops
//                              a loop
//   record(now, due, put)      then: keeps or puts what was found
//   record_last(now, put)      where a run ends early, with a collision
//   made(counts)               gets the counts before the next collision, before rows are written and at the end
//   collision(c)               every collision, before it is made
//   rows(), put_rows(put)      of a table that grows during the run: how many wait, and puts these
//   finish(now, put)           the end
//   summary()                  numbers of the whole run, by name
//   state(self), loaded()      what a checkpoint holds (core/base/state.hpp)
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/record/schedule.hpp"

namespace cradle::tools {

/// What a measurement is made for.
struct Measured {
  const Scene& scene;
  AnyEngine& engine;
  std::size_t samples;
  bool exact;  // whether texts of numbers with all digits are wanted
};

using Summary = std::vector<std::pair<std::string, double>>;

// ---- what several of them need

/// The times of samples from, by and up to what the scene gives.
template <class Wanted> DecimalColumn samples_of(const Wanted& wanted) {
  return wanted.every ? decimals_by_step(wanted.from, *wanted.every, wanted.until) : DecimalColumn();
}

/// The row of what is found in samples alone, for the member `wanted` of Output: its one table has its name.
template <auto wanted>
constexpr MeasurementRow row_of_samples(std::string_view name, decltype(MeasurementRow::tables_at_end) tables) {
  return {.name = name,
          .at_end = name,
          .wanted = [](const Scene& scene) { return (scene.output.*wanted).every.has_value(); },
          .leave_out = [](Output& output) { output.*wanted = {}; },
          .samples = [](const Scene& scene) { return samples_of(scene.output.*wanted); },
          .tables_at_end = tables,
          .of_many_collisions = true};
}

/// The attributes of a table of a span of time.
template <class Wanted> std::vector<Attribute> span_of(const Wanted& wanted) {
  return {{"from", wanted.from.value}, {"until", wanted.until.value}};
}

/// The name of the next table of a folder.
inline std::string numbered(std::string_view folder, std::uint64_t& n) { return fmt::format("{}/{:04}", folder, n++); }

}  // namespace cradle::tools
