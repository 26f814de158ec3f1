#pragma once
// Cases in a text file: some lines each, with an empty line between them. `# ...` is a comment; `## NAME` begins a
// group of cases. `@name` stands for the lines of that name, which `@name =` begins and an empty line ends, or for the
// bundled scene of that name. A line that ends in a backslash continues in the next one.

#include <sstream>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tests {

using Lines = std::vector<std::string>;

struct ListedCase {
  std::string group;
  std::size_t number;  // of its first line
  Lines lines;

  // Of those that begin with their name.
  const std::string& name() const { return lines.front(); }
  std::string below_name() const { return fmt::format("{}", fmt::join(lines.begin() + 1, lines.end(), "\n")); }
  friend std::ostream& operator<<(std::ostream& out, const ListedCase& of) { return out << of.name(); }
};

// Of a file below tests/tools.
inline std::vector<ListedCase> cases_in(const std::string& name) {
  std::map<std::string, Lines> texts;
  for (const tools::EmbeddedFile& scene : tools::bundled_scenes())
    texts["@" + std::string(scene.name)] = {std::string(scene.text)};
  std::istringstream file(contents(test::source_folder + "/tests/tools/" + name));
  std::vector<ListedCase> all;
  std::string group;
  Lines* open = nullptr;  // of a case or of a text
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = ++number;
    for (std::string more; line.ends_with(" \\") && std::getline(file, more); ++number)
      line.replace(line.size() - 1, 1, more.substr(more.find_first_not_of(' ')));
    if (line.empty()) {
      open = nullptr;
    } else if (line.starts_with("## ")) {
      group = line.substr(3);
    } else if (line.starts_with('@') && line.ends_with(" =")) {
      open = &(texts[line.substr(0, line.size() - 2)] = {});
    } else if (!line.starts_with('#')) {
      if (open == nullptr) open = &all.emplace_back(ListedCase{group, first, {}}).lines;
      if (line.starts_with('@'))
        std::ranges::copy(texts.at(line), std::back_inserter(*open));
      else
        open->push_back(line);
    }
  }
  if (all.empty()) throw std::logic_error(name + " has no cases");
  return all;
}

}  // namespace cradle::tests
