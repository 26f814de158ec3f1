// Attributes and columns of an HDF5 file. Nothing in the file is trusted: names, types, shapes and sizes are checked
// before use.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cradle/tools/result/hdf5.hpp"
#include "cradle/tools/result/reader.hpp"

namespace cradle::tools::hdf5 {

/// The file that is being read; `where` in the functions below is an object in it: "series/energy".
struct Source {
  std::string path;
  std::uint64_t bytes = 0;  // of the file
  Reading reading = Reading::everything;

  Error wrong(const std::string& where, const std::string& what, const std::string& found) const {
    return {{path, 0, where}, what, found, "take the file from a copy, or make it anew", Exit::io};
  }
  std::string unreadable(const std::string& where) const {
    return path + ": " + (where.empty() ? "" : where + ": ") + "could not be read";
  }
};

/// Throws Error (Exit::io) for a name that cannot be used as the name of a file or in a line of text.
void check_name(const Source& source, const std::string& name, const std::string& where);

/// Both throw Error (Exit::io).
std::vector<Attribute> attributes(const Source& source, hid_t object, const std::string& where);
Column column(const Source& source, hid_t data, const std::string& name, const std::string& where);

}  // namespace cradle::tools::hdf5
