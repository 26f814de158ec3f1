#pragma once
// Binary fixed point with 64 bits before the point and 384 behind it: sums of doubles, exactly, and their decimals, in
// a tenth of the time that binary floating point of such a width takes. A number that does not fit is refused.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace cradle {

class FixedPoint {
 public:
  static std::optional<FixedPoint> sum(std::initializer_list<double> doubles) {
    FixedPoint total;
    for (const double x : doubles)
      if (!total.add(x)) return {};
    return total;
  }
  /// The number of a literal: digits with at most one point, and perhaps an exponent. Rounded downwards by less than 2
  /// units of 2^-384 if it is not `exact`.
  static std::optional<FixedPoint> decimal(std::string_view literal, bool& exact) {
    int power = 0;
    if (const auto e = literal.find_first_of("eE"); e != literal.npos) {
      const char* const first = literal.data() + e + 1 + (literal[e + 1] == '+');
      if (std::from_chars(first, literal.data() + literal.size(), power).ec != std::errc()) return {};
      literal = literal.substr(0, e);
    }
    const std::size_t point = std::min(literal.find('.'), literal.size());
    std::string digits(literal.substr(0, point));
    if (point < literal.size()) digits += literal.substr(point + 1);
    // The number is 0.d1d2... times ten to `before`, d1 not 0.
    const std::size_t zeros = std::min(digits.find_first_not_of('0'), digits.size());
    digits.erase(0, zeros);
    const std::int64_t before = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(zeros) + power;
    if (before > chunk || before < -static_cast<std::int64_t>(most_digits) || digits.size() > most_digits) return {};
    const auto whole = static_cast<std::size_t>(std::max<std::int64_t>(before, 0));
    digits.insert(0, whole - static_cast<std::size_t>(before), '0');
    digits.resize(std::max(digits.size(), whole), '0');
    FixedPoint number;
    exact = true;
    for (std::size_t end = digits.size(); end > whole;) {
      const std::size_t from = std::max(whole, end - std::min<std::size_t>(end, chunk));
      number.limbs_[limbs - 1] = integer(std::string_view(digits).substr(from, end - from));
      exact &= number.divide(ten_to(end - from)) == 0;
      end = from;
    }
    number.limbs_[limbs - 1] = integer(std::string_view(digits).substr(0, whole));
    return number;
  }

  bool is_zero() const { return limbs_ == Limbs{}; }
  bool is_negative() const { return limbs_[limbs - 1] >> 63; }
  FixedPoint operator-() const {
    FixedPoint x;
    unsigned carry = 1;
    for (std::size_t i = 0; i < limbs; ++i) carry = (x.limbs_[i] = ~limbs_[i] + carry) == 0 && carry;
    return x;
  }
  /// False if x does not fit.
  bool add(double x) {
    if (x == 0) return true;
    if (!(std::abs(x) < 0x1p61)) return false;
    const int exponent = std::ilogb(x) - 52, shift = exponent + fraction_bits;
    if (shift < 0) return false;
    add(static_cast<std::uint64_t>(std::ldexp(std::abs(x), -exponent)), static_cast<unsigned>(shift), x < 0);
    return true;
  }
  void add_units(std::uint64_t units) { add(units, 0, false); }
  /// Rounded to nearest, ties to even.
  double nearest() const {
    if (is_negative()) return -(-*this).nearest();
    std::size_t top = limbs;
    while (top > 0 && limbs_[top - 1] == 0) --top;
    if (top == 0) return 0;
    const auto bits = static_cast<unsigned>(top * 64) - static_cast<unsigned>(std::countl_zero(limbs_[top - 1]));
    const unsigned shift = bits > 64 ? bits - 64 : 0, limb = shift / 64, within = shift % 64;
    // 64 bits, the last of them 1 if there is anything behind: so the processor rounds them as it would round all.
    std::uint64_t leading = limbs_[limb] >> within;
    if (within != 0 && limb + 1 < limbs) leading |= limbs_[limb + 1] << (64 - within);
    bool more = (limbs_[limb] & ((std::uint64_t{1} << within) - 1)) != 0;
    for (std::size_t i = 0; i < limb; ++i) more |= limbs_[i] != 0;
    return std::ldexp(static_cast<double>(leading | more), static_cast<int>(shift) - fraction_bits);
  }

  struct Digits {
    std::string digits;
    int exponent;  // of ten, of the first one
  };
  /// Takes `count` leading digits out of a number that is not negative; what is left is a fraction of the last of them.
  std::optional<Digits> take_leading(std::size_t count) {
    Digits all{};
    std::uint64_t& whole = limbs_[limbs - 1];
    if (whole != 0) all.digits = std::to_string(whole);
    if (all.digits.size() > count || is_zero()) return {};
    all.exponent = static_cast<int>(all.digits.size()) - 1;
    while (all.digits.size() < count) {
      const std::size_t size = std::min<std::size_t>(chunk, count - all.digits.size());
      whole = 0;
      multiply(ten_to(size));
      std::string more = std::to_string(whole);
      if (!all.digits.empty()) {
        more.insert(0, size - more.size(), '0');
      } else if (whole == 0) {
        all.exponent -= static_cast<int>(size);
        continue;
      } else {
        all.exponent -= static_cast<int>(size - more.size());
      }
      all.digits += more;
    }
    whole = 0;
    return all;
  }

 private:
  static constexpr std::size_t limbs = 7, most_digits = 120;
  static constexpr int fraction_bits = 384, chunk = 18;  // chunk: digits at once
  using Limbs = std::array<std::uint64_t, limbs>;
  __extension__ using Wide = unsigned __int128;

  static std::uint64_t integer(std::string_view digits) {
    std::uint64_t number = 0;
    for (const char digit : digits) number = number * 10 + static_cast<std::uint64_t>(digit - '0');
    return number;
  }
  static std::uint64_t ten_to(std::size_t power) {
    std::uint64_t number = 1;
    while (power-- > 0) number *= 10;
    return number;
  }
  // Adds a number of at most 64 bits, shifted to the left, or its negative.
  void add(std::uint64_t number, unsigned shift, bool negative) {
    const std::size_t limb = shift / 64;
    const Wide shifted = static_cast<Wide>(number) << shift % 64;
    Wide carry = negative;
    for (std::size_t i = 0; i < limbs; ++i) {
      std::uint64_t part = i == limb       ? static_cast<std::uint64_t>(shifted)
                           : i == limb + 1 ? static_cast<std::uint64_t>(shifted >> 64)
                                           : 0;
      if (negative) part = ~part;
      carry += static_cast<Wide>(limbs_[i]) + part;
      limbs_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
  }
  void multiply(std::uint64_t by) {
    Wide carry = 0;
    for (std::uint64_t& limb : limbs_) {
      carry += static_cast<Wide>(limb) * by;
      limb = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
  }
  // Returns the remainder.
  std::uint64_t divide(std::uint64_t by) {
    Wide rest = 0;
    for (std::size_t i = limbs; i-- > 0;) {
      rest = rest << 64 | limbs_[i];
      limbs_[i] = static_cast<std::uint64_t>(rest / by);
      rest %= by;
    }
    return static_cast<std::uint64_t>(rest);
  }

  Limbs limbs_{};  // the least first; two's complement
};

}  // namespace cradle
