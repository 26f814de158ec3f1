// The global operators new and delete, with a count. (Those of arrays call these.) Compiled separately: if the compiler
// sees both operators, it warns that the memory of `new` is freed in the wrong way.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace cradle::test {
std::atomic<std::uint64_t> allocations{0};
}

namespace {

void* counted(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) {
  ++cradle::test::allocations;
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* memory =
      alignment > alignof(std::max_align_t) ? std::aligned_alloc(alignment, whole) : std::malloc(size + !size);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::align_val_t a) { return counted(size, static_cast<std::size_t>(a)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
