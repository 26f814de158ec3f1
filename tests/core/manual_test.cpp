// The documents match the code: links between the pages are valid, core/README.md names every header of core/ (or its
// folder), and files named there or in a comment exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "cradle/tests/places.hpp"
#include "cradle/tests/texts.hpp"

namespace manual_test {

namespace fs = std::filesystem;
using cradle::test::matches;

fs::path root() { return cradle::test::source_folder; }

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Manual, LinksLeadSomewhere) {
  int links = 0;
  std::vector<fs::path> pages{root() / "README.md"};
  for (const char* folder : {"core", "tools", "tests", "bench", ".github"})
    for (const auto& entry : fs::recursive_directory_iterator(root() / folder))
      if (entry.path().extension() == ".md") pages.push_back(entry.path());
  for (const fs::path& file : pages) {
    for (const std::string& link : matches(text_of(file), R"(\]\(([^):#]+)\))")) {
      EXPECT_TRUE(fs::exists(file.parent_path() / link)) << file << ": there is no " << link;
      ++links;
    }
  }
  EXPECT_GT(links, 10);
}

TEST(Manual, OfTheCoreNamesEveryHeaderAndNoOther) {
  const std::string manual = text_of(root() / "core/README.md");
  for (const auto& entry : fs::recursive_directory_iterator(root() / "core")) {
    const fs::path file = entry.path().lexically_relative(root() / "core");
    if (file.extension() != ".hpp") continue;
    const std::string folder = file.parent_path().string() + '/';
    EXPECT_TRUE(manual.find(file.filename().string()) != std::string::npos ||
                (file.has_parent_path() && manual.find('`' + folder + '`') != std::string::npos))
        << "core/README.md does not name " << file << ": say there what it is for";
  }
  for (const std::string& named : matches(manual, R"(([A-Za-z_0-9/.]+\.[ch]pp)\b)")) {
    bool there = fs::exists(root() / named) || fs::exists(root() / "core" / named);
    for (const char* folder : {"core", "tests/core"})
      for (const auto& entry : fs::recursive_directory_iterator(root() / folder))
        there = there || entry.path().filename() == named;
    EXPECT_TRUE(there) << "core/README.md names " << named << ", which is not there: correct it";
  }
}

TEST(Manual, CommentsNameFilesThatAreThere) {
  std::vector<fs::path> sources;
  std::set<std::string> names;
  for (const char* folder : {"core", "precision", "tools", "tests", "bench"})
    for (const auto& entry : fs::recursive_directory_iterator(root() / folder)) {
      const fs::path& file = entry.path();
      if (file.extension() != ".hpp" && file.extension() != ".cpp") continue;
      sources.push_back(file);
      names.insert(file.filename().string());
    }
  EXPECT_GT(sources.size(), 200U);
  const std::regex name(R"([A-Za-z_0-9]+\.[ch]pp\b)");
  for (const fs::path& file : sources) {
    std::ifstream in(file);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      const auto comment = line.find("//");
      if (comment == line.npos) continue;
      const auto begin = line.cbegin() + static_cast<std::ptrdiff_t>(comment);
      for (std::sregex_iterator match(begin, line.cend(), name), end; match != end; ++match)
        EXPECT_TRUE(names.contains(match->str()))
            << file.lexically_relative(root()) << ":" << number << ": there is no " << match->str() << ": correct it";
    }
  }
}

}  // namespace manual_test
