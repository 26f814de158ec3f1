// Reads particles from CSV line by line, or from the last snapshot of a result. Every number is checked when it is
// read, so that messages can name the line.
#include "cradle/tools/setup/list_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/setup/initial_state.hpp"
#include "cradle/tools/setup/read_scene.hpp"
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

constexpr const char* how_to_begin = "begin the file with a line x,v or x,v,m or gap,v";

// The columns of a file, in any order. Those of a snapshot that say nothing of its particles are passed over.
enum ColumnName { x_column, v_column, m_column, gap_column, closing_column, index_column };
constexpr std::string_view column_names[] = {"x", "v", "m", "gap", "closing_speed", "index"};

class Reader {
 public:
  Reader(const std::string& file, const Run& run) : file_(file), range_(run) {}

  void name_columns(const std::vector<std::string_view>& cells, std::size_t line) {
    for (const std::string_view cell : cells) {
      const auto name = std::ranges::find(column_names, cell);
      if (name == std::end(column_names) || has(static_cast<ColumnName>(name - column_names)))
        throw Error({file_, line, {}}, "the columns are not named", described(cells), how_to_begin);
      order_.push_back(static_cast<ColumnName>(name - column_names));
    }
    if (!has(v_column) || !(has(x_column) || has(gap_column)))
      throw Error({file_, line, {}}, "a column is missing", has(v_column) ? "neither x nor gap" : "no v", how_to_begin);
  }
  std::size_t columns() const { return order_.size(); }

  void add(const std::vector<std::string_view>& cells, std::size_t line) {
    line_ = line;
    if (ended_)
      throw Error(place("gap"), "a particle without a distance from the one before it", "an empty cell",
                  "give the gap in the line before");
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string_view cell = cells[i];
      switch (order_[i]) {
      case x_column:
        // Of particles with gaps only the first one needs a place.
        if (!has(gap_column) || !cell.empty() || listed_.x.empty()) listed_.x.push_back(number(cell, "x"));
        break;
      case v_column:
        listed_.v.push_back(number(cell, "v"));
        break;
      case m_column: {
        const auto m = number(cell, "m");
        if (std::is_lteq(compare_decimals(m, "0"))) throw Error(place("m"), "out of range", m, "give a mass above 0");
        range_.check_positive(m, place("m"));
        listed_.m.push_back(m);
        break;
      }
      case gap_column:
        if (cell.empty())
          ended_ = true;
        else
          listed_.gap.push_back(number(cell, "gap"));
        break;
      case closing_column:
        if (!cell.empty()) listed_.closing_speed.push_back(number(cell, "closing_speed"));
        break;
      case index_column:
        break;
      }
    }
    const auto& [x, v, m, gap, closing] = listed_;
    if (!has(gap_column) && x.size() > 1)
      check_neighbours({x[x.size() - 2], v[v.size() - 2]}, {x.back(), v.back()}, range_, place("x"));
    if (!gap.empty() && std::is_lt(compare_decimals(gap.back(), "0")))
      throw Error(place("gap"), "out of range", std::string(gap.back()), "give 0 or more");
  }

  const ListedColumns& listed() const { return listed_; }

 private:
  bool has(ColumnName name) const { return std::ranges::find(order_, name) != order_.end(); }
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
  std::vector<ColumnName> order_;
  bool ended_ = false;  // by a particle that has no distance to a next one
  ListedColumns listed_;
};

double magnitude_of(std::string_view number) { return std::abs(Decimal(number).value); }

// Throws Error if numbers and what their differences add up to are not the same but for rounding.
void check_sums(const DecimalColumn& given, const DecimalColumn& sums, const Place& place, const char* differences) {
  constexpr double most = 1e-6;
  double largest = 0;
  for (std::size_t i = 0; i < given.size(); ++i) largest = std::max(largest, magnitude_of(given[i]));
  for (std::size_t i = 0; i < given.size(); ++i)
    if (const auto off = difference(given[i], sums[i]); magnitude_of(off) > most * largest)
      throw Error(place, fmt::format("two different numbers for particle {}", i),
                  fmt::format("{}, and {:.17g} by {}", given[i], Decimal(sums[i]).value, differences),
                  "remove the column that is wrong");
}

// Adds to the largest number what rounding has left missing from the sum.
void complete(DecimalColumn& numbers, std::string_view sum, const Place& place) {
  const auto sums = summed_up("0", numbers, 1);
  std::size_t largest = 0;
  double size = 0, sizes = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    sizes += magnitude_of(numbers[i]);
    if (magnitude_of(numbers[i]) > size) size = magnitude_of(numbers[largest = i]);
  }
  const auto missing = sums ? exact_sum(sum, sums->back(), -1) : std::nullopt;
  if (!missing || magnitude_of(*missing) > 1e-6 * sizes)
    throw Error(place, "numbers that do not add up to that of the ring",
                fmt::format("{:.17g} for {}", sums ? Decimal(sums->back()).value : 0, sum),
                "leave out the last one, or correct it");
  DecimalColumn completed;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    completed.push_back(i == largest ? exact_sum(numbers[i], *missing, 1).value() : std::string(numbers[i]));
  numbers = std::move(completed);
}

}  // namespace

ListedParticles placed(ListedColumns listed, const Decimal& length, const Place& place) {
  auto& [x, v, m, gap, closing] = listed;
  const std::size_t pairs = v.size() - 1;
  for (const auto& [column, name, ring] : {std::tuple(&gap, "gap", std::string_view(length.text)),
                                           std::tuple(&closing, "closing_speed", std::string_view("0"))}) {
    if (column->empty()) continue;
    const bool all_around = column->size() == pairs + 1;
    if (column->size() != pairs && !(all_around && length > Decimal("0")))
      throw Error(place, fmt::format("not one {} for each particle but the last", name),
                  fmt::format("{} for {} particles", column->size(), v.size()), fmt::format("give {}", pairs));
    if (!all_around) continue;
    complete(*column, ring, place);
    DecimalColumn but_last;
    for (std::size_t i = 0; i < pairs; ++i) but_last.push_back((*column)[i]);
    *column = std::move(but_last);
  }
  const auto sum_up = [&](DecimalColumn& numbers, const DecimalColumn& steps, int sign, const char* name) {
    if (steps.empty() && numbers.size() > pairs) return;
    auto sums = summed_up(numbers.empty() ? "0" : numbers[0], steps, sign);
    if (!sums)
      throw Error(place, "numbers of too different sizes", fmt::format("more than 20000 digits in a sum of {}s", name),
                  "give larger ones");
    if (numbers.size() > pairs)
      check_sums(numbers, *sums, place, name);
    else if (numbers.size() > 1)
      throw Error(place, "more than one place beside gaps", fmt::format("{} of {} x", numbers.size(), pairs + 1),
                  "give that of the first particle, or all");
    numbers = std::move(*sums);
  };
  sum_up(x, gap, 1, "gap");
  sum_up(v, closing, -1, "closing_speed");
  return {std::move(x), std::move(v), std::move(m)};
}

ListedParticles parse_list(std::istream& csv, const std::string& file_name, const Run& run, const Decimal& length) {
  Reader reader(file_name, run);
  Place place{file_name, 0, {}};
  std::string line;
  std::vector<std::string_view> cells;
  while (std::getline(csv, line)) {
    ++place.line;
    std::string_view text = line;
    if (place.line == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
    text = trimmed(text);
    if (text.empty() || text.front() == '#') continue;
    split(text, cells);
    if (reader.columns() == 0) {
      reader.name_columns(cells, place.line);
      continue;
    }
    if (cells.size() != reader.columns())
      throw Error(place, "wrong number of columns", std::to_string(cells.size()),
                  fmt::format("give {} as in the first line", reader.columns()));
    reader.add(cells, place.line);
  }
  if (csv.bad()) throw Error({file_name, 0, {}}, "cannot be read", "a read error", "check the disk", Exit::io);
  if (reader.listed().v.empty())
    throw Error({file_name, 0, {}}, "no particles",
                reader.columns() == 0 ? "an empty file" : "only the names of the columns",
                "give a line x,v or x,v,m and then one line per particle");
  const bool sums = !reader.listed().gap.empty();
  ListedParticles particles = placed(reader.listed(), length, {file_name, 0, {}});
  if (sums) check_order(particles, run, [&](std::size_t i) { return Place{file_name, 0, fmt::format("gap {}", i)}; });
  return particles;
}

namespace {

// The column of a snapshot as decimals that read back as its numbers.
DecimalColumn decimals(const Result& result, const std::string& snapshot, const std::string& name,
                       const std::string& file) {
  DecimalColumn texts;
  for (const std::string& folder : {std::string("exact/"), std::string()})
    if (const Group* group = result.find(folder + snapshot))
      for (const Column& column : group->columns) {
        if (column.name != name) continue;
        if (const auto* exact = std::get_if<std::vector<std::string>>(&column.values)) {
          for (const std::string& text : *exact)
            if (const auto number = plain_decimal(text)) texts.push_back(*number);
          return texts;
        }
        if (const auto* doubles = std::get_if<std::vector<double>>(&column.values)) {
          for (const double x : *doubles)
            if (std::isfinite(x)) texts.push_back(*plain_decimal(fmt::format("{}", x)));
          return texts;
        }
      }
  throw Error({file, 0, snapshot}, "a snapshot without a column", name, "take the file from a copy", Exit::io);
}

// Of the particle that had the lowest number, in the rows of a snapshot: on a ring they begin at any particle.
std::size_t first_row(const Result& result, const std::string& snapshot) {
  for (const Column& column : result.find(snapshot)->columns)
    if (const auto* index = std::get_if<std::vector<std::uint64_t>>(&column.values); index && column.name == "index")
      return static_cast<std::size_t>(std::ranges::min_element(*index) - index->begin());
  return 0;
}

DecimalColumn rotated(const DecimalColumn& column, std::size_t first) {
  DecimalColumn turned;
  for (std::size_t i = 0; i < column.size(); ++i) turned.push_back(column[(first + i) % column.size()]);
  return turned;
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
  const auto column = [&](const char* name) { return decimals(result, snapshot, name, file); };
  ListedColumns listed{column("x"), column("v"), column("m"), column("gap"), column("closing_speed")};
  if (listed.v.size() != listed.x.size() || listed.m.size() != listed.x.size())
    throw Error({file, 0, snapshot}, "columns of different lengths", std::to_string(listed.v.size()),
                "take the file from a copy", Exit::io);
  const auto all = initial_particles<double>(other);
  CompensatedSum<double> mass;
  bool ones = true;
  for (std::size_t i = 0; i < listed.m.size(); ++i) {
    const Decimal m(listed.m[i]);
    mass.add(m.value);
    ones = ones && m == Decimal("1");
  }
  // Any missing particle is heavier than what sums round.
  if (!(std::abs(mass.value() - all->total_mass()) < all->least_mass() / 2))
    throw Error({file, 0, snapshot}, "particles that no collision has reached are not in it",
                fmt::format("{:g} of the mass {:g}", mass.value(), all->total_mass()),
                "take a later snapshot, when all particles have collided");
  if (ones) listed.m = {};
  if (other.initial.on_ring()) {
    const std::size_t first = first_row(result, snapshot);
    for (DecimalColumn* numbers : {&listed.x, &listed.v, &listed.m, &listed.gap, &listed.closing_speed})
      *numbers = rotated(*numbers, first);
    listed.x = {listed.x[0]};
  }
  if (other.initial.on_ring() && !scene.initial.on_ring()) scene.initial.length = other.initial.length;
  const NumberRange range(scene.run);
  for (const DecimalColumn* numbers : {&listed.x, &listed.v, &listed.m})
    for (std::size_t i = 0; i < numbers->size(); ++i) range.check((*numbers)[i], {file, 0, snapshot});
  ListedParticles particles = placed(std::move(listed), scene.initial.length, {file, 0, snapshot});
  check_order(particles, scene.run, [&](std::size_t) { return Place{file, 0, snapshot + "/gap"}; });
  return particles;
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
  ListedParticles particles =
      is_result ? last_state(path.string(), scene) : parse_list(file, path.string(), scene.run, scene.initial.length);
  scene.initial.file.reset();
  scene.initial.x = std::move(particles.x);
  scene.initial.v = std::move(particles.v);
  scene.initial.m = std::move(particles.m);
}

void check_particles(const Scene& scene) {
  if (scene.run.precision == Precision::double_)
    initial_particles<double>(scene);
  else
    initial_particles<long double>(scene);
}

}  // namespace cradle::tools
