#pragma once
// Boost.Multiprecision's own binary floating point, header only, with 100 decimal digits: the portable alternative to
// MPFR and libquadmath.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <limits>
#include <string>
#include <string_view>

#include "cradle/precision/text.hpp"

namespace cradle {

using bin_float = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_100::backend_type,
                                                boost::multiprecision::et_off>;

}  // namespace cradle

template <> inline constexpr std::string_view cradle::scalar_name<cradle::bin_float> = "cpp_bin_float";

template <> struct cradle::Text<cradle::bin_float> {
  static bin_float from(std::string_view literal) { return bin_float(checked_literal(literal)); }
  static std::string to(const bin_float& x) { return x.str(std::numeric_limits<bin_float>::max_digits10); }
};

template <> struct cradle::SavedNumber<cradle::bin_float> : cradle::SavedAsText<cradle::bin_float> {};
