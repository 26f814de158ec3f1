#pragma once
// Balls as readable intervals: decimals and doubles, rounded outwards, so that they contain the ball.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "cradle/precision/ball.hpp"

namespace cradle {

template <class Number> struct Enclosure { Number low, high; };

namespace detail {

Enclosure<std::string> decimals(const double_double& middle, double radius, int digits);

// One of these ends, a sum of doubles, in fixed point, which takes far less time. There is none where the sum does not
// fit or is a decimal, and next to a power of ten.
std::optional<std::string> quick_decimal_beside(const std::array<double, 3>& sum, int digits, bool below);

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

// Both ends, with two digits more than are known: these are log10 of the ratio of size to radius.
template <class M> Enclosure<std::string> in_decimals(const Ball<M>& x) {
  if (!is_finite(x)) return {"-inf", "inf"};
  const auto size = static_cast<long double>(Midpoint<M>::size(x.middle()));
  const long double known = x.radius() > 0 && size > 0 ? std::log10(size / x.radius()) : size > 0 ? 40 : 0;
  return detail::decimals(x.middle(), x.radius(), static_cast<int>(std::max(known, 0.L)) + 3);
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
