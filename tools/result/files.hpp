// A result in files: HDF5, which HDF5 builds in memory first, and text. Nothing in a file that is read is trusted
// (reader.cpp).
//
// The last 24 bytes of a result file, after HDF5's part: "CRADLES1", the length of HDF5's part, and the CRC-64 of
// everything before it, eight bytes each. HDF5 ignores them, and drops them when it changes the file (h5py "r+"). So
// damage is known before HDF5 reads the file; HDF5 may crash or hang on damaged files. A file without a seal was
// changed on purpose; it must have the length that HDF5 states.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// Throws Error (Exit::io) naming the file: missing, damaged, or not written by this program.
Result read_result(const std::string& path, Reading reading = Reading::everything);

/// The whole file, its seal included. Two equal results give the same bytes.
std::string file_image(const Result& result);

/// For results too large for memory. `ends` has every group with its number of rows, but only the first and last row of
/// each; `pieces` calls its argument with all rows, piece by piece in order. The bytes differ from those of file_image,
/// the contents do not. Throws Error (Exit::io).
using Pieces = std::function<void(const std::function<void(const Group& rows)>& put)>;
void write_in_pieces(const Result& ends, const Pieces& pieces, const std::string& path);

/// Writes the file at `path`, whole or not at all. Throws Error (Exit::io).
void write_result(const Result& result, const std::string& path);

/// The same for results that took long to compute: if the file cannot be written, it is kept in the folder for
/// temporary files, and the Error says where.
void write_or_keep(const Result& result, const std::string& path);

// ---- the seal (seal.cpp)

inline constexpr std::size_t seal_size = 24;

/// The seal for these bytes of HDF5.
std::string seal_of(std::string_view bytes);

/// The seal for a file that HDF5 wrote.
std::string seal_of_file(const std::string& path);

/// Reads the file once. Throws Error (Exit::io) if it is damaged, cannot be read, or is not a regular file.
void check_seal(const std::string& path);

// ---- as text, one CSV file per group, and the scene, ready to be run again (csv.cpp)

/// One line per row, with enough digits to read the same number back. Shorter columns (gaps of n particles) leave their
/// last fields empty. Attributes come first, as comments.
std::string csv(const Group& group);

/// Writes GROUP.csv for every group below `folder`, and scene.toml if there is a scene: that of the file, and those of
/// a sweep's points; files.txt lists them. Returns the paths. What was exported there before from the result named `of`
/// is removed; anything else in the way is refused (Exit::bad_input) unless forced. Throws Error (Exit::io).
std::vector<std::string> export_csv(const Result& result, const std::string& folder, const std::string& of = "",
                                    bool forced = false);

}  // namespace cradle::tools
