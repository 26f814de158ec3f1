// A result as the bytes of an HDF5 file, which HDF5 builds in memory, and on the disk.
#pragma once

#include <functional>
#include <string>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// The whole file, its seal included (seal.hpp). Two equal results give the same bytes.
std::string file_image(const Result& result);

/// What is too large for memory, row after row: `ends` has every group, with as many rows as there are (those between
/// the first and the last one left out), and `pieces` calls what it is given with all of them, in order. Other bytes
/// than those of file_image, the same contents. Throws Error (Exit::io).
using Pieces = std::function<void(const std::function<void(const Group& rows)>& put)>;
void write_in_pieces(const Result& ends, const Pieces& pieces, const std::string& path);

/// Puts the file at `path`, whole or not at all. Throws Error (Exit::io).
void write_result(const Result& result, const std::string& path);

/// The same for what took long to compute: where it cannot be written it is kept in the folder for temporary files, and
/// the Error says where.
void write_or_keep(const Result& result, const std::string& path);

}  // namespace cradle::tools
