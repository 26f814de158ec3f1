// Which numbers the working precision of a run holds. One beyond it would be infinite there, and what follows no number
// at all; one too small is 0, which everything but a mass can be.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

class NumberRange {
 public:
  explicit NumberRange(const Run& run);

  /// Throws Error at `place` for a canonical decimal that is too large.
  void check(std::string_view literal, const Place& place) const;
  /// The same for a positive one that is too small.
  void check_positive(std::string_view literal, const Place& place) const;

 private:
  std::string precision_;
  // The largest number, its negative, the smallest above 0 with all digits; none: as large and small as one likes.
  std::optional<std::string> largest_, lowest_, least_;
};

}  // namespace cradle::tools
