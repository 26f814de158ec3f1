#include "cradle/tools/commands/difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {

namespace {

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}
template <class Value> bool same(const Value& a, const Value& b) { return a == b; }

// Numbers further apart are not those of one computation: their distance in ULPs says nothing.
constexpr std::uint64_t most_ulps = 1'000'000;

// |a - b| divided by the larger of |a| and |b|; infinite if a number is infinite or NaN.
double relative(double a, double b) {
  if (a == b) return 0;
  const double size = std::abs(a - b) / std::max(std::abs(a), std::abs(b));
  return std::isfinite(a) && std::isfinite(b) ? size : std::numeric_limits<double>::infinity();
}
double relative(std::uint64_t a, std::uint64_t b) {
  return static_cast<double>(std::max(a, b) - std::min(a, b)) / static_cast<double>(std::max(a, b));
}

// Of decimals of any length and power; infinite for other texts.
double relative(const std::string& a, const std::string& b) {
  const auto x = plain_decimal(a), y = plain_decimal(b);
  if (!x || !y) return std::numeric_limits<double>::infinity();
  const DecimalParts of_x = parts_of(*x), of_y = parts_of(*y), apart = parts_of(difference(*x, *y));
  if (apart.digits.empty()) return 0;
  const auto size = [](const DecimalParts& of) { return std::tuple(!of.digits.empty(), of.exponent(), of.digits); };
  const DecimalParts& larger = size(of_x) < size(of_y) ? of_y : of_x;
  const auto leading = [](const DecimalParts& of) { return std::stod("0." + of.digits.substr(0, 20)); };
  return leading(apart) / leading(larger) * std::pow(10., static_cast<double>(apart.exponent() - larger.exponent()));
}

std::string size_of(const std::string& a, const std::string& b) {
  const double size = relative(a, b);
  return std::isfinite(size) ? fmt::format(" ({:.2g} relative)", size) : "";
}
std::string size_of(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return "";
  const std::uint64_t ulps = ulps_between(a, b);
  return ulps <= most_ulps ? fmt::format(" ({} ULPs, {:.2g} relative)", ulps, relative(a, b))
                           : fmt::format(" ({:.2g} relative)", relative(a, b));
}
std::string size_of(std::uint64_t a, std::uint64_t b) {
  return fmt::format(" (by {})", std::max(a, b) - std::min(a, b));
}

// The first line in which two texts differ.
std::string first_line(std::string_view a, std::string_view b) {
  const auto [at, other] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  const auto before = static_cast<std::size_t>(at - a.begin());
  const std::size_t begin = a.substr(0, before).rfind('\n') + 1;  // npos + 1 = 0
  const auto line = [&](std::string_view text) { return text.substr(begin, text.find('\n', begin) - begin); };
  const bool of_one_line = a.find('\n') == a.npos && b.find('\n') == b.npos;
  const std::string where = of_one_line ? "" : fmt::format("line {}: ", 1 + std::count(a.begin(), at, '\n'));
  if (line(a) == line(b)) return where + "not the same end";
  return fmt::format("{}\"{}\" against \"{}\"", where, line(a), line(b));
}

class Comparison {
 public:
  Comparison(const std::string& first, const std::string& second, double rtol)
      : first_(first), second_(second), rtol_(rtol) {}

  // Calls both(x, y) for names in both lists, in the order of the first, and reports all other names.
  template <class Named, class Name, class Both>
  void pair(const std::vector<Named>& a, const std::vector<Named>& b, const Name& name, const std::string& kind,
            const Both& both) {
    for (const Named& x : a) {
      const auto y = std::find_if(b.begin(), b.end(), [&](const Named& other) { return name(other) == name(x); });
      if (y == b.end())
        report(kind + name(x), "only in " + first_);
      else
        both(x, *y);
    }
    for (const Named& y : b)
      if (std::none_of(a.begin(), a.end(), [&](const Named& other) { return name(other) == name(y); }))
        report(kind + name(y), "only in " + second_);
  }

  void attributes(const std::vector<Attribute>& a, const std::vector<Attribute>& b, const std::string& where) {
    pair(
        a, b, [](const Attribute& attribute) { return attribute.first; }, where + "@",
        [&](const Attribute& x, const Attribute& y) { attribute(where + "@" + x.first, x.second, y.second); });
  }

  void column(const std::string& where, const Column& a, const Column& b) {
    if (a.unit != b.unit) report(where, fmt::format("unit \"{}\" against \"{}\"", a.unit, b.unit));
    if (a.description != b.description) report(where, "description " + first_line(a.description, b.description));
    if (a.values.index() != b.values.index())
      return report(where, "real numbers, whole ones or text against another of these");
    if (a.width != b.width) report(where, fmt::format("{} numbers a row against {}", a.width, b.width));
    if (a.rows() != b.rows()) report(where, fmt::format("{} rows against {}", a.rows(), b.rows()));
    if (a.width != b.width) return;
    std::visit([&](const auto& x) { numbers(where, x, std::get<std::decay_t<decltype(x)>>(b.values), a.width); },
               a.values);
  }

  ResultDifferences result() && { return std::move(found_); }

 private:
  void report(const std::string& where, const std::string& what, std::optional<double> size = {}) {
    if (size && !std::isfinite(*size)) size.reset();
    found_.found.push_back({where, what, size});
  }

  template <class Number> bool differ(const Number& a, const Number& b) {
    ++found_.numbers;
    if (same(a, b)) return false;
    if (rtol_ > 0 && relative(a, b) <= rtol_) {
      ++found_.tolerated;
      return false;
    }
    return true;
  }

  void attribute(const std::string& where, const decltype(Attribute::second)& a, const decltype(Attribute::second)& b) {
    if (a.index() != b.index()) return report(where, "text, real or whole number against another of these");
    const auto value = [&]<class Value>(const Value& x) {
      const Value& y = std::get<Value>(b);
      if constexpr (std::is_same_v<Value, std::string>) {
        if (x != y) report(where, first_line(x, y));
      } else if (differ(x, y)) {
        report(where, fmt::format("{} against {}{}", x, y, size_of(x, y)), relative(x, y));
      }
    };
    std::visit(value, a);
  }

  template <class Number>
  void numbers(const std::string& where, const std::vector<Number>& a, const std::vector<Number>& b,
               std::size_t width) {
    std::optional<std::size_t> first;
    std::size_t count = 0;
    double largest = 0;
    const std::size_t both = std::min(a.size(), b.size());
    for (std::size_t i = 0; i < both; ++i)
      if (differ(a[i], b[i])) {
        if (!first) first = i;
        ++count;
        largest = std::max(largest, relative(a[i], b[i]));
      }
    if (!first) return;
    std::string line = fmt::format("first in row {}: {} against {}{}", *first / width, a[*first], b[*first],
                                   size_of(a[*first], b[*first]));
    if (count > 1) line += fmt::format("; {} of {} numbers differ", count, both);
    if (count > 1 && std::isfinite(largest)) line += fmt::format(", by up to {:.2g} relative", largest);
    report(where, line, largest);
  }

  const std::string &first_, &second_;
  double rtol_;
  ResultDifferences found_;
};

}  // namespace

std::uint64_t ulps_between(double a, double b) {
  // Maps doubles to signed integers in the same order: the bits of negative numbers count down.
  const auto place = [](double x) {
    const auto bits = std::bit_cast<std::int64_t>(x);
    return bits < 0 ? std::numeric_limits<std::int64_t>::min() - bits : bits;
  };
  const std::int64_t x = place(a), y = place(b);
  return static_cast<std::uint64_t>(std::max(x, y)) - static_cast<std::uint64_t>(std::min(x, y));
}

ResultDifferences differences(const Result& a, const Result& b, const std::string& first, const std::string& second,
                              double rtol) {
  Comparison comparison(first, second, rtol);
  comparison.attributes(a.attributes, b.attributes, "");
  comparison.pair(
      a.groups, b.groups, [](const Group& group) { return group.name; }, "",
      [&](const Group& x, const Group& y) {
        comparison.attributes(x.attributes, y.attributes, x.name);
        comparison.pair(
            x.columns, y.columns, [](const Column& column) { return column.name; }, x.name + "/",
            [&](const Column& c, const Column& d) { comparison.column(x.name + "/" + c.name, c, d); });
      });
  return std::move(comparison).result();
}

}  // namespace cradle::tools
