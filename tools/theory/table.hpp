// The paper's predictions for a scene as one table, for `cradle theory` and for the curves in pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct Prediction {
  std::string quantity;     // front_position, energy, ...
  std::string equation;     // in the paper: "(5)"
  std::string form;         // continuous, discrete; printed: the paper's own form if it has a misprint
  std::optional<double> t;  // for curves
  double value;
};

/// Curves and numbers that apply to the scene; times are counted from run.start. Empty if the paper predicts nothing.
std::vector<Prediction> predictions(const Scene& scene);

/// Which of the paper's formulas for this scene's law have misprints, in words; empty if none.
std::string misprints(const Scene& scene);

/// Long-format CSV: quantity,equation,form,t,value; t empty for single numbers.
std::string predictions_csv(const std::vector<Prediction>& table);

}  // namespace cradle::tools
