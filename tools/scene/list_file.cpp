// Reads particles from CSV line by line, or from the last snapshot of a result. Every number is checked when it is
// read, so that messages can name the line.
#include "cradle/tools/scene/list_file.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cradle/tools/model/initial_state.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/scene/number_range.hpp"
#include "cradle/tools/support/atomic_file.hpp"

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

// Names of columns are shown; of a file that is something else, nothing.
std::string described(const std::vector<std::string_view>& cells) {
  const auto is_name = [](std::string_view cell) {
    const auto in_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    return !cell.empty() && cell.size() <= 20 && std::isalpha(static_cast<unsigned char>(cell.front())) != 0 &&
           std::ranges::all_of(cell, in_name);
  };
  const auto is_number = [](std::string_view cell) { return canonical_decimal(cell).has_value(); };
  if (std::ranges::all_of(cells, is_number)) return fmt::format("a line of numbers, {} of them", cells.size());
  if (cells.size() <= 8 && std::ranges::all_of(cells, is_name)) return fmt::format("\"{}\"", fmt::join(cells, ","));
  return "other text";
}

bool is_not_finite(std::string_view cell) {
  std::string word(cell);
  std::erase_if(word, [](char c) { return c == '+' || c == '-'; });
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word == "inf" || word == "infinity" || word == "nan";
}

// Reads the lines of a file into columns.
class Reader {
 public:
  Reader(const std::string& file, const Run& run) : file_(file), range_(run) {}

  void add(const std::vector<std::string_view>& cells, std::size_t line) {
    line_ = line;
    const auto x = number(cells[0], "x");
    if (!particles_.x.empty()) {
      const auto order = compare_decimals(x, particles_.x.back());
      if (std::is_lteq(order))
        throw Error(place("x"), std::is_eq(order) ? "coincident particles" : "not increasing",
                    fmt::format("{} after {}", excerpt(x), excerpt(particles_.x.back())),
                    "give the particles in order of increasing x");
    }
    particles_.x.push_back(x);
    particles_.v.push_back(number(cells[1], "v"));
    if (cells.size() == 2) return;
    const auto m = number(cells[2], "m");
    if (std::is_lteq(compare_decimals(m, "0"))) throw Error(place("m"), "out of range", m, "give a mass above 0");
    range_.check_positive(m, place("m"));
    particles_.m.push_back(m);
  }

  ListedParticles& particles() { return particles_; }

 private:
  Place place(const char* column) const { return {file_, line_, column}; }

  std::string number(std::string_view cell, const char* column) const {
    auto literal = plain_decimal(cell);
    if (!literal)
      throw Error(place(column), is_not_finite(cell) ? "not finite" : "not a decimal number",
                  fmt::format("\"{}\"", excerpt(cell)), "give a decimal number");
    range_.check(*literal, place(column));
    return std::move(*literal);
  }

  const std::string& file_;
  NumberRange range_;
  std::size_t line_ = 0;
  ListedParticles particles_;
};

}  // namespace

ListedParticles parse_list(std::istream& csv, const std::string& file_name, const Run& run) {
  Reader reader(file_name, run);
  Place place{file_name, 0, {}};
  std::size_t columns = 0;  // 0: not named yet
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
        throw Error(place, "the columns are not named", described(cells), "begin the file with a line x,v or x,v,m");
      continue;
    }
    if (cells.size() != columns)
      throw Error(place, "wrong number of columns", std::to_string(cells.size()),
                  fmt::format("give {} as in the first line", columns));
    reader.add(cells, place.line);
  }
  if (csv.bad()) throw Error({file_name, 0, {}}, "cannot be read", "a read error", "check the disk", Exit::io);
  if (reader.particles().x.empty())
    throw Error({file_name, 0, {}}, "no particles", columns == 0 ? "an empty file" : "only the names of the columns",
                "give a line x,v or x,v,m and then one line per particle");
  return std::move(reader.particles());
}

namespace {

// The column of a snapshot as decimals that read back as its numbers.
std::vector<std::string> decimals(const Result& result, const std::string& snapshot, const std::string& name,
                                  const std::string& file) {
  for (const std::string& folder : {std::string("exact/"), std::string()})
    if (const Group* group = result.find(folder + snapshot))
      for (const Column& column : group->columns) {
        if (column.name != name) continue;
        if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values)) return *texts;
        if (const auto* doubles = std::get_if<std::vector<double>>(&column.values)) {
          std::vector<std::string> texts;
          for (const double x : *doubles) texts.push_back(fmt::format("{}", x));
          return texts;
        }
      }
  throw Error({file, 0, snapshot}, "a snapshot without a column", name, "take the file from a copy", Exit::io);
}

// The last snapshot of a result, and the ring that it is on.
ListedParticles last_state(const std::string& file, Scene& scene) {
  const Result result = read_result(file);
  const Scene other = parse_scene(attribute<std::string>(result.attributes, "scene", file), file);
  std::string snapshot;
  for (const Group& group : result.groups)
    if (group.name.starts_with("snapshots/")) snapshot = group.name;
  if (snapshot.empty())
    throw Error({file, 0, "snapshots"}, "a result without a state of its particles", "no snapshot",
                "run its scene with output.snapshots at the time that is to be taken");
  const auto x = decimals(result, snapshot, "x", file), v = decimals(result, snapshot, "v", file),
             m = decimals(result, snapshot, "m", file);
  if (v.size() != x.size() || m.size() != x.size())
    throw Error({file, 0, snapshot}, "columns of different lengths", std::to_string(v.size()),
                "take the file from a copy", Exit::io);
  const auto all = initial_particles<double>(other);
  CompensatedSum<double> mass;
  for (const std::string& text : m) mass.add(Decimal(text).value);
  // Any missing particle is heavier than what sums round.
  if (!(std::abs(mass.value() - all->total_mass()) < all->least_mass() / 2))
    throw Error({file, 0, snapshot}, "particles that no collision has reached are not in it",
                fmt::format("{:g} of the mass {:g}", mass.value(), all->total_mass()),
                "take a later snapshot, when all particles have collided");
  for (std::size_t i = 1; i < x.size(); ++i)
    if (std::is_lteq(compare_decimals(x[i], x[i - 1])))
      throw Error({file, 0, snapshot + "/x"}, "particles closer to each other than positions resolve",
                  fmt::format("{} after {}", x[i], x[i - 1]), "run its scene in more digits (run.precision)");
  Reader reader(file, scene.run);
  const bool ones = std::ranges::all_of(m, [](const std::string& text) { return Decimal(text) == Decimal("1"); });
  for (std::size_t i = 0; i < x.size(); ++i)
    reader.add(ones ? std::vector<std::string_view>{x[i], v[i]} : std::vector<std::string_view>{x[i], v[i], m[i]}, 0);
  if (other.initial.on_ring() && !scene.initial.on_ring()) scene.initial.length = other.initial.length;
  return std::move(reader.particles());
}

}  // namespace

void read_list(const std::filesystem::path& path, Scene& scene) {
  if (const auto found = instead_of_file(path.string()); !found.empty())
    throw Error({path.string(), 0, {}}, "not a list of particles", found,
                "name a CSV file of particles or a result in initial.file, relative to the scene file", Exit::io);
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error({path.string(), 0, {}}, "the list of particles cannot be read", "no such file, or no permission",
                "correct initial.file, which is relative to the scene file", Exit::io);
  char first = 0;
  const bool is_result = file.get(first) && first == '\x89';  // as HDF5 begins
  file.clear();
  file.seekg(0);
  ListedParticles particles = is_result ? last_state(path.string(), scene) : parse_list(file, path.string(), scene.run);
  scene.initial.file.reset();
  scene.initial.x = std::move(particles.x);
  scene.initial.v = std::move(particles.v);
  scene.initial.m = std::move(particles.m);
}

}  // namespace cradle::tools
