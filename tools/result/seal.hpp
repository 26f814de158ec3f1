// The last 24 bytes of a result file, after HDF5's part: "CRADLES1", the length of HDF5's part, and the CRC-64 of
// everything before it, eight bytes each. HDF5 ignores them, and drops them when it changes the file (h5py "r+"). So
// damage is known before HDF5 reads the file; HDF5 may crash or hang on damaged files. A file without a seal was
// changed on purpose; it must have the length that HDF5 states.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cradle::tools {

inline constexpr std::size_t seal_size = 24;

/// The seal for these bytes of HDF5.
std::string seal_of(std::string_view bytes);

/// The seal for a file that HDF5 wrote.
std::string seal_of_file(const std::string& path);

/// Reads the file once. Throws Error (Exit::io) if it is damaged, cannot be read, or is not a regular file.
void check_seal(const std::string& path);

}  // namespace cradle::tools
