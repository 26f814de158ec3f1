// What stands behind the last byte of HDF5's in a result file: "CRADLES1", the length of HDF5's part, and the CRC-64 of
// all that comes before it, eight bytes each. HDF5 passes over it, and drops it when it changes the file (h5py "r+").
// So a file with a seal is as it was written, or known to be damaged before HDF5, which may crash or hang on damaged
// files, has read it. One without was changed on purpose, and must end where HDF5 says that it does.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cradle::tools {

inline constexpr std::size_t seal_size = 24;

/// Of the bytes that HDF5 wrote.
std::string seal_of(std::string_view bytes);

/// Of a file that HDF5 wrote.
std::string seal_of_file(const std::string& path);

/// Reads the file once. Throws Error (Exit::io) for one that is damaged, cannot be read, or is no file at all.
void check_seal(const std::string& path);

}  // namespace cradle::tools
