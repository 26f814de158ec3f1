// Exact decimal literals. Numbers in a scene are decimals in the working precision, so their text is kept as written.
// Read through a double, 0.999 would not be 0.999 in wider types, 1e-400 would be 0, and digits past the 17th would be
// lost. Comparisons are exact; they compare the texts, with any number of digits and exponents of up to 18 digits.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cradle::tools {

/// The canonical form of a finite decimal literal: no underscores, no leading '+', a digit on both sides of the point
/// ("+1_000" gives "1000", ".5" gives "0.5"); the rest is unchanged. Nothing if `text` is not such a literal (inf and
/// nan are not).
std::optional<std::string> canonical_decimal(std::string_view text);

/// The same for CSV and the command line, where TOML's rules do not apply: no underscores.
std::optional<std::string> plain_decimal(std::string_view text);

/// A decimal literal in parts.
struct DecimalParts {
  bool negative = false;
  std::string digits;
  std::int64_t power = 0;  // of ten, of the last digit

  /// The number is 0.d1 d2 d3 ... times 10^exponent.
  std::int64_t exponent() const { return power + std::ssize(digits); }
};
/// With the digits as they are written.
DecimalParts literal_of(std::string_view text);
/// Neither the first digit nor the last one is 0; zero has no digits.
DecimalParts parts_of(std::string_view text);

/// Whether a text has a power of ten, from that of the last digit and the number of digits.
using WithPower = bool (*)(std::int64_t power, std::int64_t digits);
/// Without zeros at the end.
std::string decimal_text(const DecimalParts& number, WithPower with_power);

/// Exact comparison of two canonical decimals.
std::strong_ordering compare_decimals(std::string_view a, std::string_view b);

/// The integer value of a canonical decimal (2e7, 8000.0 too), if it is an integer and fits.
std::optional<std::uint64_t> decimal_integer(std::string_view text);

/// Whether its value is a whole number, of any size and sign.
bool is_whole(std::string_view text);

struct Decimal {
  std::string text = "0";  // canonical
  double value = 0;        // nearest double; 0 or infinity if out of its range: never convert this to wider types

  Decimal() = default;
  /// Takes any literal that has a canonical form; throws std::invalid_argument otherwise.
  explicit Decimal(std::string_view literal);

  // Compares values: 1 and 1.0 are the same number in every working precision.
  friend bool operator==(const Decimal& a, const Decimal& b) { return std::is_eq(compare_decimals(a.text, b.text)); }
  friend std::strong_ordering operator<=>(const Decimal& a, const Decimal& b) {
    return compare_decimals(a.text, b.text);
  }
};

/// a + sign b of canonical decimals, exactly; `sign` is 1 or -1. Nothing if that needs more than 20,000 digits.
std::optional<std::string> exact_sum(std::string_view a, std::string_view b, int sign);

/// a - b of canonical decimals: exactly, or where that needs more than 20,000 digits a number that is rounded to the
/// same one in any working precision.
std::string difference(std::string_view a, std::string_view b);

/// Canonical decimals of many particles, joined in one text, so that 2e7 particles fit in memory. Copies share it until
/// one of them grows.
class DecimalColumn {
 public:
  DecimalColumn() = default;
  DecimalColumn(std::initializer_list<std::string_view> literals) {
    for (const std::string_view literal : literals) push_back(literal);
  }

  void push_back(std::string_view literal);
  std::size_t size() const { return data_ ? data_->ends.size() : 0; }
  bool empty() const { return size() == 0; }
  std::string_view operator[](std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : data_->ends[i - 1];
    return std::string_view(data_->text).substr(begin, data_->ends[i] - begin);
  }
  std::string_view back() const { return (*this)[size() - 1]; }

  // Compares values, like Decimal.
  friend bool operator==(const DecimalColumn& a, const DecimalColumn& b);

 private:
  struct Data {
    std::string text;
    std::vector<std::size_t> ends;
  };
  std::shared_ptr<Data> data_;
};

/// first, first + sign steps[0], first + sign (steps[0] + steps[1]), ..., exactly. Nothing if that needs more than
/// 20,000 digits.
std::optional<DecimalColumn> summed_up(std::string_view first, const DecimalColumn& steps, int sign);

/// Whether sums and differences of these need no thousands of digits. What follows is for such numbers only.
bool of_one_scale(const Decimal& a, const Decimal& b, const Decimal& c);

/// from, from + step and so on up to `until`, exactly, for a step above 0.
DecimalColumn decimals_by_step(const Decimal& from, const Decimal& step, const Decimal& until);

/// from + k (to - from)/parts for k = 0, 1 and so on up to `until`, for to > from. Where that is no finite decimal, it
/// has so many digits that it rounds as the number itself does, to a double and to types of so many decimal digits.
DecimalColumn decimals_by_parts(const Decimal& from, const Decimal& to, std::uint64_t parts, const Decimal& until,
                                std::size_t digits);

/// from + share (to - from), exactly.
Decimal decimal_between(const Decimal& from, const Decimal& to, const Decimal& share);

/// The exact sum of the products of two columns, or of the first column alone if the second is empty. Nothing for more
/// than 1e5 rows or if it needs thousands of digits.
std::optional<std::string> sum_of_products(const DecimalColumn& a, const DecimalColumn& b);

}  // namespace cradle::tools
