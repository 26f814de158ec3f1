// Whether the program was started under nohup, as hang_ups.cpp, a part of the program alone, reads it before main().
#pragma once

namespace cradle::tools {

inline bool hang_ups_ignored = false;

}  // namespace cradle::tools
