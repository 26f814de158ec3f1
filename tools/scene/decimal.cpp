// Decimal literals: which are canonical, how they compare, and what they are in other numbers.
#include "cradle/tools/scene/decimal.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "cradle/tools/scene/rational.hpp"

namespace cradle::tools {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t count_digits(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  return static_cast<std::size_t>(end - text.begin());
}

std::strong_ordering compare_magnitudes(const DecimalParts& a, const DecimalParts& b) {
  if (a.exponent() != b.exponent()) return a.exponent() <=> b.exponent();
  return a.digits <=> b.digits;  // both begin with the same power of ten and have no zeros at the end
}

DecimalParts without_zeros(const DecimalParts& number) {
  const auto& [negative, digits, power] = number;
  const std::size_t first = digits.find_first_not_of('0'), end = digits.find_last_not_of('0') + 1;
  if (end == 0) return {};
  return {negative, digits.substr(first, end - first), power + static_cast<std::int64_t>(digits.size() - end)};
}

}  // namespace

DecimalParts literal_of(std::string_view text) {
  DecimalParts literal{text.starts_with('-'), {}, 0};
  if (literal.negative) text.remove_prefix(1);
  if (const auto e = text.find_first_of("eE"); e != text.npos) {
    std::from_chars(text.data() + e + 1, text.data() + text.size(), literal.power);
    text = text.substr(0, e);
  }
  literal.digits = text;
  if (const auto point = text.find('.'); point != text.npos) {
    literal.digits.erase(point, 1);
    literal.power -= static_cast<std::int64_t>(text.size() - point - 1);
  }
  return literal;
}

DecimalParts parts_of(std::string_view text) { return without_zeros(literal_of(text)); }

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
  const DecimalParts a = parts_of(a_text);
  const DecimalParts b = parts_of(b_text);
  const auto sign = [](const DecimalParts& p) { return p.digits.empty() ? 0 : p.negative ? -1 : 1; };
  if (sign(a) != sign(b)) return sign(a) <=> sign(b);
  if (sign(a) == 0) return std::strong_ordering::equal;
  return a.negative ? compare_magnitudes(b, a) : compare_magnitudes(a, b);
}

bool is_whole(std::string_view text) { return parts_of(text).power >= 0; }

std::optional<std::uint64_t> decimal_integer(std::string_view text) {
  DecimalParts parts = parts_of(text);
  if (parts.digits.empty()) return 0;
  if (parts.negative || parts.power < 0 || parts.exponent() > 20) return {};
  parts.digits.append(static_cast<std::size_t>(parts.power), '0');
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
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) {
    const DecimalParts parts = parts_of(text);
    value = parts.exponent() < 0 ? 0 : std::numeric_limits<double>::infinity();
    if (parts.negative) value = -value;
  }
}

Scaled scaled(std::string_view decimal) {
  const DecimalParts parts = parts_of(decimal);
  if (parts.digits.empty()) return {};
  const Whole digits(parts.digits);
  return {parts.negative ? Whole(-digits) : digits, parts.power};
}

std::string decimal_text(const DecimalParts& number, WithPower with_power) {
  auto [negative, digits, power] = without_zeros(number);
  if (digits.empty()) return "0";
  if (with_power(power, std::ssize(digits))) {
    if (power != 0) digits += "e" + std::to_string(power);
  } else if (power >= 0) {
    digits.append(static_cast<std::size_t>(power), '0');
  } else {
    const auto places = static_cast<std::size_t>(-power);
    if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
    digits.insert(digits.size() - places, ".");
  }
  return negative ? "-" + digits : digits;
}

std::string decimal_text(Scaled number, WithPower with_power) {
  return decimal_text({number.integer < 0, Whole(abs(number.integer)).str(), number.power}, with_power);
}

Whole power_of_ten(long exponent) { return pow(Whole(10), static_cast<unsigned>(exponent)); }

std::optional<Rational> rational(std::string_view decimal) {
  constexpr long most_exponent = 5000;
  const auto [digits, power] = scaled(decimal);
  if (std::abs(power) > most_exponent) return {};
  const Whole scale = power_of_ten(std::abs(power));
  return power < 0 ? Rational(digits, scale) : Rational(digits * scale);
}

std::string decimal_text(const Rational& number, unsigned digits) {
  if (number == 0) return "0";
  const Whole top = abs(numerator(number)), bottom = denominator(number);
  const auto length = [](const Whole& of) { return static_cast<long>(of.str().size()); };
  const long unit = length(top) - length(bottom) - static_cast<long>(digits);
  const Whole scaled = unit < 0 ? Whole(top * power_of_ten(-unit)) : top,
              by = unit < 0 ? bottom : Whole(bottom * power_of_ten(unit));
  const Whole quotient = scaled / by;
  const bool exact = quotient * by == scaled;
  return (number < 0 ? "-" : "") + quotient.str() + (exact ? "0" : "1") + "e" + std::to_string(unit - 1);
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

}  // namespace cradle::tools
