#pragma once
// Exact conversion from and to text, one specialisation per scalar type. `from_text` rounds a decimal literal once, to
// the nearest number of the type; it refuses inf and nan. `to_text` writes the digits needed to read the same number
// back, or inf, -inf, nan.

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace cradle {

template <class T> struct Text;
template <class T> struct SavedNumber;  // exactly, as bytes (core/base/state.hpp)

// The type's name in scenes.
template <class T> inline constexpr std::string_view scalar_name = "";
template <> inline constexpr std::string_view scalar_name<double> = "double";
template <> inline constexpr std::string_view scalar_name<long double> = "long double";
std::string scalar_names();  // of all types in this build, separated by commas

// Returns the literal if it is a finite decimal one (1, -0.5, 2e-400); throws std::invalid_argument otherwise. It is
// called before libraries that accept more than that.
inline std::string checked_literal(std::string_view literal) {
  const auto fail = [&] {
    throw std::invalid_argument("not a number (" + std::string(literal) + "): give a decimal literal");
  };
  std::size_t at = 0, digits = 0;
  const auto skip_digits = [&] {
    for (; at < literal.size() && literal[at] >= '0' && literal[at] <= '9'; ++at) ++digits;
  };
  const auto skip_sign = [&] { at += at < literal.size() && (literal[at] == '+' || literal[at] == '-'); };
  skip_sign();
  skip_digits();
  if (at < literal.size() && literal[at] == '.') ++at, skip_digits();
  if (digits == 0) fail();
  if (at < literal.size() && (literal[at] == 'e' || literal[at] == 'E')) {
    ++at, skip_sign();
    digits = 0;
    skip_digits();
    if (digits == 0) fail();
  }
  if (at != literal.size()) fail();
  return std::string(literal);
}

namespace detail {

// The standard types: std::from_chars and std::to_chars are exact in both directions and ignore locales.
template <class T> struct StandardText {
  // Throws std::invalid_argument for anything but a finite decimal literal. Beyond the type's range it gives 0 or
  // infinity.
  static T from(std::string_view literal) {
    T value{};
    const std::string text = checked_literal(literal);
    const std::string_view digits = text.starts_with('+') ? std::string_view(text).substr(1) : std::string_view(text);
    const auto error = std::from_chars(digits.data(), digits.data() + digits.size(), value).ec;
    if (error == std::errc::result_out_of_range) {
      // Too large, too small, or (long double in libstdc++) merely subnormal: a stream distinguishes these.
      std::istringstream stream(text);
      stream.imbue(std::locale::classic());
      if (!(stream >> value)) value = std::copysign(std::numeric_limits<T>::infinity(), value);
    }
    return value;
  }

  static std::string to(T value) {
    std::array<char, 64> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return error == std::errc() ? std::string(buffer.data(), end) : std::string();
  }
};

}  // namespace detail

template <> struct Text<double> : detail::StandardText<double> {};
template <> struct Text<long double> : detail::StandardText<long double> {};

// For types whose bits are not at hand: as the text that gives the same number.
template <class T> struct SavedAsText {
  static void save(auto& to, const T& x) {
    const std::string text = Text<T>::to(x);
    const auto size = static_cast<std::uint8_t>(text.size());
    to.put(&size, 1);
    to.put(text.data(), text.size());
  }
  static void load(auto& from, T& x) {
    std::uint8_t size = 0;
    from.get(&size, 1);
    std::string text(size, '\0');
    from.get(text.data(), text.size());
    x = Text<T>::from(text);
  }
};

template <class T> T from_text(std::string_view literal) { return Text<T>::from(literal); }
template <class T> std::string to_text(const T& value) {
  if (value > std::numeric_limits<T>::max()) return "inf";
  if (value < std::numeric_limits<T>::lowest()) return "-inf";
  return value == value ? Text<T>::to(value) : "nan";
}

}  // namespace cradle
