#include "cradle/tools/result/files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

// NaN has one form.
std::string text_of(double x) { return std::isnan(x) ? "nan" : fmt::format("{}", x); }
template <class Value> std::string text_of(const Value& x) { return fmt::format("{}", x); }

// A comment for each attribute, also for text of several lines; the scene has a file.
std::string comments(const std::vector<Attribute>& attributes) {
  std::string text;
  for (const auto& [name, value] : attributes) {
    if (name == "scene") continue;
    std::string one = std::visit([](const auto& v) { return text_of(v); }, value);
    for (std::size_t at = one.find('\n'); at != one.npos; at = one.find('\n', at + 1)) one.insert(at + 1, "#   ");
    text += fmt::format("# {} = {}\n", name, one);
  }
  return text;
}

// A heading or a value, in quotation marks where it needs them (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

// The folder holds a list of what was written there, which begins with the name of the result: so that another export
// of it leaves nothing of this one behind.
constexpr const char* list_of_files = "files.txt";

bool can_be_ours(const std::filesystem::path& name) {
  const bool inside = name.is_relative() && std::find(name.begin(), name.end(), "..") == name.end();
  return inside && (name.extension() == ".csv" || name.filename() == "scene.toml");
}

class Folder {
 public:
  explicit Folder(const std::string& path) : path_(path) {}

  // Removes what was exported here before from the result of this name. Throws Error (Exit::bad_input) if there is
  // something else among `names`, which are about to be written.
  void clear(const std::string& of, const std::vector<std::string>& names, bool forced) {
    heading_ = "exported from " + of;
    const std::string listed = (path_ / list_of_files).string();
    if (!instead_of_file(listed).empty()) refuse(list_of_files);
    std::ifstream list(listed);
    std::string line;
    const bool exported = static_cast<bool>(std::getline(list, line));
    if (!forced && exported && line != heading_)
      refuse(line.starts_with("exported from ") ? excerpt(line) : list_of_files);
    std::error_code none;
    if (!forced && !exported)
      for (const std::string& name : names)
        if (std::filesystem::exists(path_ / name, none)) refuse(name);
    while (std::getline(list, line))
      if (can_be_ours(line)) std::filesystem::remove(path_ / line, none);
  }

  void write(const std::string& name, const std::string& text) {
    const std::filesystem::path file = path_ / name;
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    // The same command makes the file again, so there is no need to wait for the disk.
    replace_file(file.string(), text, Sync::no);
    names_.push_back(name);
    written_.push_back(file.string());
  }
  std::vector<std::string> written() && {
    replace_file((path_ / list_of_files).string(), fmt::format("{}\n{}\n", heading_, fmt::join(names_, "\n")),
                 Sync::no);
    return std::move(written_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found) const {
    throw Error({path_.string()}, "a folder with other files", found,
                "give another --to DIR, or --force to replace them");
  }

  std::filesystem::path path_;
  std::string heading_;
  std::vector<std::string> names_, written_;
};

}  // namespace

std::string csv(const Group& group) {
  std::string text = comments(group.attributes);
  std::size_t rows = 0;
  std::string separator;
  const auto append = [&](const std::string& content) {
    text += separator + cell(content);
    separator = ",";
  };
  for (const auto& column : group.columns) {
    for (std::size_t i = 0; i < column.width; ++i)
      append(column.width > 1 ? fmt::format("{}[{}]", column.name, i) : column.name);
    rows = std::max(rows, column.rows());
  }
  if (!group.columns.empty()) text += '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    separator.clear();
    for (const auto& column : group.columns)
      for (std::size_t i = 0; i < column.width; ++i)
        append(row < column.rows()
                   ? std::visit([&](const auto& v) { return text_of(v[row * column.width + i]); }, column.values)
                   : std::string());
    text += '\n';
  }
  return text;
}

std::vector<std::string> export_csv(const Result& result, const std::string& folder, const std::string& of,
                                    bool forced) {
  Folder files(folder);
  std::vector<std::string> names{"scene.toml"};
  for (const Group& group : result.groups) names.push_back(group.name + ".csv");
  files.clear(of, names, forced);
  if (const auto* scene = find_attribute<std::string>(result.attributes, "scene"))
    files.write("scene.toml", comments(result.attributes) + *scene);
  for (const Group& group : result.groups) {
    files.write(group.name + ".csv", csv(group));
    const auto above = std::filesystem::path(group.name).parent_path();  // "points/0003"
    if (const auto* scene = find_attribute<std::string>(group.attributes, "scene"); scene != nullptr && !above.empty())
      files.write((above / "scene.toml").string(), *scene);
  }
  return std::move(files).written();
}

}  // namespace cradle::tools
