// Which of the two scenarios of Fig. 9 a wet row follows (core/observe/scenario.hpp).
#pragma once

#include "cradle/core/base/fields.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/tools/record/measurement.hpp"
#include "cradle/tools/record/series.hpp"

namespace cradle::tools {

/// Named numbers; NaN for those that the run, which begins at `start`, does not have.
inline Summary scenario_numbers(const Scenario& s, double start = 0) {
  const bool met = s.passes + s.sticks > 0;
  return {{"pair_established", start + s.established},
          {"first_meeting", s.first_meeting},
          {"first_passed", met ? double(s.first_passed) : none()},
          {"passes", static_cast<double>(s.passes)},
          {"sticks", static_cast<double>(s.sticks)},
          {"role_changes", static_cast<double>(s.role_changes)},
          {"regime", static_cast<double>(s.regime)},
          {"separation_exponent", s.separation_exponent},
          {"speed_exponent", s.speed_exponent}};
}

class ScenarioMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "scenario",
      .at_end = "scenario",
      .wanted = [](const Scene& scene) { return scene.output.scenario; },
      .samples = [](const Scene& scene) { return scene.output.scenario ? series_times(scene) : DecimalColumn(); },
      .summary =
          [](const Scene&) {
            std::vector<std::string> names;
            for (auto& [name, value] : scenario_numbers({})) names.push_back(name);
            return names;
          },
      .of_particles = false,
  };

  explicit ScenarioMeasurement(const Measured& of) : clouds_(has_clouds(of.scene)), start_(of.scene.run.start.value) {}

  void made(const Counts& now) { merges_ = now.merges; }
  void collision(const ObservedCollision& c) { watch_.collision(c.left, c.right, c.time, merges_); }
  void record(const RunState& now, const Due&, TableSink& put) { record_last(now, put); }
  void record_last(const RunState& now, TableSink&) {
    if (clouds_) now.sample(watch_);
  }
  void finish(const RunState&, TableSink& put) {
    found_ = scenario_numbers(watch_.result(merges_), start_);
    put.add(Group{"scenario", {found_.begin(), found_.end()}, {}});
  }
  Summary summary() const { return found_; }

  static auto state(auto& self) { return fields(self.watch_); }

 private:
  bool clouds_;
  double start_;
  ScenarioWatch watch_;
  std::uint64_t merges_ = 0;
  Summary found_;
};

}  // namespace cradle::tools
