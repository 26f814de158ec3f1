// Decimal literals in parts: sign, significant digits, and the power of ten of the first digit.
#include "cradle/tools/scene/decimal.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <charconv>
#include <limits>
#include <map>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "cradle/precision/read_number.hpp"

namespace cradle::tools {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t count_digits(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  return static_cast<std::size_t>(end - text.begin());
}

// The number 0.d1 d2 d3 ... times 10^exponent; d1 and the last digit are not 0; zero has no digits.
struct Parts {
  bool negative = false;
  std::string digits;
  std::int64_t exponent = 0;
};

Parts parts_of(std::string_view text) {
  Parts parts;
  if (text.starts_with('-')) {
    parts.negative = true;
    text.remove_prefix(1);
  }
  if (const auto e = text.find_first_of("eE"); e != text.npos) {
    auto power = text.substr(e + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    std::from_chars(power.data(), power.data() + power.size(), parts.exponent);
    text = text.substr(0, e);
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  parts.digits = text.substr(0, point);
  if (point < text.size()) parts.digits += text.substr(point + 1);
  parts.exponent += static_cast<std::int64_t>(point);

  const std::size_t first = parts.digits.find_first_not_of('0');
  if (first == std::string::npos) return {};
  parts.exponent -= static_cast<std::int64_t>(first);
  parts.digits = parts.digits.substr(first, parts.digits.find_last_not_of('0') + 1 - first);
  return parts;
}

std::strong_ordering compare_magnitudes(const Parts& a, const Parts& b) {
  if (a.exponent != b.exponent) return a.exponent <=> b.exponent;
  return a.digits <=> b.digits;  // both begin with the same power of ten and have no zeros at the end
}

// Float128 has numbers from 1e-4966 to 1e4932.
constexpr std::int64_t most_digits_of_sum = 20'000;

using Integer = boost::multiprecision::cpp_int;

// The power of ten of the last digit.
std::int64_t unit_of(const Parts& p) { return p.exponent - static_cast<std::int64_t>(p.digits.size()); }

// The finer one of two numbers' units; that of zero does not count.
std::int64_t finest_unit(const Parts& a, const Parts& b) {
  return a.digits.empty() ? unit_of(b) : b.digits.empty() ? unit_of(a) : std::min(unit_of(a), unit_of(b));
}

// In units of this power of ten, which is no larger than the number's own.
Integer in_units(const Parts& p, std::int64_t unit) {
  if (p.digits.empty()) return 0;
  const Integer size = Integer(p.digits) * pow(Integer(10), static_cast<unsigned>(unit_of(p) - unit));
  return p.negative ? Integer(-size) : size;
}

// Without an exponent where that needs at most 64 places.
std::string text_of(const Integer& number, std::int64_t unit) {
  std::string digits = Integer(abs(number)).str();
  const std::string sign = number < 0 ? "-" : "";
  if (unit > 0 || unit < -64) return sign + digits + "e" + std::to_string(unit);
  const auto places = static_cast<std::size_t>(-unit);
  if (places == 0) return sign + digits;
  if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
  return sign + digits.substr(0, digits.size() - places) + "." + digits.substr(digits.size() - places);
}

}  // namespace

std::optional<std::string> canonical_decimal(std::string_view written) {
  // An underscore must be between two digits, as in TOML.
  for (std::size_t i = 0; i < written.size(); ++i)
    if (written[i] == '_' &&
        (i == 0 || i + 1 == written.size() || !is_digit(written[i - 1]) || !is_digit(written[i + 1])))
      return {};
  std::string stripped(written);
  std::erase(stripped, '_');
  std::string_view text = stripped;

  std::string result;
  if (text.starts_with('-')) result = "-";
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);

  const std::size_t whole = count_digits(text);
  // TOML refuses leading zeros in a number; a quoted number may have them.
  const std::size_t zeros = std::min(text.find_first_not_of('0'), whole);
  result += zeros == whole ? "0" : text.substr(zeros, whole - zeros);
  text.remove_prefix(whole);
  std::size_t fraction = 0;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    fraction = count_digits(text);
    if (fraction > 0) result.append(".").append(text.substr(0, fraction));
    text.remove_prefix(fraction);
  }
  if (whole + fraction == 0) return {};
  if (text.empty()) return result;

  if (text.front() != 'e' && text.front() != 'E') return {};
  text.remove_prefix(1);
  result += 'e';
  if (text.starts_with('-')) result += '-';
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  // 18 digits keep every sum of exponents within 64 bits.
  if (text.empty() || text.size() > 18 || count_digits(text) != text.size()) return {};
  return result.append(text);
}

std::optional<std::string> plain_decimal(std::string_view text) {
  return text.find('_') == text.npos ? canonical_decimal(text) : std::nullopt;
}

std::strong_ordering compare_decimals(std::string_view a_text, std::string_view b_text) {
  const Parts a = parts_of(a_text);
  const Parts b = parts_of(b_text);
  const auto sign = [](const Parts& p) { return p.digits.empty() ? 0 : p.negative ? -1 : 1; };
  if (sign(a) != sign(b)) return sign(a) <=> sign(b);
  if (sign(a) == 0) return std::strong_ordering::equal;
  return a.negative ? compare_magnitudes(b, a) : compare_magnitudes(a, b);
}

bool is_whole(std::string_view text) {
  const Parts parts = parts_of(text);
  return parts.exponent >= static_cast<std::int64_t>(parts.digits.size());
}

std::optional<std::uint64_t> decimal_integer(std::string_view text) {
  Parts parts = parts_of(text);
  if (parts.digits.empty()) return 0;
  if (parts.negative || parts.exponent < static_cast<std::int64_t>(parts.digits.size()) || parts.exponent > 20)
    return {};
  parts.digits.append(static_cast<std::size_t>(parts.exponent) - parts.digits.size(), '0');
  std::uint64_t result = 0;
  const char* end = parts.digits.data() + parts.digits.size();
  const auto [stop, error] = std::from_chars(parts.digits.data(), end, result);
  if (error != std::errc() || stop != end) return {};
  return result;
}

Decimal::Decimal(std::string_view literal) {
  auto canonical = canonical_decimal(literal);
  if (!canonical) throw std::invalid_argument("not a decimal number: " + std::string(literal));
  text = std::move(*canonical);
  const auto [end, error] = read_number(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) {
    const Parts parts = parts_of(text);
    value = parts.exponent < 0 ? 0 : std::numeric_limits<double>::infinity();
    if (parts.negative) value = -value;
  }
}

std::optional<Decimal> stepped(const Decimal& start, std::uint64_t k, const Decimal& step) {
  constexpr std::int64_t most_digits = 4096;
  const Parts a = parts_of(start.text), b = parts_of(step.text);
  if (a.digits.empty() && (k == 0 || b.digits.empty())) return start;
  const std::int64_t unit = finest_unit(a, b);
  if (std::max(unit_of(a), unit_of(b)) - unit > most_digits) return {};
  return Decimal(text_of(in_units(a, unit) + in_units(b, unit) * k, unit));
}

namespace {

// A number of at most 18 digits, so that most sums need no integers of any size.
struct Short {
  std::int64_t digits = 0, unit = 0;
};

std::optional<Short> short_number(std::string_view text) {
  Short number;
  const bool negative = text.starts_with('-');
  int digits = 0;
  std::size_t i = negative ? 1 : 0;
  bool fraction = false;
  for (; i < text.size() && (is_digit(text[i]) || text[i] == '.'); ++i) {
    if (text[i] == '.') {
      fraction = true;
      continue;
    }
    if (number.digits != 0 || text[i] != '0')
      if (++digits > 18) return {};
    number.digits = 10 * number.digits + (text[i] - '0');
    number.unit -= fraction;
  }
  if (i < text.size()) {
    std::int64_t power = 0;
    std::from_chars(text.data() + i + 1, text.data() + text.size(), power);
    number.unit += power;
  }
  if (negative) number.digits = -number.digits;
  return number;
}

std::optional<std::string> short_sum(std::string_view a_text, std::string_view b_text, int sign) {
  const auto a = short_number(a_text), b = short_number(b_text);
  if (!a || !b) return {};
  const Short &coarse = a->unit < b->unit ? *b : *a, &fine = a->unit < b->unit ? *a : *b;
  std::int64_t scaled = coarse.digits, sum = 0;
  for (std::int64_t shift = coarse.digits == 0 ? 0 : coarse.unit - fine.unit; shift > 0; --shift)
    if (__builtin_mul_overflow(scaled, std::int64_t{10}, &scaled)) return {};
  const std::int64_t first = a->unit < b->unit ? fine.digits : scaled,
                     second = sign * (a->unit < b->unit ? scaled : fine.digits);
  if (__builtin_add_overflow(first, second, &sum)) return {};
  return sum == 0 ? "0" : std::to_string(sum) + (fine.unit == 0 ? "" : "e" + std::to_string(fine.unit));
}

}  // namespace

std::optional<std::string> exact_sum(std::string_view a_text, std::string_view b_text, int sign) {
  if (auto quick = short_sum(a_text, b_text, sign)) return quick;
  const Parts a = parts_of(a_text), b = parts_of(b_text);
  if (a.digits.empty() && b.digits.empty()) return "0";
  const std::int64_t unit = finest_unit(a, b);
  if (std::max(a.exponent, b.exponent) - unit > most_digits_of_sum) return {};
  return text_of(in_units(a, unit) + sign * in_units(b, unit), unit);
}

std::string difference(std::string_view a, std::string_view b) {
  if (auto exact = exact_sum(a, b, -1)) return std::move(*exact);
  // What is left of the smaller one is its sign: it decides a number that would be in the middle between two others.
  const Parts of_a = parts_of(a), of_b = parts_of(b);
  const bool first = of_a.exponent > of_b.exponent;
  const Parts& larger = first ? of_a : of_b;
  const std::int64_t unit = std::min(unit_of(larger), larger.exponent - most_digits_of_sum);
  const Integer large = in_units(larger, unit), small = (first ? of_b : of_a).negative ? -1 : 1;
  return text_of(first ? large - small : small - large, unit);
}

std::optional<DecimalColumn> summed_up(std::string_view first, const DecimalColumn& steps, int sign) {
  DecimalColumn sums{first};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto next = exact_sum(sums.back(), steps[i], sign);
    if (!next) return {};
    sums.push_back(*next);
  }
  return sums;
}

void DecimalColumn::push_back(std::string_view literal) {
  if (!data_)
    data_ = std::make_shared<Data>();
  else if (data_.use_count() > 1)
    data_ = std::make_shared<Data>(*data_);
  data_->text += literal;
  data_->ends.push_back(data_->text.size());
}

bool operator==(const DecimalColumn& a, const DecimalColumn& b) {
  if (a.data_ == b.data_) return true;
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::is_neq(compare_decimals(a[i], b[i]))) return false;
  return true;
}

std::optional<std::string> sum_of_products(const DecimalColumn& a, const DecimalColumn& b) {
  constexpr std::size_t most_terms = 100'000;
  constexpr std::int64_t most_digits = 2000;
  if (a.size() > most_terms) return {};
  std::map<std::int64_t, Integer> sums;  // by powers of ten
  for (std::size_t i = 0; i < a.size(); ++i) {
    Integer product = 1;
    std::int64_t power = 0;
    for (const DecimalColumn* column : {&a, &b}) {
      if (column->empty()) continue;
      const Parts parts = parts_of((*column)[i]);
      product *= parts.digits.empty() ? Integer(0) : Integer(parts.digits);
      if (parts.negative) product = -product;
      power += unit_of(parts);
    }
    if (product != 0) sums[power] += product;
  }
  Integer sum = 0;
  if (sums.empty()) return "0";
  const std::int64_t lowest = sums.begin()->first;
  if (sums.rbegin()->first - lowest > most_digits) return {};
  for (const auto& [power, of_it] : sums) sum += of_it * pow(Integer(10), static_cast<unsigned>(power - lowest));
  return sum.str() + "e" + std::to_string(lowest);
}

}  // namespace cradle::tools
