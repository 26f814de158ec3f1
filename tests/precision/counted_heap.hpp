#pragma once
// How many pieces of memory the program has requested until now. Compiled separately: if the compiler sees both
// operators, it warns that the memory of `new` is freed in the wrong way.

#include <atomic>
#include <cstdint>

namespace cradle::test {

extern std::atomic<std::uint64_t> allocations;

}  // namespace cradle::test
