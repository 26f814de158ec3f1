// Mean-square displacements and velocity correlations of tagged particles (core/observe/correlations.hpp).
#pragma once

#include <cmath>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/observe/correlations.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

inline std::vector<Group> correlation_tables(const Scene& scene) {
  const Correlations& wanted = scene.output.correlations;
  if (!wanted.every) return {};
  std::vector<double> lags;
  for (const std::uint64_t steps : Correlator::lags(longest_lag(scene)))
    lags.push_back(decimal_between(Decimal(), *wanted.every, Decimal(std::to_string(steps))).value);
  return {
      {"correlations",
       span_of(wanted),
       {{"lag", "t", "time between the two states", std::move(lags)},
        {"msd", "l^2", "mean-square displacement of a tagged particle, not folded on rings", {}},
        {"msd_sem", "l^2", "standard error", {}},
        {"vacf", "l^2/t^2", "velocity autocorrelation: mean product of the two velocities of a tagged particle", {}},
        {"vacf_sem", "l^2/t^2", "standard error", {}}}}};
}

class CorrelationMeasurement {
 public:
  static constexpr MeasurementRow row = row_of_samples<&Output::correlations>("correlations", correlation_tables);

  /// Throws Error for more tagged particles than memory holds.
  explicit CorrelationMeasurement(const Measured& of)
      : scene_(of.scene), times_(of.samples),
        tagged_(of.engine.tag(static_cast<ParticleIndex>(of.scene.output.correlations.tag_every))),
        correlator_(checked(), longest_lag(of.scene)) {}

  void record(const RunState& now, const Due&, TableSink&) {
    const TaggedMotion motion = now.tagged();
    correlator_.add(motion.displacement, motion.velocity);
  }
  void finish(const RunState&, TableSink& put) {
    if (correlator_.samples() == 0 || !(put.for_file() || correlator_.samples() == times_)) return;
    Group table = std::move(correlation_tables(scene_).front());
    const auto found = correlator_.correlations();
    const auto displacements = numbers_of(found, &Correlator::Correlation::displacement),
               velocities = numbers_of(found, &Correlator::Correlation::velocity);
    table = filled(table, table.columns.front().values, numbers_of(displacements, &BatchMean::mean),
                   numbers_of(displacements, &BatchMean::error), numbers_of(velocities, &BatchMean::mean),
                   numbers_of(velocities, &BatchMean::error));
    append(table.attributes, {{"samples", correlator_.samples()},
                              {"particles", std::uint64_t{tagged_}},
                              {"error_growth", error_growth(displacements)}});
    put.add(std::move(table));
  }

  static auto state(auto& self) { return fields(self.correlator_); }

 private:
  std::size_t checked() const {
    constexpr double most = 4e9;
    const auto count = static_cast<double>(tagged_);
    if (const double bytes = Correlator::bytes(count, longest_lag(scene_)); bytes > most)
      throw Error(scene_.place("output.correlations.tag_every"), "more tagged particles than memory is for",
                  fmt::format("{} of them, {:.2g} bytes", tagged_, bytes),
                  fmt::format("give {:.0f} or more, or a shorter output.correlations.longest",
                              static_cast<double>(scene_.output.correlations.tag_every) * std::ceil(bytes / most)));
    return tagged_;
  }

  const Scene& scene_;
  std::size_t times_;
  std::size_t tagged_;  // particles
  Correlator correlator_;
};

}  // namespace cradle::tools
