// Sums of decimals, their steps and parts, in integers.
#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include "cradle/tools/scene/decimal.hpp"
#include "cradle/tools/scene/rational.hpp"

namespace cradle::tools {
namespace {

// Float128 has numbers from 1e-4966 to 1e4932.
constexpr std::int64_t most_digits_of_sum = 20'000;

// The lowest and the highest power of ten.
std::pair<std::int64_t, std::int64_t> powers(std::initializer_list<Scaled*> numbers) {
  std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = std::numeric_limits<std::int64_t>::min();
  for (const Scaled* number : numbers)
    if (number->integer != 0) low = std::min(low, number->power), high = std::max(high, number->power);
  return low > high ? std::pair<std::int64_t, std::int64_t>() : std::pair(low, high);
}

// Gives all of these the lowest power of ten.
void align(std::initializer_list<Scaled*> numbers) {
  const std::int64_t low = powers(numbers).first;
  for (Scaled* number : numbers) {
    if (number->integer != 0) number->integer *= power_of_ten(number->power - low);
    number->power = low;
  }
}

bool is_very_long(std::int64_t of_last, std::int64_t) { return of_last > 64 || of_last < -64; }

// Without a power of ten unless it is very long.
std::string text_of(const Whole& integer, std::int64_t power) {
  return decimal_text(Scaled{integer, power}, is_very_long);
}

// A number in the middle of two binary ones is a fraction too: between two fractions is room for one unit of the
// product of their denominators.
std::int64_t digits_of_quotient(std::size_t digits, std::size_t of_integer, std::size_t of_parts, std::int64_t power) {
  return static_cast<std::int64_t>(digits + of_integer + of_parts) + (power < 0 ? -power : power);
}

// integer 10^power/parts in lowest terms; see decimals_by_parts.
std::string quotient_text(Whole integer, std::int64_t power, Whole parts, std::size_t digits) {
  while (parts % 10 == 0) parts /= 10, --power;
  while (parts % 5 == 0) parts /= 5, integer *= 2, --power;
  while (parts % 2 == 0) parts /= 2, integer *= 5, --power;
  if (parts == 1) return text_of(integer, power);
  const std::int64_t more = digits_of_quotient(digits, integer.str().size(), parts.str().size(), power);
  return text_of(integer * power_of_ten(more) / parts, power - more);
}

// The same, twenty times faster, of integers of 64 bits that are not negative, if the remainders fit.
std::optional<std::string> quotient_text(std::int64_t integer, std::int64_t power, std::int64_t parts,
                                         std::size_t digits) {
  constexpr int places = 9;
  constexpr std::int64_t shift = 1'000'000'000;
  const auto without = [&](std::int64_t factor, std::int64_t by) {
    bool fits = true;
    for (; fits && parts % factor == 0; parts /= factor, --power) fits = !__builtin_mul_overflow(integer, by, &integer);
    return fits;
  };
  if (parts > std::numeric_limits<std::int64_t>::max() / shift || !without(10, 1) || !without(5, 2) || !without(2, 5))
    return {};
  std::string text = std::to_string(integer / parts);
  if (parts == 1) return decimal_text({false, std::move(text), power}, is_very_long);
  std::int64_t more = digits_of_quotient(digits, std::to_string(integer).size(), std::to_string(parts).size(), power);
  power -= more;
  for (std::int64_t rest = integer % parts; more > 0; more -= places) {
    rest *= shift;
    const std::string next = std::to_string(shift + rest / parts);  // with a 1 before the zeros
    text.append(next, 1, static_cast<std::size_t>(std::min<std::int64_t>(more, places)));
    rest %= parts;
  }
  return decimal_text({false, std::move(text), power}, is_very_long);
}

// integer 10^power/parts.
std::string divided(const Whole& integer, std::int64_t power, const Whole& parts, std::size_t digits) {
  if (parts == 1) return text_of(integer, power);
  const Whole common = gcd(integer, parts), least = integer / common, of = parts / common;
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  if (least >= 0 && least <= most && of <= most)
    if (auto text = quotient_text(static_cast<std::int64_t>(least), power, static_cast<std::int64_t>(of), digits))
      return std::move(*text);
  return quotient_text(least, power, of, digits);
}

// from + k step/parts up to `until`, of one power of ten.
DecimalColumn spaced(const Scaled& from, const Scaled& step, const Whole& parts, const Scaled& until,
                     std::size_t digits) {
  DecimalColumn all;
  const Whole end = until.integer * parts;
  for (Whole at = from.integer * parts; at <= end; at += step.integer)
    all.push_back(divided(at, from.power, parts, digits));
  return all;
}

// A number of at most 18 digits, so that most sums need no integers of any size.
struct SmallDecimal {
  std::int64_t digits = 0, unit = 0;
};

std::optional<SmallDecimal> small_decimal(std::string_view text) {
  const auto [negative, digits, power] = literal_of(text);
  const std::size_t first = std::min(digits.find_first_not_of('0'), digits.size());
  if (digits.size() - first > 18) return {};
  SmallDecimal number{0, power};
  std::from_chars(digits.data() + first, digits.data() + digits.size(), number.digits);
  if (negative) number.digits = -number.digits;
  return number;
}

std::optional<std::string> short_sum(std::string_view a_text, std::string_view b_text, int sign) {
  const auto a = small_decimal(a_text), b = small_decimal(b_text);
  if (!a || !b) return {};
  const SmallDecimal &coarse = a->unit < b->unit ? *b : *a, &fine = a->unit < b->unit ? *a : *b;
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
  Scaled a = scaled(a_text), b = scaled(b_text);
  const auto [low, high] = powers({&a, &b});
  if (high - low > most_digits_of_sum) return {};
  align({&a, &b});
  return text_of(a.integer + sign * b.integer, a.power);
}

std::string difference(std::string_view a, std::string_view b) {
  if (auto exact = exact_sum(a, b, -1)) return std::move(*exact);
  // What is left of the smaller one is its sign: it decides a number that would be in the middle between two others.
  const DecimalParts of_a = parts_of(a), of_b = parts_of(b);
  const bool first = of_a.exponent() > of_b.exponent();
  Scaled large = scaled(first ? a : b);
  const std::int64_t power = std::min(large.power, (first ? of_a : of_b).exponent() - most_digits_of_sum);
  large.integer *= power_of_ten(large.power - power);
  const Whole small = (first ? of_b : of_a).negative ? -1 : 1;
  return text_of(first ? Whole(large.integer - small) : Whole(small - large.integer), power);
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

bool of_one_scale(const Decimal& a, const Decimal& b, const Decimal& c) {
  constexpr std::int64_t most_digits = 4000;
  Scaled first = scaled(a.text), second = scaled(b.text), third = scaled(c.text);
  const auto [low, high] = powers({&first, &second, &third});
  return high - low <= most_digits;
}

DecimalColumn decimals_by_step(const Decimal& from, const Decimal& step, const Decimal& until) {
  Scaled first = scaled(from.text), by = scaled(step.text), last = scaled(until.text);
  align({&first, &by, &last});
  return spaced(first, by, 1, last, 0);
}

DecimalColumn decimals_by_parts(const Decimal& from, const Decimal& to, std::uint64_t parts, const Decimal& until,
                                std::size_t digits) {
  Scaled first = scaled(from.text), end = scaled(to.text), last = scaled(until.text);
  align({&first, &end, &last});
  end.integer -= first.integer;
  return spaced(first, end, parts, last, digits + 5);
}

Decimal decimal_between(const Decimal& from, const Decimal& to, const Decimal& share) {
  Scaled first = scaled(from.text), way = scaled(to.text);
  const Scaled part = scaled(share.text);
  align({&first, &way});
  way.integer = (way.integer - first.integer) * part.integer, way.power += part.power;
  align({&first, &way});
  return Decimal(text_of(first.integer + way.integer, first.power));
}

std::optional<std::string> sum_of_products(const DecimalColumn& a, const DecimalColumn& b) {
  constexpr std::size_t most_terms = 100'000;
  constexpr std::int64_t most_digits = 2000;
  if (a.size() > most_terms) return {};
  std::map<std::int64_t, Whole> sums;  // by powers of ten
  for (std::size_t i = 0; i < a.size(); ++i) {
    Whole product = 1;
    std::int64_t power = 0;
    for (const DecimalColumn* column : {&a, &b}) {
      if (column->empty()) continue;
      const Scaled factor = scaled((*column)[i]);
      product *= factor.integer;
      power += factor.power;
    }
    if (product != 0) sums[power] += product;
  }
  Whole sum = 0;
  if (sums.empty()) return "0";
  const std::int64_t lowest = sums.begin()->first;
  if (sums.rbegin()->first - lowest > most_digits) return {};
  for (const auto& [power, of_it] : sums) sum += of_it * power_of_ten(power - lowest);
  return sum.str() + "e" + std::to_string(lowest);
}

}  // namespace cradle::tools
