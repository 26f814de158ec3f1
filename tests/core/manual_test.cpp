// The documents match the code: links between the pages lead to files and headlines that are there, every folder of
// core/, and precision/, has a page that names its headers, and files named in these pages or in a comment exist.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "cradle/tests/places.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::manual_test {

namespace fs = std::filesystem;

fs::path root() { return cradle::test::source_folder; }

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// As GitHub makes it: lower case, without what is neither letter, digit, hyphen nor blank, blanks as hyphens.
std::string anchor_of(std::string headline) {
  headline = std::regex_replace(headline, std::regex(R"(\[([^\]]*)\]\([^)]*\))"), "$1");
  std::string anchor;
  for (const char letter : headline)
    if (letter == ' ')
      anchor += '-';
    else if (std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-' || letter == '_')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return anchor;
}

std::set<std::string> anchors_of(const fs::path& page) {
  std::set<std::string> anchors;
  std::ifstream in(page);
  bool in_code = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```")) in_code = !in_code;
    const auto text = line.find_first_not_of('#');
    if (!in_code && text != line.npos && text > 0 && line[text] == ' ')
      anchors.insert(anchor_of(line.substr(text + 1)));
  }
  return anchors;
}

TEST(Manual, LinksLeadSomewhere) {
  int links = 0, to_headlines = 0;
  std::vector<fs::path> pages{root() / "README.md"};
  for (const char* folder : {"core", "precision", "tools", "tests", "bench", ".github"})
    for (const auto& entry : fs::recursive_directory_iterator(root() / folder))
      if (entry.path().extension() == ".md") pages.push_back(entry.path());
  for (const fs::path& page : pages) {
    for (const std::string& link : matches(text_of(page), R"(\]\(([^):\s]+)\))")) {
      const auto hash = link.find('#');
      const fs::path file = hash == 0 ? page : page.parent_path() / link.substr(0, hash);
      EXPECT_TRUE(fs::exists(file)) << page << ": there is no " << link;
      ++links;
      if (hash == link.npos || !fs::exists(file)) continue;
      EXPECT_TRUE(anchors_of(file).contains(link.substr(hash + 1))) << page << ": no headline fits " << link;
      ++to_headlines;
    }
  }
  EXPECT_GT(links, 300);
  EXPECT_GT(to_headlines, 40);
}

// The page of the folder that a header is in: steps/ has none of its own.
fs::path page_of(fs::path folder) {
  while (!fs::exists(folder / "README.md")) folder = folder.parent_path();
  return folder / "README.md";
}

TEST(Manual, OfEachFolderNamesEveryHeaderAndNoOther) {
  std::set<fs::path> pages{root() / "core/README.md", root() / "precision/README.md"};
  for (const auto& entry : fs::directory_iterator(root() / "core"))
    if (entry.is_directory()) {
      pages.insert(entry.path() / "README.md");
      EXPECT_TRUE(fs::exists(entry.path() / "README.md")) << entry.path() << " has no page: say there what it is for";
    }
  EXPECT_GT(pages.size(), 12U);
  std::set<std::string> names;
  for (const char* folder : {"core", "precision", "tests/core", "tests/precision"})
    for (const auto& entry : fs::recursive_directory_iterator(root() / folder)) {
      const fs::path& file = entry.path();
      names.insert(file.filename().string());
      if (file.extension() != ".hpp" || file.string().starts_with((root() / "tests").string())) continue;
      const fs::path page = page_of(file.parent_path());
      EXPECT_TRUE(text_of(page).find(file.filename().string()) != std::string::npos)
          << page << " does not name " << file << ": say there what it is for";
    }
  for (const fs::path& page : pages)
    for (const std::string& named : matches(text_of(page), R"(([A-Za-z_0-9/.]+\.[ch]pp)\b)"))
      EXPECT_TRUE(fs::exists(root() / named) || fs::exists(root() / "core" / named) ||
                  fs::exists(page.parent_path() / named) || names.contains(named))
          << page << " names " << named << ", which is not there: correct it";
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

}  // namespace cradle::test::manual_test
