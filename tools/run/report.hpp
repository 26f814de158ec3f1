// What a run prints at its end: the collapse that stopped it, and what it could not resolve.
#pragma once

#include <cstdint>
#include <string>

#include "cradle/tools/engines/reported.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/ends.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// The text for standard output; times have all digits that are known.
/// `at_wall`: the wall on which it was, if it can hold particles.
std::string collapse_report(const ReportedCollapse& collapse, RunEnd end, std::uint64_t collisions,
                            const std::string& at_wall);
Group collapse_table(const ReportedCollapse& collapse);

/// The message of a guard that stops a run. What positions may not have resolved is not the machine's fault.
std::string guard_message(const ReportedGuard& guard, const ReportedAccount& account, const Run& run);

/// The text for standard error; empty if everything was resolved.
std::string account_warning(const ReportedAccount& account, const Scene& scene);
/// The warning when time or a gap cannot get smaller.
std::string exhausted_warning(const std::string& time, std::uint64_t collisions, const Scene& scene);

}  // namespace cradle::tools
