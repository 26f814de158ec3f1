// What the program needs to know of each scalar type, one row per type. A new type is a header in precision/, its line
// in the list there (precision/scalars.hpp), and its row here.
#pragma once

#include <cstdint>
#include <string_view>

#include "cradle/tools/support/table.hpp"

namespace cradle::tools {

enum class Precision { double_, long_double, double_double, float128, cpp_bin_float, mpfr };

struct ScalarRow {
  // A quantity that grows linearly with the digits, for types with a variable number of digits.
  struct Linear {
    double fixed, per_digit = 0;
    constexpr double at(std::uint64_t digits) const { return fixed + per_digit * static_cast<double>(digits); }
  };

  Precision type;
  std::string_view name;  // as in scenes and precision/
  unsigned digits;        // decimal ones that every number has; 0: as many as the scene says
  // Time per collision in gaps and in positions, relative to gaps in double (Fig. 2 to t = 4000, bench_precision), and
  // bytes per number.
  Linear gaps, absolute, bytes;
  // The range of positive numbers; empty: practically without limit.
  std::string_view largest, least;
};

// Largest and least numbers of types whose exponents have so many bits.
inline constexpr std::string_view of_11_bits[] = {"1.7976931348623157e308", "2.2250738585072014e-308"},
                                  of_15_bits[] = {"1.18973149535723176502e4932", "3.3621031431120935063e-4932"};

inline constexpr ScalarRow scalar_rows[] = {
    {Precision::double_, "double", 15, {1}, {1.2}, {8}, of_11_bits[0], of_11_bits[1]},
    {Precision::long_double, "long double", 18, {5.3}, {4}, {16}, of_15_bits[0], of_15_bits[1]},
    {Precision::double_double, "double-double", 31, {2.6}, {6.6}, {16}, of_11_bits[0], of_11_bits[1]},
    {Precision::float128, "float128", 33, {10}, {30}, {16}, of_15_bits[0], of_15_bits[1]},
    // The exponent has 32 bits.
    {Precision::cpp_bin_float, "cpp_bin_float", 100, {41}, {104}, {64}, "1e323228496", "1e-323228496"},
    {Precision::mpfr, "mpfr", 0, {6.3, 0.112}, {22, 0.4}, {48, 1 / 2.4}, "", ""},
};
static_assert(rows_in_order(scalar_rows));

constexpr const ScalarRow& scalar_row(Precision type) { return scalar_rows[static_cast<std::size_t>(type)]; }

}  // namespace cradle::tools
