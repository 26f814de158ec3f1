#pragma once
// What happens to files: random damage to their bytes, a full disk.

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace cradle::tests {

// The number of mutations; CRADLE_MUTATIONS can increase it.
inline int mutations(int usual) {
  const char* wanted = std::getenv("CRADLE_MUTATIONS");
  return wanted != nullptr ? std::atoi(wanted) : usual;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  // Adds up to three faults, none of them before the given byte.
  std::string mutate(std::string bytes, std::size_t from = 0) {
    for (std::size_t faults = 1 + below(1 + below(3)); faults > 0 && bytes.size() > from + 8; --faults)
      damage(bytes, from);
    return bytes;
  }

 private:
  void damage(std::string& bytes, std::size_t from) {
    const auto anywhere = [&] { return from + below(bytes.size() - from); };
    const std::size_t at = anywhere(), n = std::min(1 + below(below(600) + 1), bytes.size() - at);
    const std::size_t kind = below(9);
    if (kind == 0)
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
    else if (kind == 1)
      bytes.resize(at);
    else if (kind == 2)
      bytes.erase(at, n);
    else if (kind == 3)
      bytes.insert(at, bytes.substr(at, n));
    else if (kind == 4)
      bytes.replace(at, n, bytes.substr(anywhere(), n));
    else if (kind == 5)
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), n, '\0');
    else if (kind == 6)
      for (std::size_t k = 0; k < n; ++k) bytes[at + k] = static_cast<char>(below(256));
    else if (kind == 7)
      number(bytes, below(2) == 0 ? at : std::max(from, at / 8 * 8));
    else
      number(bytes, std::max(from, structure(bytes, at)) + below(64));
  }

  // The position after this one at which HDF5's own structures begin.
  std::size_t structure(const std::string& bytes, std::size_t at) {
    static constexpr std::array names{"TREE", "HEAP", "SNOD", "GCOL", "OHDR", "FRHP", "BTHD", "\x89HDF"};
    const std::size_t found = bytes.find(names.at(below(names.size())), at);
    return found == bytes.npos ? 0 : found;
  }

  // Writes impossible sizes, counts and addresses, infinity and nan.
  void number(std::string& bytes, std::size_t at) {
    static constexpr std::uint64_t infinity = 0x7FF0000000000000, nan = 0x7FF8000000000000;
    static constexpr std::array<std::uint64_t, 11> wrong{
        0, 1, 96, 255, 65535, 1ULL << 40, 1ULL << 63, ~0ULL, infinity, nan, 0xFFEFFFFFFFFFFFFF};
    std::uint64_t value = wrong.at(below(wrong.size()));
    const std::size_t width = std::size_t{1} << below(4);
    for (std::size_t k = at; k < std::min(at + width, bytes.size()); ++k, value >>= 8)
      bytes[k] = static_cast<char>(value & 255);
  }

  std::mt19937_64 random_;
};

// During its lifetime files cannot grow beyond 10 kB: further writes fail.
class SmallFiles {
 public:
  SmallFiles() {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = 10000;
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFiles() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace cradle::tests
