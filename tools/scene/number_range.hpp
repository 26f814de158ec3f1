// The numbers that the working precision of a run can hold. A larger number would become infinite and spoil the run; a
// smaller one becomes 0, which is not allowed for masses.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

class NumberRange {
 public:
  explicit NumberRange(const Run& run);

  /// Throws Error at `place` if a canonical decimal is too large.
  void check(std::string_view literal, const Place& place) const;
  /// The same, also if a positive one is too small.
  void check_positive(std::string_view literal, const Place& place) const;

 private:
  std::string precision_;
  // The largest number, its negative, and the smallest positive number with all digits; none: no limit.
  std::optional<std::string> largest_, lowest_, least_;
};

}  // namespace cradle::tools
