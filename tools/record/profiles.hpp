// Averages over bins at times (core/observe/profile.hpp).
#pragma once

#include <cmath>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

inline Group profile_table(const Scene& scene) {
  Group table{"profiles",
              {},
              {{"x", "l", "centre of the bin", {}},
               {"velocity", "l/t", "mass-weighted mean velocity", {}},
               {"density", "1/l", "particles per length", {}},
               {"mass_density", "m/l", "mass per length", {}},
               {"temperature", "l^2/t^2", "mass-weighted variance of velocity", {}},
               {"density_right", "1/l", "right-moving particles per length", {}},
               {"velocity_right", "l/t", "mean velocity of right-movers", {}},
               {"density_left", "1/l", "left-moving particles per length", {}},
               {"velocity_left", "l/t", "mean velocity of left-movers", {}}}};
  if (const Profiles& wanted = scene.output.profiles; !wanted.range.empty())
    table.columns.front().values = bin_centres({wanted.range[0].value, wanted.range[1].value}, wanted.bins);
  return table;
}

class ProfileMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "profiles",
      .wanted = [](const Scene& scene) { return !scene.output.profiles.times.empty(); },
      .leave_out = [](Output& output) { output.profiles.times.clear(); },
      .times = [](const Output& output) -> const std::vector<Decimal>& { return output.profiles.times; },
      .key = "output.profiles.times",
      .table_at = profile_table,
      .kept = true,
  };

  explicit ProfileMeasurement(const Measured& of) : scene_(of.scene) {}

  void find(const RunState& now, const Stopped& stopped) {
    found_ = now.profile(range(now), scene_.output.profiles.bins, stopped);
  }
  void record(const RunState& now, const Due&, TableSink& put) {
    Group table =
        filled(profile_table(scene_), std::move(found_.x), std::move(found_.velocity), std::move(found_.density),
               std::move(found_.mass_density), std::move(found_.temperature), std::move(found_.density_right),
               std::move(found_.velocity_right), std::move(found_.density_left), std::move(found_.velocity_left));
    table.name = numbered(row.name, written_);
    table.attributes = {{"time", now.time.meant.value}};
    put.add(std::move(table));
  }

  static auto state(auto& self) { return fields(self.written_); }

 private:
  BinRange range(const RunState& now) const {
    BinRange range{};
    if (const auto& wanted = scene_.output.profiles.range; !wanted.empty()) {
      range = {wanted[0].value, wanted[1].value};
    } else if (scene_.initial.on_ring()) {
      range = {0, now.circumference().value};
    } else {
      range = now.ends();
    }
    if (!(range.from < range.to)) range.to = range.from + 1;  // all particles at one place: the range has length 1
    if (!(range.from < range.to) || !std::isfinite(range.to - range.from))
      throw Error(scene_.place("output.profiles.range"), "not given, and the particles are too far away for bins",
                  fmt::format("{:g} to {:g} at t = {}", range.from, range.to, now.time.exact.text()),
                  "give it, or remove output.profiles", Exit::lost);
    return range;
  }

  const Scene& scene_;
  Profile found_;
  std::uint64_t written_ = 0;
};

}  // namespace cradle::tools
