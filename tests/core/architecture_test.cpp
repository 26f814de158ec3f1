// The sources, and the documents that belong to them.
//
// Layers: core/ includes only the standard library and itself: no input or output, no threads (except the ensemble, one
// file of which uses oneTBB), no vectors (except one file, which uses Highway), no Boost. It uses the scalar only
// through the concept Real, so no std:: mathematics on it, except by `using` as a fallback for built-in types. Every
// header is guarded and begins with a comment. Lines and files are short.
//
// Documents: links between the pages lead to files and headlines that are there, every folder of core/, and precision/,
// has a page that names its headers, and files named in these pages or in a comment exist.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <vector>

#include "cradle/tests/places.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::architecture_test {

namespace fs = std::filesystem;

fs::path root() { return source_folder; }
using Folders = std::vector<std::string>;
const Folders all_folders{"core", "precision", "tools", "tests", "bench"};

std::vector<fs::path> files_in(const Folders& folders, const std::set<fs::path>& extensions) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(root() / folder))
      if (extensions.contains(entry.path().extension())) files.push_back(entry.path());
  return files;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}
std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_comment(const std::string& text) {
  const auto start = text.find_first_not_of(" \t");
  return start != text.npos && text.compare(start, 2, "//") == 0;
}

struct Line {
  std::string file, text, place;
};
std::vector<Line> code(const std::string& folder) {
  std::vector<Line> lines;
  for (const fs::path& path : files_in({folder}, {".hpp", ".cpp", ".inl", ".in"})) {
    const std::string file = path.lexically_relative(root()).string();
    for (int number = 1; const std::string& text : lines_of(path)) {
      if (!is_comment(text)) lines.push_back({file, text, file + ':' + std::to_string(number) + ": " + text});
      ++number;
    }
  }
  return lines;
}

// ---- layers

TEST(Architecture, CoreIncludesTheStandardLibraryAndItselfOnly) {
  const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  const std::regex own(R"(cradle/core/.*)"), standard(R"([a-z_]+)"), threads(R"(tbb/.*|oneapi/.*)");
  const std::set<std::string> forbidden{"iostream", "fstream", "sstream",      "cstdio",
                                        "ostream",  "istream", "thread",       "mutex",
                                        "atomic",   "future",  "shared_mutex", "condition_variable",
                                        "execution"};
  int found = 0;
  for (const Line& line : code("core")) {
    std::smatch match;
    if (!std::regex_search(line.text, match, include)) continue;
    ++found;
    const std::string name = match[1];
    const bool ensemble = line.file.starts_with("core/ensemble/");
    const bool tbb = line.file == "core/ensemble/tbb_executor.hpp";
    const bool highway = line.file == "core/parallel/steps/steps.cpp" && name.starts_with("hwy/");
    const bool memory = line.file == "core/base/large_pages.hpp" && name == "sys/mman.h";
    EXPECT_TRUE(std::regex_match(name, own) || std::regex_match(name, standard) ||
                (tbb && std::regex_match(name, threads)) || highway || memory)
        << line.place;
    EXPECT_TRUE(ensemble || !forbidden.contains(name)) << line.place;
  }
  EXPECT_GT(found, 50) << "sources are looked for in " << source_folder;
}

// The part of the tower that a path is in; empty: none.
std::string part_of(const std::string& path, const std::map<std::string, Folders>& tower) {
  for (std::string folder = path; folder.find('/') != folder.npos;) {
    folder.erase(folder.rfind('/'));
    if (tower.contains(folder)) return folder;
  }
  return "";
}

// tower.txt is the list that the build uses (tools/cmake/part.cmake).
TEST(Architecture, FoldersUseOnlyThoseAboveThemInTheTower) {
  std::map<std::string, Folders> tower;
  for (const std::string& line : lines_of(fs::path(build_folder) / "tower.txt")) {
    std::istringstream words(line);
    std::string folder;
    words >> folder;
    folder.pop_back();
    Folders uses;
    for (std::string used; words >> used; uses.push_back(used))
      EXPECT_TRUE(tower.contains(used)) << folder << " uses " << used << ", which is not above it";
    tower.emplace(folder, uses);
  }
  ASSERT_GT(tower.size(), 12U);
  const std::regex include(R"x(^\s*#\s*include\s*"([^"]+)")x");
  for (const std::string top : {"core", "precision", "tools"}) {
    for (const Line& line : code(top)) {
      std::smatch match;
      if (line.file == "tools/cradle.cpp" || !std::regex_search(line.text, match, include)) continue;
      const std::string name = match[1], folder = part_of(line.file, tower);
      EXPECT_TRUE(name.starts_with("cradle/")) << line.place;
      ASSERT_NE(folder, "") << line.place;
      const std::string used = part_of(name.substr(name.find('/') + 1), tower);
      const Folders& uses = tower.at(folder);
      EXPECT_TRUE(used == folder || std::ranges::find(uses, used) != uses.end()) << line.place;
    }
  }
}

// Theory says `using std::log;` and then calls log unqualified, as the wet law does with sqrt; the rest needs none.
// What works on double by declaration (mantissas and exponents, bins, displacements, random speeds, bounds and sizes of
// proofs, turns) is named here.
TEST(Architecture, CoreUsesNoStandardMathematicsOnTheScalar) {
  const std::regex maths(
      R"(std::(abs|fabs|sqrt|cbrt|pow|exp|exp2|log|log2|log10|log1p|expm1|sin|cos|tan|atan|atan2|hypot|fma|floor|)"
      R"(ceil|round|isnan|isfinite|ldexp|frexp)\b)");
  const std::regex on_double(
      R"(core/(base/(counter_rng|elementary|real)|certify/(certain_(law|state|walls?)|inspection)|)"
      R"(chains/configuration|ensemble/statistics|initial/(rows|velocities)|laws/(approach|turns|wall)|)"
      R"(observe/(averages|batch_means|clusters|correlations|profile|scenario|structure|zone)|)"
      R"(parallel/(observed|segments)|theory/free_cooling)\.hpp)");
  const std::regex known(R"(^\s*using std::|std::isfinite\(rounded\))");
  for (const Line& line : code("core"))
    EXPECT_TRUE(std::regex_match(line.file, on_double) || !std::regex_search(line.text, maths) ||
                std::regex_search(line.text, known))
        << line.place;
}

TEST(Architecture, EveryHeaderIsGuardedAndOpensWithItsIdea) {
  for (const fs::path& file : files_in({"core", "precision"}, {".hpp"})) {
    const auto lines = lines_of(file);
    EXPECT_EQ(std::ranges::count(lines, "#pragma once"), 1) << file;
    EXPECT_TRUE(is_comment(lines.at(0)) || is_comment(lines.at(1))) << file;
  }
}

// At most 120 characters in a line and, outside tests, 300 lines in a file, but for the table of keys.
TEST(Architecture, LinesAndFilesAreShort) {
  const auto begins_character = [](unsigned char byte) { return (byte & 0xC0) != 0x80; };
  for (const std::string& folder : all_folders)
    for (const fs::path& file : files_in({folder}, {".hpp", ".cpp", ".inl", ".py", ".js", ".sh"})) {
      const auto lines = lines_of(file);
      for (const std::string& line : lines)
        EXPECT_LE(std::ranges::count_if(line, begins_character), 120) << file << ": " << line;
      EXPECT_TRUE(folder == "tests" || file.filename() == "fields.cpp" || lines.size() <= 300)
          << file << ": " << lines.size();
    }
}

// ---- documents

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
  bool in_code = false;
  for (const std::string& line : lines_of(page)) {
    if (line.starts_with("```")) in_code = !in_code;
    const auto text = line.find_first_not_of('#');
    if (!in_code && text != line.npos && text > 0 && line[text] == ' ')
      anchors.insert(anchor_of(line.substr(text + 1)));
  }
  return anchors;
}

TEST(Manual, LinksLeadSomewhere) {
  int links = 0, to_headlines = 0;
  Folders folders = all_folders;
  folders.push_back(".github");
  std::vector<fs::path> pages = files_in(folders, {".md"});
  pages.push_back(root() / "README.md");
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

std::set<std::string> names_of(const std::vector<fs::path>& files) {
  std::set<std::string> names;
  for (const fs::path& file : files) names.insert(file.filename().string());
  return names;
}

TEST(Manual, OfEachFolderNamesEveryHeaderAndNoOther) {
  std::set<fs::path> pages{root() / "core/README.md", root() / "precision/README.md"};
  for (const auto& entry : fs::directory_iterator(root() / "core"))
    if (entry.is_directory()) {
      pages.insert(entry.path() / "README.md");
      EXPECT_TRUE(fs::exists(entry.path() / "README.md")) << entry.path() << " has no page: say there what it is for";
    }
  EXPECT_GT(pages.size(), 12U);
  for (const fs::path& file : files_in({"core", "precision"}, {".hpp"}))
    EXPECT_TRUE(has(text_of(page_of(file.parent_path())), file.filename().string())) << file << ": say what it is for";
  const auto names = names_of(files_in({"core", "precision", "tests/core", "tests/precision"}, {".hpp", ".cpp"}));
  for (const fs::path& page : pages)
    for (const std::string& named : matches(text_of(page), R"(([A-Za-z_0-9/.]+\.[ch]pp)\b)"))
      EXPECT_TRUE(fs::exists(root() / named) || fs::exists(root() / "core" / named) ||
                  fs::exists(page.parent_path() / named) || names.contains(named))
          << page << " names " << named << ", which is not there: correct it";
}

TEST(Manual, CommentsNameFilesThatAreThere) {
  const auto sources = files_in(all_folders, {".hpp", ".cpp"});
  const auto names = names_of(sources);
  EXPECT_GT(sources.size(), 200U);
  for (const fs::path& file : sources) {
    std::string comments;
    for (const std::string& line : lines_of(file)) comments += line.substr(std::min(line.find("//"), line.size()));
    for (const std::string& name : matches(comments, R"(([A-Za-z_0-9]+\.[ch]pp)\b)"))
      EXPECT_TRUE(names.contains(name)) << file << ": there is no " << name << ": correct it";
  }
}

}  // namespace cradle::test::architecture_test
