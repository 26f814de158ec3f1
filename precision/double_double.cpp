// Double-double as text. Conversions use a type that holds the sum of any two doubles exactly (from 2^1024 down to
// 2^-1074): each rounds once.
#include "cradle/precision/double_double.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <optional>

#include "cradle/precision/fixed_point.hpp"

namespace cradle {
namespace {

template <unsigned bits>
using Binary =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<bits, boost::multiprecision::digit_base_2>,
                                  boost::multiprecision::et_off>;
using Exact = Binary<2200>;
using Near = Binary<256>;  // holds most sums exactly, and takes a sixth of the time

template <class Number> double_double rounded(const Number& exact) {
  const auto high = static_cast<double>(exact);
  return std::isfinite(high) ? double_double::sum(high, static_cast<double>(Number(exact - high)))
                             : double_double(high);
}
template <class Number> std::string written(const double_double& x, int digits) {
  return Number(Number(x.high()) + x.low()).str(digits);
}

// Whether a decimal that is `off` from high + low is rounded to that, unless this depends on the side.
std::optional<bool> reads_as(double high, double low, double off) {
  if (off == 0) return true;
  if (low == 0) return false;
  const double unit = std::ldexp(1, std::ilogb(low) - 52);
  if (off > 0.51 * unit) return false;
  if (off < 0.24 * unit && high + (low + unit) == high && high + (low - unit) == high) return true;
  return {};
}

// As `written` does: without zeros at the end, with an exponent where there would be more than three after the point.
// Empty where the number does not fit, or half a unit decides. `same`: whether it reads as x, if that is plain.
std::string written_in_fixed_point(const double_double& x, int digits, std::optional<bool>& same) {
  const double low = x.high() < 0 ? -x.low() : x.low(), high = std::abs(x.high());
  auto exact = FixedPoint::sum({high, low});
  auto leading = exact ? exact->take_leading(static_cast<std::size_t>(digits)) : std::nullopt;
  if (!leading) return {};
  auto& [text, exponent] = *leading;
  const double behind = exact->nearest();
  if (behind == 0.5) return {};
  if (behind > 0.5) {
    const auto last = text.find_last_not_of('9');
    if (last == text.npos) return {};
    ++text[last];
    text.resize(last + 1);
    exact->add(-1);
  }
  if (exponent - digits > -250)  // far from what underflows
    same = reads_as(high, low, std::abs(exact->nearest()) * std::pow(10., exponent - digits + 1));
  text.resize(text.find_last_not_of('0') + 1);
  const std::string sign = x.high() < 0 ? "-" : "";
  if (exponent < -4) {
    const std::string power = std::to_string(-exponent);
    if (text.size() > 1) text.insert(1, ".");
    return sign + text + (power.size() < 2 ? "e-0" : "e-") + power;
  }
  if (exponent < 0) return sign + "0." + std::string(static_cast<std::size_t>(-exponent) - 1, '0') + text;
  const auto whole = static_cast<std::size_t>(exponent) + 1;
  if (text.size() > whole) return sign + text.insert(whole, ".");
  return sign + text + std::string(whole - text.size(), '0');
}

// The number of a decimal, if both ends of what fixed point leaves open round to it: rounding is monotonic.
std::optional<double_double> in_fixed_point(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  bool is_exact = false;
  auto number = FixedPoint::decimal(text, is_exact);
  if (!number) return {};
  if (is_exact && number->is_zero()) return double_double(0);
  const auto rounded = [sign = negative ? -1. : 1.](FixedPoint exact) {
    const double high = exact.nearest();
    return exact.add(-high) ? std::optional(double_double::sum(sign * high, sign * exact.nearest())) : std::nullopt;
  };
  const auto x = rounded(*number);
  if (!is_exact) {
    number->add_units(2);
    if (rounded(*number) != x) return {};
  }
  return x;
}

bool near(const double_double& x) { return x.low() == 0 || std::ilogb(x.high()) - std::ilogb(x.low()) < 150; }

// The number of a decimal, if Near decides it. Rounding is monotonic: if both ends of the error interval of Near
// round to one number, so does the decimal between them.
std::optional<double_double> by_near(const std::string& text) {
  const Near middle(text), off = ldexp(Near(abs(middle)), -240);
  const double_double one_end = rounded(Near(middle - off)), other = rounded(Near(middle + off));
  return one_end == other ? std::optional(one_end) : std::nullopt;
}

}  // namespace

double_double Text<double_double>::from(std::string_view literal) {
  const std::string text = checked_literal(literal);
  if (const auto x = in_fixed_point(text)) return *x;
  const auto quick = by_near(text);
  return quick ? *quick : rounded(Exact(text));
}

std::string Text<double_double>::to(const double_double& x) {
  // High and low may differ greatly in size: add digits until the text is exact.
  for (int digits = 32;; digits += 8) {
    std::optional<bool> same;
    std::string text = written_in_fixed_point(x, digits, same);
    if (text.empty()) text = near(x) ? written<Near>(x, digits) : written<Exact>(x, digits);
    if (digits > 700 || (same ? *same : from(text) == x)) return text;
  }
}

}  // namespace cradle
