// A range of times in place of a list: {from, until, every} or {from, until, points, spacing}.
#pragma once

#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

struct Field;

/// Whether this key takes a list of times, and so a range too.
bool takes_times(const Field& field);

/// Replaces every range of times by the list of its decimals: from + k every, as exact decimals; or evenly spaced
/// points, or points of equal ratios, with 15 digits, which every double holds. Scenes know lists only. Throws Error at
/// the place of the wrong part.
void expand_time_ranges(Entries& entries);

}  // namespace cradle::tools
