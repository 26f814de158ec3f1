// A result as the bytes of an HDF5 file, and on the disk. HDF5 builds the file in memory and never touches the disk: on
// a full one it would crash at exit, flushing again what it could not write.
#pragma once

#include <string>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// The whole file, its seal included (seal.hpp). Two equal results give the same bytes.
std::string file_image(const Result& result);

/// Puts the file at `path`, whole or not at all. Throws Error (Exit::io).
void write_result(const Result& result, const std::string& path);

/// The same for what took long to compute: where it cannot be written it is kept in the folder for temporary files, and
/// the Error tells where.
void write_or_keep(const Result& result, const std::string& path);

}  // namespace cradle::tools
