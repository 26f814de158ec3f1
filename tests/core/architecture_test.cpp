// The layers, checked in the sources. core/ includes only the standard library and itself: no input or output, no
// threads (except the ensemble, one file of which uses oneTBB), no vectors (except one file, which uses Highway), no
// Boost. It uses the scalar only through the concept Real, so no std:: mathematics on it, except by `using` as a
// fallback for built-in types. Every header is guarded and begins with a comment. Lines and files are short.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cradle/tests/places.hpp"

namespace cradle::test::architecture_test {

namespace fs = std::filesystem;

struct Line {
  std::string file;
  int number;
  std::string text;
};

bool is_comment(const std::string& text) {
  const auto start = text.find_first_not_of(" \t");
  return start != std::string::npos && text.compare(start, 2, "//") == 0;
}

std::vector<fs::path> headers(const std::string& folder) {
  std::vector<fs::path> files;
  const std::set<fs::path> extensions{".hpp", ".cpp", ".inl", ".in"};
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(source_folder) / folder))
    if (extensions.contains(entry.path().extension())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Line> code(const std::string& folder) {
  std::vector<Line> lines;
  for (const fs::path& file : headers(folder)) {
    std::ifstream in(file);
    std::string text;
    for (int number = 1; std::getline(in, text); ++number)
      if (!is_comment(text)) lines.push_back({file.lexically_relative(source_folder).string(), number, text});
  }
  return lines;
}

std::string place(const Line& line) { return line.file + ':' + std::to_string(line.number) + ": " + line.text; }

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
        << place(line);
    EXPECT_TRUE(ensemble || !forbidden.contains(name)) << place(line);
  }
  EXPECT_GT(found, 50) << "sources are looked for in " << source_folder;
}

// The part of the tower that a path is in; empty: none.
std::string part_of(const std::string& path, const std::map<std::string, std::vector<std::string>>& tower) {
  for (std::string folder = path; folder.find('/') != folder.npos;) {
    folder.erase(folder.rfind('/'));
    if (tower.contains(folder)) return folder;
  }
  return "";
}

// tower.txt is the list that the build uses (tools/cmake/part.cmake).
TEST(Architecture, FoldersUseOnlyThoseAboveThemInTheTower) {
  std::map<std::string, std::vector<std::string>> tower;
  std::ifstream list(fs::path(build_folder) / "tower.txt");
  for (std::string line; std::getline(list, line);) {
    std::istringstream words(line);
    std::string folder;
    words >> folder;
    folder.pop_back();
    std::vector<std::string> uses;
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
      EXPECT_TRUE(name.starts_with("cradle/")) << place(line);
      ASSERT_NE(folder, "") << place(line);
      const std::string used = part_of(name.substr(name.find('/') + 1), tower);
      const auto& uses = tower.at(folder);
      EXPECT_TRUE(used == folder || std::ranges::find(uses, used) != uses.end()) << place(line);
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
        << place(line);
}

TEST(Architecture, EveryHeaderIsGuardedAndOpensWithItsIdea) {
  for (const std::string folder : {"core", "precision"}) {
    for (const fs::path& file : headers(folder)) {
      if (file.extension() != ".hpp") continue;
      std::ifstream in(file);
      std::string first, second, text;
      std::getline(in, first);
      std::getline(in, second);
      bool guarded = first == "#pragma once";
      while (!guarded && std::getline(in, text)) guarded = text == "#pragma once";
      EXPECT_TRUE(guarded) << file;
      EXPECT_TRUE(is_comment(first) || is_comment(second)) << file;
    }
  }
}

// At most 120 characters in a line and, outside tests, 300 lines in a file, but for the table of keys.
TEST(Architecture, LinesAndFilesAreShort) {
  const std::set<fs::path> extensions{".hpp", ".cpp", ".inl", ".py", ".js", ".sh"};
  const auto begins_character = [](unsigned char byte) { return (byte & 0xC0) != 0x80; };
  for (const std::string folder : {"core", "precision", "tools", "tests", "bench"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(source_folder) / folder)) {
      if (!extensions.contains(entry.path().extension())) continue;
      std::ifstream in(entry.path());
      std::string text;
      int lines = 0;
      for (; std::getline(in, text); ++lines)
        EXPECT_LE(std::ranges::count_if(text, begins_character), 120) << entry.path() << ':' << lines + 1;
      const bool may_be_long = folder == "tests" || entry.path().filename() == "fields.cpp";
      EXPECT_TRUE(may_be_long || lines <= 300) << entry.path() << ": " << lines;
    }
}

}  // namespace cradle::test::architecture_test
