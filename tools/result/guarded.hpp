// Work that may crash or never end, in a process of its own: HDF5 does both on some damaged files.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace cradle::tools {

/// What `work` returns. Throws Error where it does; nothing comes back where it crashes, or takes more than so many
/// seconds of processor time.
std::optional<std::string> in_another_process(const std::function<std::string()>& work, unsigned seconds);

}  // namespace cradle::tools
