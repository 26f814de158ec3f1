#pragma once
// How many pieces of memory the program has asked for so far. Compiled apart: where the compiler sees both ends of it,
// it takes the memory of `new` to be freed in the wrong way.

#include <atomic>
#include <cstdint>

namespace cradle::test {

extern std::atomic<std::uint64_t> allocations;

}  // namespace cradle::test
