#pragma once
// Whole numbers that are spaced nearly logarithmically: 1, 2, ..., 16, 18, ..., 32, 36, ..., 64, 72, ...; beyond 8,
// eight in every octave. Lags of correlations and wave numbers are such multiples.

#include <cstdint>
#include <vector>

namespace cradle {

inline std::vector<std::uint64_t> octave_steps(std::uint64_t last) {
  std::vector<std::uint64_t> steps;
  for (std::uint64_t n = 1, step = 1; n <= last; n += step) {
    steps.push_back(n);
    if (n == 16 * step) step *= 2;
  }
  return steps;
}

}  // namespace cradle
