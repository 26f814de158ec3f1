// Nothing in a file is trusted: names, types, shapes and sizes are checked before use.
#include "cradle/tools/result/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "cradle/tools/result/hdf5.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

using hdf5::check;
using hdf5::Handle;

// The file that is being read; `where` in the functions below is an object in it: "series/energy".
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

// Throws for a name that cannot be used as the name of a file or in a line of text.
void check_name(const Source& source, const std::string& name, const std::string& where) {
  constexpr std::size_t longest = 200;
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; };
  if (name.empty() || name == "." || name == ".." || name.size() > longest || name.find('/') != name.npos ||
      std::any_of(name.begin(), name.end(), control))
    throw source.wrong(where, "holds a name that no result has", name.size() > longest ? "a long one" : name);
}

std::string read_text(const Source& source, hid_t attribute, hid_t type, const std::string& where) {
  if (H5Tis_variable_str(type) > 0) {
    const Handle memory = hdf5::text_type(source.path);
    char* characters = nullptr;
    check(H5Aread(attribute, memory, static_cast<void*>(&characters)), source.unreadable(where));
    const std::unique_ptr<char, decltype(&H5free_memory)> owner(characters, H5free_memory);
    return characters == nullptr ? "" : characters;
  }
  const std::size_t size = H5Tget_size(type);
  if (size > source.bytes) throw source.wrong(where, "longer than the file", fmt::format("{} bytes", size));
  std::string characters(size, '\0');
  check(H5Aread(attribute, type, characters.data()), source.unreadable(where));
  return characters.substr(0, characters.find('\0'));
}

Attribute read_attribute(const Source& source, hid_t object, const std::string& name, const std::string& object_name) {
  check_name(source, name, object_name);
  const std::string where = object_name + "@" + name, what = source.unreadable(where);
  const Handle id(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const Handle type(H5Aget_type(id), H5Tclose, what);
  const Handle space(H5Aget_space(id), H5Sclose, what);
  if (const auto points = H5Sget_simple_extent_npoints(space); points != 1)
    throw source.wrong(where, "an attribute is one number or one text", fmt::format("{} of them", points));
  const auto read = [&](auto value, hid_t memory) {
    check(H5Aread(id, memory, &value), what);
    return value;
  };
  switch (H5Tget_class(type)) {
  case H5T_STRING:
    return {name, read_text(source, id, type, where)};
  case H5T_FLOAT:
    return {name, read(double{}, H5T_NATIVE_DOUBLE)};
  case H5T_INTEGER:
    if (H5Tget_sign(type) != H5T_SGN_NONE)
      if (const auto value = read(std::int64_t{}, H5T_NATIVE_INT64); value < 0)
        return {name, static_cast<double>(value)};
    return {name, read(std::uint64_t{}, H5T_NATIVE_UINT64)};
  default:
    throw source.wrong(where, "an attribute is one number or one text", "another type");
  }
}

std::vector<Attribute> read_attributes(const Source& source, hid_t object, const std::string& where) {
  std::vector<std::string> names;
  hsize_t position = 0;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &position, collect, &names), source.unreadable(where));
  std::vector<Attribute> found;
  for (const auto& name : names) found.push_back(read_attribute(source, object, name, where));
  return found;
}

// Returns the number of rows and sets the column's width.
hsize_t shape(const Source& source, hid_t data, const std::string& where, Column& column) {
  const Handle space(H5Dget_space(data), H5Sclose, source.unreadable(where));
  const int dimensions = H5Sget_simple_extent_ndims(space);
  if (H5Sget_simple_extent_type(space) != H5S_SIMPLE || dimensions < 1 || dimensions > 2)
    throw source.wrong(where, "a column has one or two dimensions", fmt::format("{}", dimensions));
  hsize_t extent[2] = {0, 1};
  if (H5Sget_simple_extent_dims(space, extent, nullptr) != dimensions) throw hdf5::failure(source.unreadable(where));
  if (extent[0] == 0 || extent[1] == 0) return 0;
  column.width = extent[1];
  return extent[0];
}

// Checks, before memory is allocated, that the file is large enough for so many numbers.
void check_size(const Source& source, hid_t data, hid_t type, hsize_t rows, hsize_t width, const std::string& where) {
  constexpr hsize_t most_compressed = 1032;  // deflate's limit
  const Handle how(H5Dget_create_plist(data), H5Pclose, source.unreadable(where));
  const H5D_layout_t layout = H5Pget_layout(how);
  if (layout == H5D_VIRTUAL || (layout == H5D_CONTIGUOUS && H5Pget_external_count(how) != 0))
    throw source.wrong(where, "a column has its numbers in the file", "a reference to another file");
  const hsize_t stored = H5Dget_storage_size(data);
  const hsize_t most =
      stored * (layout == H5D_CHUNKED ? most_compressed : 1) / std::max<std::size_t>(H5Tget_size(type), 1);
  if (stored > source.bytes || (rows > 0 && (width > most || rows > most / width)))
    throw source.wrong(where, "more numbers than the file can hold", fmt::format("{} x {}", rows, width));
}

// Reads all rows, or the first and the last one; `per_value` is the size of a number in memory.
template <class Values>
Values values_of(const Source& source, hid_t data, hid_t memory, hsize_t rows, Column& column,
                 std::size_t per_value = 1) {
  const std::string what = source.unreadable(column.name);
  const bool all = source.reading == Reading::everything || rows <= 2;
  const hsize_t size = (all ? rows : 2) * column.width;
  Values values(size * per_value, typename Values::value_type{});
  if (size == 0) return values;
  const Handle space(H5Dget_space(data), H5Sclose, what), flat(H5Screate_simple(1, &size, nullptr), H5Sclose, what);
  if (!all) {
    const hsize_t start[2] = {0, 0}, step[2] = {rows - 1, 1}, count[2] = {2, column.width};
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, step, count, nullptr), what);
    column.left_out = rows - 2;
  }
  check(H5Dread(data, memory, flat, space, H5P_DEFAULT, values.data()), what);
  return values;
}

std::vector<std::string> read_texts(const Source& source, hid_t data, hid_t type, hsize_t rows, Column& column) {
  const std::size_t bytes = H5Tget_size(type);
  const auto all = values_of<std::string>(source, data, type, rows, column, bytes);
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < all.size(); at += bytes) {
    const std::string text = all.substr(at, bytes);
    texts.push_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

Column read_column(const Source& source, hid_t data, const std::string& name, const std::string& where) {
  Column column{name, "", "", {}};
  for (const auto& [key, value] : read_attributes(source, data, where)) {
    if (key != "unit" && key != "description") continue;
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr) throw source.wrong(where + "@" + key, "is to be text", "a number");
    (key == "unit" ? column.unit : column.description) = *text;
  }
  const Handle type(H5Dget_type(data), H5Tclose, source.unreadable(where));
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_INTEGER && kind != H5T_FLOAT && (kind != H5T_STRING || H5Tis_variable_str(type) != 0))
    throw source.wrong(where, "a column is made of numbers or of texts as long as each other", "another type");
  const hsize_t rows = shape(source, data, where, column);
  check_size(source, data, type, rows, column.width, where);
  if (kind == H5T_INTEGER && H5Tget_sign(type) == H5T_SGN_NONE)
    column.values = values_of<std::vector<std::uint64_t>>(source, data, H5T_NATIVE_UINT64, rows, column);
  else if (kind == H5T_STRING)
    column.values = read_texts(source, data, type, rows, column);
  else
    column.values = values_of<std::vector<double>>(source, data, H5T_NATIVE_DOUBLE, rows, column);
  return column;
}

// Members in the order in which they were written. Older versions did not record it; their members are sorted by name,
// with time first.
std::vector<std::string> members(const Source& source, hid_t group, const std::string& where) {
  const Handle how(H5Gget_create_plist(group), H5Pclose, source.unreadable(where));
  unsigned order = 0;
  check(H5Pget_link_creation_order(how, &order), source.unreadable(where));
  const bool kept = (order & H5P_CRT_ORDER_INDEXED) != 0;
  // Soft links repeat names in the file, and external links lead to other files: both are skipped.
  const auto collect = [](hid_t, const char* name, const H5L_info_t* link, void* list) -> herr_t {
    if (link->type == H5L_TYPE_HARD) static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  std::vector<std::string> names;
  hsize_t position = 0;
  check(H5Literate(group, kept ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME, H5_ITER_INC, &position, collect, &names),
        source.unreadable(where));
  if (!kept) std::stable_partition(names.begin(), names.end(), [](const auto& name) { return name == "time"; });
  return names;
}

// Reads everything below a group. In a damaged file a group may be a member of itself.
class Walk {
 public:
  Walk(const Source& source, Result& result) : source_(source), result_(result) {}

  void members_of(hid_t group, const std::string& name, Group& table, std::size_t depth) {
    if (depth > deepest) throw source_.wrong(name, "holds groups in groups without end", "");
    std::vector<std::pair<std::string, Handle>> below;
    for (const auto& member : members(source_, group, name)) {
      check_name(source_, member, name);
      const std::string full = name.empty() ? member : name + "/" + member;
      if (++objects_ > source_.bytes / least_bytes) throw source_.wrong(full, "more groups than the file can hold", "");
      Handle object(H5Oopen(group, member.c_str(), H5P_DEFAULT), H5Oclose, source_.unreadable(full));
      switch (H5Iget_type(object)) {
      case H5I_GROUP:
        below.emplace_back(full, std::move(object));
        break;
      case H5I_DATASET:
        table.columns.push_back(read_column(source_, object, member, full));
        break;
      default:
        throw source_.wrong(full, "neither a group nor a column", "");
      }
    }
    const bool holds_nothing_else = below.empty() || !table.columns.empty() || !table.attributes.empty();
    if (depth > 0 && holds_nothing_else) result_.groups.push_back(std::move(table));
    for (const auto& [full, object] : below) {
      Group next{full, read_attributes(source_, object, full), {}};
      members_of(object, full, next, depth + 1);
    }
  }

 private:
  static constexpr std::size_t deepest = 16;
  static constexpr std::uint64_t least_bytes = 32;  // of an object in a file

  const Source& source_;
  Result& result_;
  std::uint64_t objects_ = 0;
};

}  // namespace

Result read_result(const std::string& path, Reading reading) {
  check_seal(path);
  const Source source{path, std::filesystem::file_size(path), reading};
  hdf5::silence();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path + ": no property list");
  // Cluster file systems cannot lock.
  check(H5Pset_file_locking(access, false, true), path + ": no property list");
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  if (id < 0)
    throw Error({path}, "not an HDF5 file, or a damaged one", "", "give a result file that cradle wrote", Exit::io);
  const Handle file(id, H5Fclose, path + ": could not be opened");
  Result result;
  result.attributes = read_attributes(source, file, "");
  const auto format = attribute<std::uint64_t>(result.attributes, "format_version", path);
  if (format != format_version) throw of_version(path, format);
  const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose, source.unreadable(""));
  Group none;  // columns outside of groups: this program writes none
  Walk(source, result).members_of(root, "", none, 0);
  return result;
}

}  // namespace cradle::tools
