// Values as bytes, by their lists of fields (core/base/state.hpp): records of journals, messages between ranks. And
// whether bytes on a disk have changed.
#pragma once

#include <lzma.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "cradle/core/base/state.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

template <class X> std::string to_bytes(const X& x) { return SavedState::of(x).bytes(); }

/// Throws Error (Exit::io) if the bytes are not exactly one such value.
template <class X> X from_bytes(std::string bytes) {
  try {
    SavedState from(std::move(bytes));
    X x;
    load(from, x);
    require_state(from.left() == 0, "it is followed by more");
    return x;
  } catch (const std::invalid_argument& error) {
    throw Error({}, "a record that cannot be read", error.what(), "take the file from a copy, or remove it", Exit::io);
  }
}

/// The checksum of `bytes`, CRC-64/XZ (reflected polynomial of ECMA-182). To continue after earlier bytes, give theirs.
inline std::uint64_t crc64(std::string_view bytes, std::uint64_t of_bytes_before = 0) {
  return lzma_crc64(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), of_bytes_before);
}

}  // namespace cradle::tools
