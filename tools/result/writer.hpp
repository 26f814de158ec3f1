// Writes a result as an HDF5 file, which HDF5 builds in memory first.
#pragma once

#include <functional>
#include <string>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// The whole file, its seal included (seal.hpp). Two equal results give the same bytes.
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

}  // namespace cradle::tools
