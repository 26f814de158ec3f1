#include "cradle/tools/result/files.hpp"

#include <stdlib.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <map>

#include "cradle/tools/result/hdf5.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tools {

namespace {

using hdf5::check;
using hdf5::Handle;

constexpr const char* no_room = "the result could not be laid out in memory";

// Turns off time stamps, so that bytes do not depend on the date. Records the order of columns and groups.
Handle properties(hid_t property_class) {
  Handle list(H5Pcreate(property_class), H5Pclose, no_room);
  check(H5Pset_obj_track_times(list, false), no_room);
  if (property_class != H5P_DATASET_CREATE)
    check(H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), no_room);
  return list;
}

// What attributes and columns have in common, made once a file: a result may have tens of thousands of them.
struct Common {
  Handle scalar{H5Screate(H5S_SCALAR), H5Sclose, no_room};
  Handle text = hdf5::text_type("a result");
  Handle columns = properties(H5P_DATASET_CREATE);
};

void write_attribute(hid_t object, const Attribute& attribute, const Common& common) {
  const std::string& name = attribute.first;  // no structured binding: lambdas of clang 14 cannot capture one
  const auto& value = attribute.second;
  const auto put = [&](hid_t type, hid_t memory, const void* data) {
    const Handle id(H5Acreate2(object, name.c_str(), type, common.scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, no_room);
    check(H5Awrite(id, memory, data), no_room);
  };
  if (const auto* text = std::get_if<std::string>(&value)) {
    const char* characters = text->c_str();
    put(common.text, common.text, &characters);
  } else if (const auto* number = std::get_if<double>(&value)) {
    put(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, number);
  } else {
    put(H5T_STD_U64LE, H5T_NATIVE_UINT64, &std::get<std::uint64_t>(value));
  }
}

// Texts of a column have the length of the longest one: fixed lengths make the layout of the file reproducible.
using Texts = std::vector<std::string>;
std::size_t longest(const Texts& texts) {
  std::size_t bytes = 1;
  for (const std::string& text : texts) bytes = std::max(bytes, text.size());
  return bytes;
}
std::string padded(const Texts& texts, std::size_t bytes) {
  std::string all;
  for (const std::string& text : texts) (all += text).append(bytes - text.size(), '\0');
  return all;
}

// Makes a column with room for its rows.
Handle make_column(hid_t group, const Column& column, const Common& common) {
  const hsize_t shape[2] = {column.rows(), column.width};
  const Handle space(H5Screate_simple(column.width > 1 ? 2 : 1, shape, nullptr), H5Sclose, no_room);
  const auto make = [&](hid_t type) {
    return Handle(H5Dcreate2(group, column.name.c_str(), type, space, H5P_DEFAULT, common.columns, H5P_DEFAULT),
                  H5Dclose, no_room);
  };
  if (const auto* texts = std::get_if<Texts>(&column.values))
    return make(hdf5::text_type(column.name, std::max(longest(*texts), column.longest)));
  return make(std::holds_alternative<std::vector<double>>(column.values) ? H5T_IEEE_F64LE : H5T_STD_U64LE);
}

// Writes the column's rows, beginning at row `from` of the dataset.
void write_rows(hid_t data, const Column& column, std::uint64_t from) {
  if (column.rows() == 0) return;
  const hsize_t start[2] = {from, 0}, shape[2] = {column.rows(), column.width};
  const int rank = column.width > 1 ? 2 : 1;
  const Handle in_file(H5Dget_space(data), H5Sclose, no_room),
      in_memory(H5Screate_simple(rank, shape, nullptr), H5Sclose, no_room);
  check(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start, nullptr, shape, nullptr), no_room);
  const auto write = [&](hid_t type, const void* values) {
    check(H5Dwrite(data, type, in_memory, in_file, H5P_DEFAULT, values), no_room);
  };
  if (const auto* texts = std::get_if<Texts>(&column.values)) {
    const std::size_t bytes = longest(*texts);
    write(hdf5::text_type(column.name, bytes), padded(*texts, bytes).data());
  } else if (const auto* reals = std::get_if<std::vector<double>>(&column.values)) {
    write(H5T_NATIVE_DOUBLE, reals->data());
  } else {
    write(H5T_NATIVE_UINT64, std::get<std::vector<std::uint64_t>>(column.values).data());
  }
}

void describe(hid_t data, const Column& column, const Common& common) {
  write_attribute(data, {"unit", column.unit}, common);
  write_attribute(data, {"description", column.description}, common);
}

// With room for these columns at once: HDF5 would copy all that is there each time that it makes more.
Handle file_in_memory(const Result& result) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, no_room);
  std::size_t grows_by = std::size_t{1} << 18;
  for (const Group& group : result.groups)
    for (const Column& column : group.columns) grows_by += column.rows() * column.width * sizeof(double);
  check(H5Pset_fapl_core(access, std::max(grows_by, std::size_t{1} << 20), false), no_room);
  return {H5Fcreate("cradle", H5F_ACC_TRUNC, properties(H5P_FILE_CREATE), access), H5Fclose, no_room};
}

// Makes every group with its attributes and calls each(group, table).
template <class Each> void write_groups(hid_t file, const Result& result, const Common& common, const Each& each) {
  for (const auto& attribute : result.attributes) write_attribute(file, attribute, common);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, no_room);
  check(H5Pset_create_intermediate_group(links, 1), no_room);
  const Handle of_groups = properties(H5P_GROUP_CREATE);
  for (const auto& table : result.groups) {
    const Handle group(H5Gcreate2(file, table.name.c_str(), links, of_groups, H5P_DEFAULT), H5Gclose, no_room);
    for (const auto& attribute : table.attributes) write_attribute(group, attribute, common);
    each(group, table);
  }
}

}  // namespace

std::string file_image(const Result& result) {
  hdf5::silence();
  const Handle file = file_in_memory(result);
  const Common common;
  write_groups(file, result, common, [&](hid_t group, const Group& table) {
    for (const auto& column : table.columns) {
      const Handle data = make_column(group, column, common);
      write_rows(data, column, 0);
      describe(data, column, common);
    }
  });
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), no_room);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size <= 0) throw hdf5::failure(no_room);
  const auto length = static_cast<std::size_t>(size);
  std::string bytes;
  bytes.reserve(length + seal_size);
  bytes.resize(length);
  if (H5Fget_file_image(file, bytes.data(), length) != size) throw hdf5::failure(no_room);
  bytes += seal_of(bytes);
  return bytes;
}

void write_in_pieces(const Result& ends, const Pieces& pieces, const std::string& path) {
  hdf5::silence();
  NewFile whole(path);
  try {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, no_room);
    check(H5Pset_file_locking(access, false, true), no_room);
    const Handle file(H5Fcreate(whole.name().c_str(), H5F_ACC_TRUNC, properties(H5P_FILE_CREATE), access), H5Fclose,
                      no_room);
    struct Open {
      std::vector<Handle> columns;
      std::uint64_t rows = 0;
    };
    std::map<std::string, Open> open;
    // Columns get their places at once, since the order of their rows differs from run to run.
    const Common common;
    check(H5Pset_alloc_time(common.columns, H5D_ALLOC_TIME_EARLY), no_room);
    write_groups(file, ends, common, [&](hid_t group, const Group& table) {
      Open& here = open[table.name];
      for (const Column& column : table.columns) {
        here.columns.push_back(make_column(group, column, common));
        describe(here.columns.back(), column, common);
      }
    });
    pieces([&](const Group& piece) {
      Open& here = open.at(piece.name);
      if (piece.columns.empty()) return;
      for (std::size_t k = 0; k < piece.columns.size(); ++k)
        write_rows(here.columns.at(k), piece.columns[k], here.rows);
      here.rows += piece.columns.front().rows();
    });
    open.clear();
    check(H5Fflush(file, H5F_SCOPE_GLOBAL), no_room);
  } catch (const Error& error) {
    throw Error({path}, "could not be written", error.what(), "make room on its disk", Exit::io);
  }
  whole.append(seal_of_file(whole.name()));
  whole.put_in_place();
}

void write_result(const Result& result, const std::string& path) { replace_file(path, file_image(result)); }

void write_or_keep(const Result& result, const std::string& path) {
  const std::string image = file_image(result);
  std::string trouble;
  try {
    return replace_file(path, image);
  } catch (const Error& error) {
    trouble = error.what();
  }
  try {
    std::string folder = (std::filesystem::temp_directory_path() / "cradle-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) throw Error({folder}, "could not be made", "", "make room", Exit::io);
    const auto elsewhere = (folder / std::filesystem::path(path).filename()).string();
    replace_file(elsewhere, image);
    trouble += "; what was computed is in " + elsewhere + ", move it from there";
  } catch (const std::exception& error) {
    trouble += std::string("; it could not be kept elsewhere either: ") + error.what();
  }
  throw Error(trouble, Exit::io);
}

}  // namespace cradle::tools
