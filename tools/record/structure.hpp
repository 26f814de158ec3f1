// The structure factor (core/observe/structure.hpp).
#pragma once

#include "cradle/core/observe/structure.hpp"
#include "cradle/tools/record/places.hpp"

namespace cradle::tools {

/// Throws Error if no length is known.
inline StructureFactor structure_factor(const Scene& scene) {
  const Structure& wanted = scene.output.structure;
  return {wanted.length ? wanted.length->value : length_of(scene, "output.structure"), wanted.waves};
}

inline Group structure_table(const Scene& scene) {
  return {"structure",
          {},
          {{"k", "1/l", "wave number, 2 pi n/length", structure_factor(scene).wave_numbers()},
           {"s", "1", "structure factor, |sum m exp(ikx)|^2/sum m^2; 1 at independent places", {}}}};
}

using StructureTables = PlaceTables<&Output::structure, structure_table>;

class StructureMeasurement : public PlaceMeasurement<StructureFactor, StructureTables> {
 public:
  static constexpr MeasurementRow row =
      StructureTables::row("structure", "structure_average", "output.structure.times");

  explicit StructureMeasurement(const Measured& of)
      : PlaceMeasurement(of, structure_factor(of.scene), structure_table(of.scene)) {}
};

}  // namespace cradle::tools
