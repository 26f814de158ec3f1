#pragma once
// Decimal text of a finite MPFR number.

#include <mpfr.h>

#include <cstddef>
#include <string>

namespace cradle {

// Text with so many significant digits; 0: as many as are needed to read the same number back in the same precision.
inline std::string mpfr_text(mpfr_srcptr x, std::size_t digits) {
  if (mpfr_zero_p(x)) return mpfr_signbit(x) ? "-0" : "0";
  mpfr_exp_t exponent = 0;
  char* raw = mpfr_get_str(nullptr, &exponent, 10, digits, x, MPFR_RNDN);
  std::string text = raw;
  mpfr_free_str(raw);
  const std::string sign = text.front() == '-' ? "-" : "";
  std::string figures = text.substr(sign.size());
  figures.erase(figures.find_last_not_of('0') + 1);
  const auto size = static_cast<mpfr_exp_t>(figures.size());
  // 0.figures 10^exponent
  if (exponent > 0 && exponent <= 21 && exponent >= size)
    return sign + figures + std::string(static_cast<std::size_t>(exponent - size), '0');
  if (exponent > 0 && exponent <= 21) return sign + figures.insert(static_cast<std::size_t>(exponent), ".");
  if (exponent <= 0 && exponent > -5)
    return sign + "0." + std::string(static_cast<std::size_t>(-exponent), '0') + figures;
  if (size > 1) figures.insert(1, ".");
  return sign + figures + "e" + std::to_string(exponent - 1);
}

}  // namespace cradle
