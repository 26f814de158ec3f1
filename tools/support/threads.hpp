// The threads of the program: those of oneTBB. Under ThreadSanitizer plain threads, since it reports false races in
// Debian's oneTBB.
#pragma once

#include "cradle/core/ensemble/tbb_executor.hpp"

namespace cradle::tools {

#ifdef __SANITIZE_THREAD__
using Threads = ThreadExecutor;
#else
using Threads = TbbExecutor;
#endif

}  // namespace cradle::tools
