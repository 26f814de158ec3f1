#include "cradle/tools/result/result.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

// An HDF5 identifier that is closed with its owner.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close closer, const std::string& what) : id_(id), close_(closer) {
    if (id_ < 0) throw Error({}, what, "", "check the file and the space on its disk", Exit::io);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  // Closes now, so that an error on the last write is seen.
  void close(const std::string& what) {
    const hid_t id = id_;
    id_ = -1;
    if (close_(id) < 0) throw Error({}, what, "", "check the space on the disk", Exit::io);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

void check(herr_t status, const std::string& what) {
  if (status < 0) throw Error({}, what, "", "check the file and the space on its disk", Exit::io);
}

// Bytes must not depend on when they are written.
Handle untimed(hid_t property_class, const std::string& path) {
  Handle list(H5Pcreate(property_class), H5Pclose, path + ": no property list");
  check(H5Pset_obj_track_times(list, false), path + ": no property list");
  return list;
}

// Cluster file systems cannot lock.
Handle file_access(const std::string& path) {
  Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path + ": no property list");
  check(H5Pset_file_locking(list, false, true), path + ": no property list");
  return list;
}

Handle text_type(const std::string& path) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, path + ": no text type");
  check(H5Tset_size(type, H5T_VARIABLE), path + ": no text type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), path + ": no text type");
  return type;
}

void write_attribute(hid_t object, const Attribute& attribute, const std::string& path) {
  const auto& [name, value] = attribute;
  const std::string what = path + ": attribute " + name + " could not be written";
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose, what);
  const auto put = [&](hid_t type, hid_t memory, const void* data) {
    const Handle id(H5Acreate2(object, name.c_str(), type, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
    check(H5Awrite(id, memory, data), what);
  };
  if (const auto* text = std::get_if<std::string>(&value)) {
    const Handle type = text_type(path);
    const char* characters = text->c_str();
    put(type, type, &characters);
  } else if (const auto* number = std::get_if<double>(&value)) {
    put(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, number);
  } else {
    put(H5T_STD_U64LE, H5T_NATIVE_UINT64, &std::get<std::uint64_t>(value));
  }
}

void write_column(hid_t group, const Column& column, const std::string& path) {
  const std::string what = path + ": " + column.name + " could not be written";
  const hsize_t shape[2] = {column.rows(), column.width};
  const Handle space(H5Screate_simple(column.width > 1 ? 2 : 1, shape, nullptr), H5Sclose, what);
  const Handle properties = untimed(H5P_DATASET_CREATE, path);
  const bool real = std::holds_alternative<std::vector<double>>(column.values);
  const Handle data(H5Dcreate2(group, column.name.c_str(), real ? H5T_IEEE_F64LE : H5T_STD_U64LE, space, H5P_DEFAULT,
                               properties, H5P_DEFAULT),
                    H5Dclose, what);
  if (shape[0] > 0)
    std::visit(
        [&](const auto& values) {
          check(H5Dwrite(data, real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                         values.data()),
                what);
        },
        column.values);
  write_attribute(data, {"unit", column.unit}, path);
  write_attribute(data, {"description", column.description}, path);
}

std::string system_error() { return std::strerror(errno); }

void sync(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

std::string temporary_name(const std::string& path) { return path + ".new"; }

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// ---- reading

Attribute read_attribute(hid_t object, const std::string& name, const std::string& path) {
  const std::string what = path + ": attribute " + name + " could not be read";
  const Handle id(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const Handle type(H5Aget_type(id), H5Tclose, what);
  switch (H5Tget_class(type)) {
  case H5T_STRING: {
    const Handle memory = text_type(path);
    char* text = nullptr;
    check(H5Aread(id, memory, &text), what);
    const std::unique_ptr<char, decltype(&H5free_memory)> owner(text, H5free_memory);
    return {name, std::string(text ? text : "")};
  }
  case H5T_INTEGER: {
    std::uint64_t value = 0;
    check(H5Aread(id, H5T_NATIVE_UINT64, &value), what);
    return {name, value};
  }
  default: {
    double value = 0;
    check(H5Aread(id, H5T_NATIVE_DOUBLE, &value), what);
    return {name, value};
  }
  }
}

std::vector<Attribute> read_attributes(hid_t object, const std::string& path) {
  std::vector<std::string> names;
  hsize_t position = 0;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &position, collect, &names),
        path + ": attributes could not be read");
  std::vector<Attribute> attributes;
  for (const auto& name : names) attributes.push_back(read_attribute(object, name, path));
  return attributes;
}

Column read_column(hid_t group, const std::string& name, const std::string& path) {
  const std::string what = path + ": " + name + " could not be read";
  const Handle data(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Handle type(H5Dget_type(data), H5Tclose, what);
  const Handle space(H5Dget_space(data), H5Sclose, what);
  const auto size = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  Column column{name, "", "", {}};
  hsize_t shape[2] = {0, 1};
  if (H5Sget_simple_extent_ndims(space) == 2 && H5Sget_simple_extent_dims(space, shape, nullptr) == 2 && shape[1] > 0)
    column.width = static_cast<std::size_t>(shape[1]);
  for (const auto& [key, value] : read_attributes(data, path)) {
    if (key == "unit") column.unit = std::get<std::string>(value);
    if (key == "description") column.description = std::get<std::string>(value);
  }
  const auto get = [&](auto values, hid_t memory) {
    if (size > 0) check(H5Dread(data, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), what);
    column.values = std::move(values);
  };
  if (H5Tget_class(type) == H5T_INTEGER)
    get(std::vector<std::uint64_t>(size), H5T_NATIVE_UINT64);
  else
    get(std::vector<double>(size), H5T_NATIVE_DOUBLE);
  return column;
}

std::vector<std::string> member_names(hid_t group, const std::string& path) {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  hsize_t position = 0;
  check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, &position, collect, &names), path + ": groups could not be read");
  return names;
}

void read_group(hid_t parent, const std::string& name, const std::string& full_name, const std::string& path,
                Result& result) {
  const Handle group(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose,
                     path + ": " + full_name + " could not be read");
  Group table{full_name, read_attributes(group, path), {}};
  std::vector<std::string> below;
  for (const auto& member : member_names(group, path)) {
    H5O_info_t info;
    check(H5Oget_info_by_name(group, member.c_str(), &info, H5P_DEFAULT), path + ": " + member + " could not be read");
    if (info.type == H5O_TYPE_GROUP)
      below.push_back(member);
    else
      table.columns.push_back(read_column(group, member, path));
  }
  if (below.empty() || !table.columns.empty() || !table.attributes.empty()) result.groups.push_back(std::move(table));
  for (const auto& member : below) read_group(group, member, full_name + "/" + member, path, result);
}

// HDF5 prints a stack of its own messages; ours name the file and what to do.
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

}  // namespace

const Group* Result::find(const std::string& name) const {
  for (const auto& group : groups)
    if (group.name == name) return &group;
  return nullptr;
}

template <class T>
const T& attribute(const std::vector<Attribute>& attributes, const std::string& name, const std::string& where) {
  for (const auto& [key, value] : attributes)
    if (key == name)
      if (const T* found = std::get_if<T>(&value)) return *found;
  throw Error({where, 0, ""}, "not a result of this program", "no attribute " + name, "give a file that cradle wrote",
              Exit::io);
}
template const std::string& attribute(const std::vector<Attribute>&, const std::string&, const std::string&);
template const double& attribute(const std::vector<Attribute>&, const std::string&, const std::string&);
template const std::uint64_t& attribute(const std::vector<Attribute>&, const std::string&, const std::string&);

void write_result(const Result& result, const std::string& path) {
  silence();
  const std::string temporary = temporary_name(path);
  try {
    const Handle access = file_access(path);
    Handle file(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
                path + ": could not be created");
    for (const auto& attribute : result.attributes) write_attribute(file, attribute, path);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path + ": no property list");
    check(H5Pset_create_intermediate_group(links, 1), path + ": no property list");
    const Handle properties = untimed(H5P_GROUP_CREATE, path);
    for (const auto& table : result.groups) {
      const Handle group(H5Gcreate2(file, table.name.c_str(), links, properties, H5P_DEFAULT), H5Gclose,
                         path + ": " + table.name + " could not be written");
      for (const auto& attribute : table.attributes) write_attribute(group, attribute, path);
      for (const auto& column : table.columns) write_column(group, column, path);
    }
    file.close(path + ": could not be written");
    sync(temporary);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0)
    throw Error({path, 0, ""}, "the result could not be put in place", system_error(), "find it as " + temporary,
                Exit::io);
  sync(folder_of(path));
}

Result read_result(const std::string& path) {
  silence();
  if (!std::filesystem::exists(path))
    throw Error({path, 0, ""}, "no such file", "", "give a result file that cradle wrote", Exit::io);
  const Handle access = file_access(path);
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  if (id < 0)
    throw Error({path, 0, ""}, "not an HDF5 file, or a damaged one", "", "give a result file that cradle wrote",
                Exit::io);
  const Handle file(id, H5Fclose, path + ": could not be opened");
  Result result;
  result.attributes = read_attributes(file, path);
  attribute<std::uint64_t>(result.attributes, "format_version", path);
  for (const auto& name : member_names(file, path)) read_group(file, name, name, path, result);
  return result;
}

void check_writable(const std::string& path) {
  if (std::filesystem::is_directory(path))
    throw Error({path, 0, ""}, "the result cannot be written", "a folder of that name", "give another -o FILE",
                Exit::io);
  const std::string temporary = temporary_name(path);
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0)
    throw Error({path, 0, ""}, "the result cannot be written", system_error(),
                "give another -o FILE or make its folder writable", Exit::io);
  ::close(file);
  ::unlink(temporary.c_str());
}

}  // namespace cradle::tools
