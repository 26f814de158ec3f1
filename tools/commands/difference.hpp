// The differences of two results. Everything is compared: attributes, groups and columns that only one of them has,
// units, shapes and every number. Differences within the tolerance are counted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

struct Difference {
  std::string place;           // "@outcome", "series/energy", "snapshots/0000@time"
  std::string what;            // the first difference there and its size, and how many more there are
  std::optional<double> size;  // the largest of its numbers, relative; nothing if one of them is infinite or NaN
};

struct ResultDifferences {
  std::vector<Difference> found;
  std::uint64_t numbers = 0;    // compared
  std::uint64_t tolerated = 0;  // different, but within the tolerance
};

/// Numbers a and b are equal if |a - b| <= rtol max(|a|, |b|). With rtol = 0 their bits must be equal; all NaN are
/// equal. `first` and `second` name the results in the text.
ResultDifferences differences(const Result& a, const Result& b, const std::string& first, const std::string& second,
                              double rtol = 0);

/// How many steps between neighbouring numbers of the type lead from a to b; 0 and -0 are the same.
std::uint64_t ulps_between(double a, double b);

}  // namespace cradle::tools
