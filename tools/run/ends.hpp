// How a run, a replica or a proof ends. One table gives the text in results and the exit status.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "cradle/tools/support/errors.hpp"
#include "cradle/tools/support/table.hpp"

namespace cradle::tools {

/// The first five are also outcomes of replicas. Files store these numbers.
enum class RunEnd : std::uint64_t {
  reached,
  collapsed,
  order_lost,
  exhausted,
  failed,
  small_gap,  // below run.stop_gap, without a proof of collapse; for replicas: collapsed
  interrupted,
  undecided,  // of a proof
  unproved    // where many particles collapse, by the default (core/engine/collapse.hpp); for replicas: collapsed
};
inline constexpr std::size_t outcome_count = 5;

struct EndRow {
  RunEnd type;
  std::string_view text;
  Exit status;
};

inline constexpr std::array<EndRow, 9> run_ends{{
    {RunEnd::reached, "reached the end", Exit::done},
    {RunEnd::collapsed, "inelastic collapse", Exit::collapse},
    {RunEnd::order_lost, "order of collisions lost", Exit::lost},
    {RunEnd::exhausted, "resolution exhausted", Exit::lost},
    {RunEnd::failed, "failed", Exit::lost},
    {RunEnd::small_gap, "a gap below run.stop_gap", Exit::collapse},
    {RunEnd::interrupted, "interrupted", Exit::interrupted},
    {RunEnd::undecided, "undecided", Exit::lost},
    {RunEnd::unproved, "inelastic collapse of many particles, not proved", Exit::collapse},
}};
static_assert(rows_in_order(run_ends));

constexpr const EndRow& end_row(RunEnd end) { return run_ends[static_cast<std::size_t>(end)]; }

/// The exit status for the text in a result; done for other texts.
constexpr Exit status_of_text(std::string_view text) {
  for (const EndRow& row : run_ends)
    if (row.text == text) return row.status;
  return Exit::done;
}

}  // namespace cradle::tools
