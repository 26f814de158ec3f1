// A result in memory: named tables and attributes, in the order in which they are written. Whoever writes files (HDF5,
// CSV) or looks into them (info, plot) sees this form only; its layout is that of the contract for result files.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace cradle::tools {

using Numbers = std::variant<std::vector<double>, std::vector<std::uint64_t>>;

/// One dataset: float64 or uint64, with unit and a line of description. A dataset of width 2 has two numbers a row.
struct Column {
  std::string name;
  std::string unit;
  std::string description;
  Numbers values;         // row after row
  std::size_t width = 1;  // numbers in a row
  bool names = false;     // they name something, bodies for instance: a mean of them would mean nothing

  std::size_t rows() const {
    return std::visit([](const auto& v) { return v.size(); }, values) / width;
  }
};

using Attribute = std::pair<std::string, std::variant<std::string, double, std::uint64_t>>;

/// "series", "snapshots/0000", ...; a group may hold attributes only.
struct Group {
  std::string name;
  std::vector<Attribute> attributes;
  std::vector<Column> columns;
};

struct Result {
  std::vector<Attribute> attributes;  // of the file
  std::vector<Group> groups;

  const Group* find(const std::string& name) const;
};

/// The attribute of this name, which must be there and of this type; throws Error (Exit::io) naming `where` otherwise.
template <class T>
const T& attribute(const std::vector<Attribute>& attributes, const std::string& name, const std::string& where);

/// Writes the whole file at once under a temporary name beside it, syncs and renames: what stands at `path` is always
/// complete. Two equal results give the same bytes. Throws Error (Exit::io).
void write_result(const Result& result, const std::string& path);

/// Throws Error (Exit::io) naming the file: missing, not HDF5, truncated, or not written by this program.
Result read_result(const std::string& path);

/// Fails now, with Error (Exit::io), rather than after the run: can a file be made at `path`?
void check_writable(const std::string& path);

}  // namespace cradle::tools
