#pragma once
// Balls as readable intervals: decimals and doubles, rounded outwards, so that they contain the ball.

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ios>
#include <limits>
#include <optional>
#include <string>

#include "cradle/precision/ball.hpp"

namespace cradle {

template <class Number> struct Enclosure { Number low, high; };

namespace detail {

// Wide enough for the sum of any two doubles and a radius.
using Wide =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<3300, boost::multiprecision::digit_base_2>,
                                  boost::multiprecision::et_off>;

// A decimal with so many digits on one side of x: the nearest one or the one after it.
inline std::string decimal_beside(const Wide& x, int digits, bool below) {
  const auto text = [&](const Wide& number) { return number.str(digits - 1, std::ios_base::scientific); };
  std::string nearest = text(x);
  if (x == 0) return nearest;
  const Wide read(nearest);
  if (below ? read < x : read > x) return nearest;
  const Wide unit = pow(Wide(10), std::stoi(nearest.substr(nearest.find('e') + 1)) - digits + 1);
  return text(below ? Wide(x - unit) : Wide(x + unit));
}

// The same decimal of a sum of doubles, in integers, which takes a fiftieth of the time. There is none where that would
// need too many bits, where the sum is a decimal or in the middle between two, and next to a power of ten.
inline std::optional<std::string> quick_decimal_beside(const std::array<double, 3>& sum, int digits, bool below) {
  namespace mp = boost::multiprecision;
  using Integer = mp::number<mp::cpp_int_backend<640, 640, mp::signed_magnitude, mp::unchecked, void>, mp::et_off>;
  constexpr int most_bits = 200, most_power = 60;  // 10^60 has 200 bits
  int least = std::numeric_limits<int>::max(), most = std::numeric_limits<int>::min();
  for (const double x : sum)
    if (x != 0) least = std::min(least, std::ilogb(x) - 52), most = std::max(most, std::ilogb(x) + 2);
  if (least > most || most - least > most_bits || std::abs(least) > most_bits || digits > most_power) return {};
  Integer units = 0;  // of 2^least
  for (const double x : sum)
    if (x != 0)
      units += Integer(static_cast<std::int64_t>(std::ldexp(x, 52 - std::ilogb(x)))) << (std::ilogb(x) - 52 - least);
  if (units == 0) return {};
  const bool negative = units < 0, up = below == negative;
  if (negative) units = -units;
  const auto ten_to = [](int power) { return Integer(pow(Integer(10), static_cast<unsigned>(std::max(power, 0)))); };
  const Integer first = ten_to(digits - 1), end = first * 10;
  // From the true exponent, or one less.
  for (int exponent = static_cast<int>(std::floor((static_cast<double>(msb(units)) + least) * std::log10(2.)));;
       ++exponent) {
    const int power = digits - 1 - exponent;
    if (std::abs(power) > most_power) return {};
    const Integer over = (units * ten_to(power)) << std::max(least, 0), under = ten_to(-power) << std::max(-least, 0);
    Integer whole, rest;
    divide_qr(over, under, whole, rest);
    if (whole >= end) continue;
    if (rest == 0 || rest * 2 == under || whole <= first || whole + 1 == end) return {};
    const std::string text = Integer(up ? Integer(whole + 1) : whole).str();
    char power_of_ten[16];
    std::snprintf(power_of_ten, sizeof power_of_ten, "e%+03d", exponent);
    return (negative ? "-" : "") + text.substr(0, 1) + '.' + text.substr(1) + power_of_ten;
  }
}

inline Enclosure<std::string> decimals(const double_double& middle, double radius, int digits) {
  const auto end = [&](double by, bool below) {
    if (auto quick = quick_decimal_beside({middle.high(), middle.low(), by}, digits, below)) return *quick;
    return decimal_beside(Wide(middle.high()) + middle.low() + by, digits, below);
  };
  return {end(-radius, true), end(radius, false)};
}

#ifdef CRADLE_WITH_MPFR
template <int Limbs> Enclosure<std::string> decimals(const Mpfr<Limbs>& middle, long double radius, int digits) {
  const auto text = [&](mpfr_rnd_t rounding) {
    mpfr_t end, off;
    mpfr_inits2(mpfr_get_prec(middle.get()) + 64, end, off, static_cast<mpfr_ptr>(nullptr));
    mpfr_set_ld(off, rounding == MPFR_RNDD ? -radius : radius, rounding);
    mpfr_add(end, middle.get(), off, rounding);
    char* written = nullptr;
    mpfr_asprintf(&written, rounding == MPFR_RNDD ? "%.*RDe" : "%.*RUe", digits - 1, end);
    std::string result(written);
    mpfr_free_str(written);
    mpfr_clears(end, off, static_cast<mpfr_ptr>(nullptr));
    return result;
  };
  return {text(MPFR_RNDD), text(MPFR_RNDU)};
}
#endif

}  // namespace detail

// The number of decimal digits that are known: log10 of the ratio of size to radius; 0 if nothing is known.
template <class M> int digits_known(const Ball<M>& x) {
  if (!is_finite(x)) return 0;
  const auto size = static_cast<long double>(Midpoint<M>::size(x.middle()));
  const long double digits = x.radius() > 0 && size > 0 ? std::log10(size / x.radius()) : size > 0 ? 40 : 0;
  return digits > 0 ? static_cast<int>(digits) : 0;
}

// Both ends, with two digits more than are known.
template <class M> Enclosure<std::string> in_decimals(const Ball<M>& x) {
  if (!is_finite(x)) return {"-inf", "inf"};
  return detail::decimals(x.middle(), x.radius(), digits_known(x) + 3);
}

// The nearest doubles on either side; infinite if there are none.
template <class M> Enclosure<double> in_doubles(const Ball<M>& x) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (!is_finite(x)) return {-none, none};
  Enclosure<double> ends{to_double(x.middle()), to_double(x.middle())};
  const auto radius = static_cast<double>(x.radius());
  ends.low -= radius, ends.high += radius;
  // Near 0 doubles are denser than balls resolve: the steps double, so that few suffice.
  constexpr double least = std::numeric_limits<double>::denorm_min();
  for (double by = least; ends.low > -none && !(Ball<M>(ends.low) < x); by += by)
    ends.low = std::nextafter(ends.low - by, -none);
  for (double by = least; ends.high < none && !(x < Ball<M>(ends.high)); by += by)
    ends.high = std::nextafter(ends.high + by, none);
  return ends;
}

}  // namespace cradle
