// The threads of the program: those of oneTBB. Under ThreadSanitizer plain ones, since it sees races in Debian's oneTBB
// that are none.
#pragma once

#include "cradle/core/ensemble/tbb_executor.hpp"

namespace cradle::tools {

#ifdef __SANITIZE_THREAD__
using Threads = ThreadExecutor;
#else
using Threads = TbbExecutor;
#endif

}  // namespace cradle::tools
