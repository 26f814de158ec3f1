// The paper's predictions for a scene as one table, from which `cradle theory` and the curves on the pictures come.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct Prediction {
  std::string quantity;     // front_position, energy, ...
  std::string equation;     // in the paper: "(5)"
  std::string form;         // continuous, discrete; printed: as the paper prints it, where that is a misprint
  std::optional<double> t;  // for curves
  double value;
};

/// Curves and numbers that apply to the scene; times are those since run.start. Empty where the paper says nothing.
std::vector<Prediction> predictions(const Scene& scene);

/// Which of the formulas used for this scene's law the paper misprints, in words; empty where none.
std::string misprints(const Scene& scene);

/// Long-format CSV: quantity,equation,form,t,value; t empty for single numbers.
std::string predictions_csv(const std::vector<Prediction>& table);

}  // namespace cradle::tools
