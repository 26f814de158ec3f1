#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/commands/difference.hpp"
#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

namespace {

struct DiffArguments {
  std::string first, second, rtol;
  bool all = false;
};

constexpr std::size_t few = 10;  // differences, which are all printed

double tolerance(const std::string& text) {
  const auto value = to_number(text.empty() ? "0" : text);
  if (!value || *value < 0)
    throw Error({"", 0, "--rtol"}, "not a tolerance", text, "give a number from 0 on, 1e-12 for instance");
  return *value;
}

// "series" of "series/energy", "attributes" of "@outcome".
std::string part_of(const std::string& place) {
  const std::string part = place.substr(0, place.find_first_of("/@"));
  return part.empty() ? "attributes" : part;
}

// A line for each key of the effective scenes that differs.
void print_scenes(const std::string& first, const std::string& second) {
  const auto a = values(parse_scene(first, "A"), true), b = values(parse_scene(second, "B"), true);
  const auto found = [](const auto& scene, const std::string& key) {
    return std::find_if(scene.begin(), scene.end(), [&](const auto& entry) { return entry.first == key; });
  };
  for (const auto& [key, text] : a) {
    const auto other = found(b, key);
    if (other == b.end() || other->second != text)
      fmt::print("scene: {} = {} against {}\n", key, shortened(text),
                 other == b.end() ? "nothing" : shortened(other->second));
  }
  for (const auto& [key, text] : b)
    if (found(a, key) == a.end()) fmt::print("scene: {} = nothing against {}\n", key, shortened(text));
}

// A line for each part of the file in which something differs. By how much, columns say if there are any: attributes
// are often rounding itself.
void print_parts(const std::vector<Difference>& found) {
  std::vector<std::string> parts;
  for (const Difference& difference : found)
    if (const auto part = part_of(difference.place); std::find(parts.begin(), parts.end(), part) == parts.end())
      parts.push_back(part);
  for (const std::string& part : parts) {
    std::size_t count = 0;
    const Difference* largest = nullptr;
    for (const Difference& difference : found) {
      if (part_of(difference.place) != part) continue;
      ++count;
      const auto weight = [](const Difference& of) {
        return std::pair(of.place.find('@') == std::string::npos, *of.size);
      };
      if (difference.size && (largest == nullptr || weight(*largest) < weight(difference))) largest = &difference;
    }
    fmt::print("{}: {} difference{}{}\n", part, count, count == 1 ? "" : "s",
               largest == nullptr
                   ? ""
                   : fmt::format(", numbers by up to {:.2g} relative ({})", *largest->size, largest->place));
  }
}

Exit diff(const DiffArguments& options) {
  const double rtol = tolerance(options.rtol);
  const Result first = read_result(options.first), second = read_result(options.second);
  const auto [found, numbers, tolerated] = differences(first, second, options.first, options.second, rtol);
  const bool each = options.all || found.size() <= few;
  fmt::print("{}{} numbers compared{}\n",
             found.empty() ? "no difference: "
                           : fmt::format("{} difference{}{}: ", found.size(), found.size() == 1 ? "" : "s",
                                         each ? "" : " (--all lists them)"),
             numbers, tolerated > 0 ? fmt::format(", {} of them within --rtol {}", tolerated, options.rtol) : "");
  const auto scene = [](const Result& result, const std::string& file) {
    return attribute<std::string>(result.attributes, "scene", file);
  };
  print_scenes(scene(first, options.first), scene(second, options.second));
  if (found.size() > few) print_parts(found);
  if (each)
    for (const Difference& difference : found) fmt::print("  {}: {}\n", difference.place, difference.what);
  return found.empty() ? Exit::done : Exit::differs;
}

}  // namespace

void add_diff(CommandLine& program) {
  Command command = program.add(
      "diff", "in what two results differ: keys of their scenes, parts of the files, columns, and by how much",
      "cradle diff today.h5 yesterday.h5");
  auto& options = command.runs<DiffArguments>(diff);
  command.argument("A", options.first, "result file");
  command.argument("B", options.second, "result file");
  command.flag("--all", options.all, "lists every place that differs, however many there are");
  command.option("--rtol", options.rtol, "numbers that differ by at most this, relatively, are the same (default 0)");
  command.note(
      "Status 1 where they differ. Everything in the files is compared, attributes, units and shapes included.");
}

}  // namespace cradle::tools
