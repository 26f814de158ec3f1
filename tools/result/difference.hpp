// In what two results differ. Nothing is passed over: attributes, groups and columns that only one of them has, units,
// shapes and every number; what a tolerance lets pass is counted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

struct Differences {
  /// A line each: where, the first difference there and its size, how many more there are.
  std::vector<std::string> lines;
  std::uint64_t numbers = 0;    // compared
  std::uint64_t tolerated = 0;  // not the same, but within the tolerance
};

/// Numbers a and b are taken as the same where |a - b| <= rtol max(|a|, |b|); with rtol = 0 only the same bits are, and
/// any not-a-number is like any other. `first` and `second` are what the results are called.
Differences differences(const Result& a, const Result& b, const std::string& first, const std::string& second,
                        double rtol = 0);

/// How many numbers of the type lie from one to the other, 0 to -0 being none.
std::uint64_t ulps_between(double a, double b);

}  // namespace cradle::tools
