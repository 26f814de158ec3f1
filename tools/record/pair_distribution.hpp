// The pair distribution (core/observe/structure.hpp).
#pragma once

#include "cradle/core/observe/structure.hpp"
#include "cradle/tools/record/places.hpp"

namespace cradle::tools {

/// Throws Error if no length is known.
inline PairDistribution pair_distribution(const Scene& scene) {
  const Pairs& wanted = scene.output.pair_distribution;
  return {wanted.distance.value, wanted.bins, length_of(scene, "output.pair_distribution"), scene.initial.on_ring()};
}

inline Group pair_table(const Scene& scene) {
  return {"pair_distribution",
          {},
          {{"distance", "l", "centre of the bin", pair_distribution(scene).centres()},
           {"pair_distribution", "1", "pairs at this distance, over their mean number at independent places", {}}}};
}

using PairTables = PlaceTables<&Output::pair_distribution, pair_table>;

class PairMeasurement : public PlaceMeasurement<PairDistribution, PairTables> {
 public:
  static constexpr MeasurementRow row =
      PairTables::row("pair_distribution", "pair_distribution_average", "output.pair_distribution.times");

  explicit PairMeasurement(const Measured& of)
      : PlaceMeasurement(of, pair_distribution(of.scene), pair_table(of.scene)) {}
};

}  // namespace cradle::tools
