#pragma once
// Boost.Multiprecision's own binary floating point, header only, with 100 decimal digits: the portable alternative to
// MPFR and libquadmath.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdint>
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

template <> struct cradle::SavedNumber<cradle::bin_float> {
  static void save(auto& to, const bin_float& x) {
    const std::string text = Text<bin_float>::to(x);
    const auto size = static_cast<std::uint8_t>(text.size());
    to.put(&size, 1);
    to.put(text.data(), text.size());
  }
  static void load(auto& from, bin_float& x) {
    std::uint8_t size = 0;
    from.get(&size, 1);
    std::string text(size, '\0');
    from.get(text.data(), text.size());
    x = Text<bin_float>::from(text);
  }
};
