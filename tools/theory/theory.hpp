// What is known of a scene before it runs: its cost, and the paper's predictions as one table, for `cradle theory` and
// for the curves in pictures. Predictions end where a front has passed through the other row.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

// ---- the cost

/// Collisions by the laws of the shock and of gases, time by the speed of each scalar type, memory by the bytes per
/// particle. Orders of magnitude, for planning.
struct Cost {
  double particles = 0;              // in the active zone at the end, at most
  std::optional<double> collisions;  // none: not known for this initial state
  std::optional<double> collapse;    // of inelastic collapse, if before the end; collisions: until then
  std::optional<double> clustering;  // of a gas that cools, likewise
  bool floor = false;                // on which particles may collapse, at a time that is not known
  std::string endless = {};          // a line, if nothing ends the run where particles collapse
  double collisions_per_second = 0;
  double seconds_of_samples = 0;
  double memory = 0;  // bytes

  /// Whether the pace of a run says how long the rest takes.
  bool predictable() const { return !collapse && !clustering && !floor; }
};

Cost expected_cost(const Scene& scene);

/// What is expected, in lines: how many collisions, until which collapse or clustering, what follows it, where the run
/// ends then and what ends it sooner or takes it past; or that nothing is known.
std::string expected_lines(const Scene& scene, const Cost& cost);

/// A number of so many digits without a power of ten below a million: 1000, not 1e+03.
std::string about(double x, int digits = 2);

/// These lines if the run ends at a collapse, goes past it or past clustering, or may have no end; else empty.
std::string expected_warning(const Scene& scene);

/// What threads gain for one run: the speed-up at its end, or the reason why it uses one.
struct Threading {
  double gain = 1;
  std::string alone;  // the reason; empty: several threads
};
Threading expected_threading(const Scene& scene, const Cost& cost, unsigned threads);

// ---- predictions

struct Prediction {
  std::string quantity;     // front_position, energy, ...
  std::string equation;     // in the paper: "(5)"
  std::string form;         // continuous, discrete; printed: the paper's own form if it has a misprint
  std::optional<double> t;  // for curves: a time of the scene
  double value;
};

/// Curves and numbers that apply to the scene; times are those of the scene. Empty if the paper predicts nothing.
std::vector<Prediction> predictions(const Scene& scene);

/// Long-format CSV: quantity,equation,form,t,value; t empty for single numbers.
std::string predictions_csv(const std::vector<Prediction>& table);

/// A growing table of predictions; times are given from run.start on.
class Predictions {
 public:
  explicit Predictions(double start) : start_(start) {}
  /// Adds a single number; does nothing if there is no value.
  void number(const char* quantity, const char* equation, const char* form, std::optional<double> value) {
    if (value) rows_.push_back({quantity, equation, form, std::nullopt, *value});
  }
  /// The same for a time.
  void time(const char* quantity, const char* equation, const char* form, std::optional<double> value) {
    if (value) number(quantity, equation, form, start_ + *value);
  }
  /// Adds one point of a curve.
  void point(const char* quantity, const char* equation, const char* form, double t, double value) {
    rows_.push_back({quantity, equation, form, start_ + t, value});
  }
  std::vector<Prediction> take() && { return std::move(rows_); }

 private:
  double start_;
  std::vector<Prediction> rows_;
};

/// What is known of each law beforehand: a row for those of which anything is.
struct LawTheory {
  LawType type = LawType::inelastic;
  void (*predict)(const Scene&, Predictions&) = nullptr;  // the paper's formulas; null if there are none
  void (*cost_of_rows)(const Scene&, Cost&) = nullptr;    // expected collisions of two equal rows; null if not known
  const char* misprints = "";                             // of the paper's formulas for this law
};
/// The row of the scene's law; an empty one if it has none.
const LawTheory& law_theory(const Scene& scene);

/// How long a run lasts.
inline double span(const Scene& scene) { return scene.run.until.value - scene.run.start.value; }
/// The number of layers of one row that a particle of the other would meet if the rows did not slow each other: K = 2
/// u0 t/l.
inline double layers(const Scene& scene, double time) {
  return 2 * scene.initial.speed.value * time / scene.initial.spacing.value;
}

/// Points of a curve, from 0 to its end.
inline constexpr int curve_points = 400;
inline double curve_time(double end, int k) { return end * k / curve_points; }

/// Whether the paper's formulas apply: two equal rows of particles of mass 1 and of constant restitution, which meet
/// nothing else, and whose law is changed, if at all, only below a tenth of their closing speed or of the time between
/// the first collisions: up to there collisions differ by 6 %.
inline bool equal_rows(const Scene& scene) {
  const double closing = 2 * scene.initial.speed.value, flight = scene.initial.spacing.value / closing;
  return scene.initial.type == InitialType::rows && !scene.initial.general_rows() && !unequal_masses(scene) &&
         !scene.walls.any() && !scene.gravity.acts() && !scene.law.cutoff_exponent &&
         10 * std::max(scene.law.cutoff.value, scene.run.merge_speed.value) <= closing &&
         10 * scene.run.contact_time.value <= flight;
}

// By law (laws.cpp): predictions, and expected collisions of two equal rows.
void predict_inelastic(const Scene& scene, Predictions& table);
void predict_wet(const Scene& scene, Predictions& table);
void predict_sticky(const Scene& scene, Predictions& table);
void bouncing_rows(const Scene& scene, Cost& cost);
void wet_rows(const Scene& scene, Cost& cost);
void sticky_rows(const Scene& scene, Cost& cost);

}  // namespace cradle::tools
