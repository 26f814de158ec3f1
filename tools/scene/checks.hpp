// What a scene must be like. keys.cpp checks that its keys are known and apply to its law, initial state and policy.
// checks_of_state.cpp and checks.cpp check what several keys say together: they refuse rows that do not meet, particles
// out of order, two settings for the same thing, and numbers beyond the range of the working precision.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Makes one entry, a table, of all entries inside what is a key: it is refused where the key is read, when the numbers
/// that its range depends on are known. Ranges of times are lists already.
void gather_tables(Entries& entries);

/// Throws Error for the first unknown key, with the most similar known one.
void refuse_unknown_keys(const Entries& entries);

/// Throws Error for the first key that does not apply to this scene, with the reason. Checks the keys that depend on
/// `decider`, or all keys if it is empty.
void refuse_inapplicable_keys(const Entries& entries, const Scene& scene, std::string_view decider = {});

/// Throws Error at the place of the wrong key. `entries` give the places of keys; `scene_file` names the file for keys
/// that are missing.
void check_scene(const Scene& scene, const Entries& entries, const std::string& scene_file);

/// The numbers that the working precision of a run can hold, beside 0. A larger number would become infinite and spoil
/// the run; a smaller one would become 0.
class NumberRange {
 public:
  explicit NumberRange(const Run& run) : type_(scalar_row(run.precision)) {}

  /// Throws Error at `place` if a canonical decimal is too large or too small.
  void check(std::string_view literal, const Place& place) const;

 private:
  const ScalarRow& type_;
};

/// Throws Error unless particle `right` of a list and the one before it are in order, and apart in the working
/// precision if they are not at one place. Those at one place must not approach: whether one of them collides before
/// with a third one would be open.
void check_neighbours(const DecimalColumn& x, const DecimalColumn& v, std::size_t right, const NumberRange& range,
                      const Place& place);

/// The same of all neighbours; `before` is the place of what is said of a particle and the one before it.
void check_order(const DecimalColumn& x, const DecimalColumn& v, const Run& run,
                 const std::function<Place(std::size_t)>& before);

}  // namespace cradle::tools
