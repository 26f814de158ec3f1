#include "cradle/tools/result/reader.hpp"

#include <algorithm>
#include <filesystem>

#include "cradle/tools/result/hdf5_values.hpp"
#include "cradle/tools/result/seal.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

using hdf5::check;
using hdf5::Handle;
using hdf5::Source;

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
      hdf5::check_name(source_, member, name);
      const std::string full = name.empty() ? member : name + "/" + member;
      if (++objects_ > source_.bytes / least_bytes) throw source_.wrong(full, "more groups than the file can hold", "");
      Handle object(H5Oopen(group, member.c_str(), H5P_DEFAULT), H5Oclose, source_.unreadable(full));
      switch (H5Iget_type(object)) {
      case H5I_GROUP:
        below.emplace_back(full, std::move(object));
        break;
      case H5I_DATASET:
        table.columns.push_back(hdf5::column(source_, object, member, full));
        break;
      default:
        throw source_.wrong(full, "neither a group nor a column", "");
      }
    }
    const bool holds_nothing_else = below.empty() || !table.columns.empty() || !table.attributes.empty();
    if (depth > 0 && holds_nothing_else) result_.groups.push_back(std::move(table));
    for (const auto& [full, object] : below) {
      Group next{full, hdf5::attributes(source_, object, full), {}};
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

Result read_hdf5(const Source& source) {
  hdf5::silence();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, source.path + ": no property list");
  // Cluster file systems cannot lock.
  check(H5Pset_file_locking(access, false, true), source.path + ": no property list");
  const hid_t id = H5Fopen(source.path.c_str(), H5F_ACC_RDONLY, access);
  if (id < 0)
    throw Error({source.path}, "not an HDF5 file, or a damaged one", "", "give a result file that cradle wrote",
                Exit::io);
  const Handle file(id, H5Fclose, source.path + ": could not be opened");
  Result result;
  result.attributes = hdf5::attributes(source, file, "");
  const auto version = attribute<std::uint64_t>(result.attributes, "format_version", source.path);
  if (version != format_version) throw of_version(source.path, version);
  const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose, source.unreadable(""));
  Group none;  // columns outside of groups: this program writes none
  Walk(source, result).members_of(root, "", none, 0);
  return result;
}

}  // namespace

Result read_result(const std::string& path, Reading reading) {
  check_seal(path);
  return read_hdf5({path, std::filesystem::file_size(path), reading});
}

}  // namespace cradle::tools
