// CSV of bodies, line by line; every number is checked where it stands, so that messages can name the line.
#include "cradle/tools/scene/list_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

namespace cradle::tools {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) return;
    line.remove_prefix(comma + 1);
  }
}

bool is_not_finite(std::string_view cell) {
  std::string word(cell);
  std::erase_if(word, [](char c) { return c == '+' || c == '-'; });
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word == "inf" || word == "infinity" || word == "nan";
}

std::string decimal_of(std::string_view cell, Place place, const char* column) {
  auto number = canonical_decimal(cell);
  if (number) return std::move(*number);
  place.key = column;
  throw Error(place, is_not_finite(cell) ? "not finite" : "not a decimal number", fmt::format("\"{}\"", cell),
              "give a decimal number");
}

void add_body(const std::vector<std::string_view>& cells, const Place& place, Bodies& bodies) {
  const auto x = decimal_of(cells[0], place, "x");
  if (!bodies.x.empty()) {
    const auto order = compare_decimals(x, bodies.x.back());
    if (std::is_lteq(order))
      throw Error({place.source, place.line, "x"}, std::is_eq(order) ? "coincident bodies" : "not increasing",
                  fmt::format("{} after {}", x, bodies.x.back()), "give the bodies in order of increasing x");
  }
  bodies.x.push_back(x);
  bodies.v.push_back(decimal_of(cells[1], place, "v"));
  if (cells.size() == 2) return;
  const auto m = decimal_of(cells[2], place, "m");
  if (std::is_lteq(compare_decimals(m, "0")))
    throw Error({place.source, place.line, "m"}, "out of range", m, "give a mass above 0");
  bodies.m.push_back(m);
}

}  // namespace

Bodies parse_list(std::istream& csv, const std::string& file_name) {
  Bodies bodies;
  Place place{file_name, 0, {}};
  std::size_t columns = 0;  // 0: still to be named
  std::string line;
  std::vector<std::string_view> cells;
  while (std::getline(csv, line)) {
    ++place.line;
    std::string_view text = line;
    if (place.line == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
    text = trimmed(text);
    if (text.empty() || text.front() == '#') continue;
    split(text, cells);
    if (columns == 0) {
      columns = cells.size();
      const std::vector<std::string_view> names = {"x", "v", "m"};
      if ((columns != 2 && columns != 3) || !std::equal(cells.begin(), cells.end(), names.begin()))
        throw Error(place, "the columns are not named", fmt::format("\"{}\"", text),
                    "begin the file with a line x,v or x,v,m");
      continue;
    }
    if (cells.size() != columns)
      throw Error(place, "wrong number of columns", std::to_string(cells.size()),
                  fmt::format("give {} as in the first line", columns));
    add_body(cells, place, bodies);
  }
  if (csv.bad()) throw Error({file_name, 0, {}}, "cannot be read", "a read error", "check the disk", Exit::io);
  if (bodies.x.empty())
    throw Error({file_name, 0, {}}, "no bodies", columns == 0 ? "an empty file" : "only the names of the columns",
                "give a line x,v or x,v,m and then one line per body");
  return bodies;
}

Bodies read_bodies(const Scene& scene) {
  const Initial& initial = scene.initial;
  if (!initial.file) {
    Bodies bodies;
    for (const Decimal& x : initial.x) bodies.x.push_back(x.text);
    for (const Decimal& v : initial.v) bodies.v.push_back(v.text);
    for (const Decimal& m : initial.m) bodies.m.push_back(m.text);
    return bodies;
  }
  const auto path = (std::filesystem::path(scene.folder) / *initial.file).string();
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw Error({path, 0, {}}, "the list of bodies cannot be read", "no such file, or no permission",
                "correct initial.file, which is relative to the scene file", Exit::io);
  return parse_list(file, path);
}

}  // namespace cradle::tools
