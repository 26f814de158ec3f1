// Reads particles from CSV line by line. Every number is checked when it is read, so that messages can name the line.
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

#include "cradle/tools/scene/source.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tools {
namespace {

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
struct ColumnRow {
  const char* name;
  DecimalColumn ListedColumns::*numbers;
};
constexpr ColumnRow column_rows[] = {
    {"x", &ListedColumns::x},     {"v", &ListedColumns::v}, {"m", &ListedColumns::m},
    {"gap", &ListedColumns::gap}, {"index", nullptr},       {"closing_speed", &ListedColumns::closing_speed},
};

class Reader {
 public:
  Reader(const std::string& file, const Run& run) : file_(file), range_(run) {}

  void name_columns(const std::vector<std::string_view>& cells, std::size_t line) {
    for (const std::string_view cell : cells) {
      const auto* const row = std::ranges::find(column_rows, cell, &ColumnRow::name);
      if (row == std::end(column_rows) || std::ranges::find(order_, row) != order_.end())
        throw Error({file_, line, {}}, "the columns are not named", described(cells), how_to_begin);
      order_.push_back(row);
    }
    const bool v = has(&ListedColumns::v);
    if (!v || !(has(&ListedColumns::x) || has(&ListedColumns::gap)))
      throw Error({file_, line, {}}, "a column is missing", v ? "neither x nor gap" : "no v", how_to_begin);
  }
  std::size_t columns() const { return order_.size(); }

  void add(const std::vector<std::string_view>& cells, std::size_t line) {
    line_ = line;
    if (ended_)
      throw Error(place("gap"), "a particle without a distance from the one before it", "an empty cell",
                  "give the gap in the line before");
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto& [name, numbers] = *order_[i];
      if (numbers == nullptr || (cells[i].empty() && may_be_empty(numbers))) continue;
      const std::string literal = number(cells[i], name);
      if (numbers == &ListedColumns::m && std::is_lteq(compare_decimals(literal, "0")))
        throw Error(place(name), "out of range", literal, "give a mass above 0");
      (listed_.*numbers).push_back(literal);
    }
    ended_ = has(&ListedColumns::gap) && listed_.gap.size() < listed_.v.size();
    const auto& [x, v, m, gap, closing] = listed_;
    if (!has(&ListedColumns::gap) && x.size() > 1) check_neighbours(x, v, x.size() - 1, range_, place("x"));
    if (!gap.empty() && std::is_lt(compare_decimals(gap.back(), "0")))
      throw Error(place("gap"), "out of range", std::string(gap.back()), "give 0 or more");
  }

  const ListedColumns& listed() const { return listed_; }

 private:
  bool has(DecimalColumn ListedColumns::*numbers) const {
    return std::ranges::find(order_, numbers, &ColumnRow::numbers) != order_.end();
  }
  // Of particles with gaps only the first one needs a place, and the last one has no gap.
  bool may_be_empty(DecimalColumn ListedColumns::*numbers) const {
    if (numbers == &ListedColumns::x) return has(&ListedColumns::gap) && !listed_.x.empty();
    return numbers == &ListedColumns::gap || numbers == &ListedColumns::closing_speed;
  }
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
  std::vector<const ColumnRow*> order_;
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
void complete(DecimalColumn& numbers, std::string_view sum, const Place& place, bool by_hand) {
  const auto sums = summed_up("0", numbers, 1);
  std::size_t largest = 0;
  double size = 0, sizes = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    sizes += magnitude_of(numbers[i]);
    if (magnitude_of(numbers[i]) > size) size = magnitude_of(numbers[largest = i]);
  }
  const auto missing = sums ? exact_sum(sum, sums->back(), -1) : std::nullopt;
  if (!missing || (by_hand && magnitude_of(*missing) > 1e-6 * sizes))
    throw Error(place, "numbers that do not add up to that of the ring",
                fmt::format("{:.17g} for {}", sums ? Decimal(sums->back()).value : 0, sum),
                "leave out the last one, or correct it");
  DecimalColumn completed;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    completed.push_back(i == largest ? exact_sum(numbers[i], *missing, 1).value() : std::string(numbers[i]));
  numbers = std::move(completed);
}

}  // namespace

ListedParticles placed(ListedColumns listed, const Decimal& length, const Place& place, bool by_hand) {
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
    complete(*column, ring, place, by_hand);
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
    if (numbers.size() > pairs && by_hand)
      check_sums(numbers, *sums, place, name);
    else if (numbers.size() > 1 && numbers.size() <= pairs)
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
  Place place{file_name};
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
  if (csv.bad()) throw Error({file_name}, "cannot be read", "a read error", "check the disk", Exit::io);
  if (reader.listed().v.empty())
    throw Error({file_name}, "no particles", reader.columns() == 0 ? "an empty file" : "only the names of the columns",
                "give a line x,v or x,v,m and then one line per particle");
  const bool sums = !reader.listed().gap.empty();
  ListedParticles particles = placed(reader.listed(), length, {file_name});
  const auto before = [&](std::size_t i) { return Place{file_name, 0, fmt::format("gap {}", i)}; };
  if (sums) check_order(particles.x, particles.v, run, before);
  return particles;
}

void read_list(const std::filesystem::path& path, Scene& scene) {
  if (const auto found = instead_of_file(path.string()); !found.empty())
    throw Error({path.string()}, "not a list of particles", found,
                "name a CSV file of particles or a result in initial.file, relative to the scene file", Exit::io);
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error({path.string()}, "the list of particles cannot be read", "no such file, or no permission",
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

}  // namespace cradle::tools
