#pragma once
// Shared by the targets: malformed input may only throw Error. Any other exception that leaves a target is a failure,
// as are crashes, sanitizer reports, leaks and more than a minute for one input (-timeout=60).

#include <cstddef>
#include <cstdint>
#include <string>

#include "cradle/tools/support/errors.hpp"

namespace cradle::fuzz {

template <class Work> int refused_or_read(const std::uint8_t* data, std::size_t size, Work work) {
  try {
    work(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const tools::Error&) {
  }
  return 0;
}

}  // namespace cradle::fuzz
