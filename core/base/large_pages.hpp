#pragma once
// Memory for long arrays, on large pages where the system has them. Memory is given page by page when it is first
// touched, and the first touch of a page of 4 kB takes up to 40 us in virtual machines: there the memory of a large run
// costs more than its collisions (bench/results/trials.md).

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace cradle {

template <class T> struct OnLargePages {
  using value_type = T;
  OnLargePages() = default;
  template <class U> OnLargePages(const OnLargePages<U>&) {}

  T* allocate(std::size_t count) {
    if (!is_long(count)) return std::allocator<T>().allocate(count);
    void* const memory = ::operator new(count * sizeof(T), alignment);
#ifdef __linux__
    madvise(memory, count * sizeof(T), MADV_HUGEPAGE);  // a system without them refuses, and has small ones
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    if (is_long(count))
      ::operator delete(memory, alignment);
    else
      std::allocator<T>().deallocate(memory, count);
  }
  friend bool operator==(const OnLargePages&, const OnLargePages&) { return true; }

 private:
  static constexpr std::size_t page = std::size_t{1} << 21;
  static constexpr std::align_val_t alignment{page};
  static bool is_long(std::size_t count) { return count >= 2 * page / sizeof(T); }
};

template <class T> using LongArray = std::vector<T, OnLargePages<T>>;

}  // namespace cradle
