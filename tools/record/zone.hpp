// The average over the interaction zone of a shock (core/observe/zone.hpp).
#pragma once

#include <cmath>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

inline ZoneAverage zone_average(const Scene& scene) {
  const Zone& zone = scene.output.zone;
  const theory::WetShock<double> shock{
      .loss = scene.law.loss.value, .speed = scene.initial.speed.value, .spacing = scene.initial.spacing.value};
  return {zone.reach ? zone.reach->value : 3 * theory::WetZone<double>(shock).half_width(), zone.bins, zone.samples,
          1.0};
}

inline DecimalColumn zone_times(const Scene& scene) {
  const Zone& zone = scene.output.zone;
  const Decimal& until = scene.run.until;
  DecimalColumn times;
  if (zone.from && *zone.from < until) {
    const DecimalColumn all = decimals_by_parts(*zone.from, until, zone.samples, until, scene.run.decimal_digits());
    for (std::size_t k = 0; k < zone.samples; ++k) times.push_back(all[k]);
  } else if (zone.from) {
    times.push_back(zone.from->text);
  }
  return times;
}

inline std::vector<Group> zone_tables(const Scene& scene) {
  const Zone& wanted = scene.output.zone;
  if (!wanted.from) return {};
  const ZoneAverage zone = zone_average(scene);
  std::vector<double> x;
  for (std::size_t bin = 0; bin < wanted.bins; ++bin) x.push_back(zone.centre(bin));
  return {{"zone",
           {{"from", wanted.from->value}, {"until", scene.run.until.value}},
           {{"x", "l", "centre of the bin", std::move(x)},
            {"mass_density", "m/l", "mass per length", {}},
            {"density_right", "1/l", "right-moving single particles per length", {}},
            {"velocity_right", "l/t", "their mean velocity", {}},
            {"density_left", "1/l", "left-moving single particles per length", {}},
            {"velocity_left", "l/t", "their mean velocity", {}}}}};
}

class ZoneMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "zone",
      .at_end = "zone",
      .wanted = [](const Scene& scene) { return scene.output.zone.from.has_value(); },
      .samples = zone_times,
      .tables_at_end = zone_tables,
      .summary = [](const Scene&) { return std::vector<std::string>{"zone_width"}; },
      .until_end = "output.zone.from",
  };

  explicit ZoneMeasurement(const Measured& of) : scene_(of.scene), zone_(zone_average(of.scene)) {}

  void find(const RunState& now, const Stopped& stopped) { now.find(zone_, stopped); }
  void record(const RunState&, const Due&, TableSink&) { zone_.add_found(); }
  void finish(const RunState&, TableSink& put) {
    const double single = 2 * std::sqrt(scene_.law.loss.value);  // u_crit of single particles
    width_ = zone_.width(scene_.initial.speed.value, single);
    Group table = std::move(zone_tables(scene_).front());
    table = filled(table, table.columns.front().values, zone_.mass_density(), zone_.density_right(),
                   zone_.velocity_right(), zone_.density_left(), zone_.velocity_left());
    append(table.attributes,
           {{"samples", std::uint64_t{zone_.samples()}}, {"width", width_.width}, {"width_error", width_.error}});
    put.add(std::move(table));
  }
  Summary summary() const { return {{"zone_width", width_.width}}; }

  static auto state(auto& self) { return fields(self.zone_); }

 private:
  const Scene& scene_;
  ZoneAverage zone_;
  ZoneWidth width_{};
};

}  // namespace cradle::tools
