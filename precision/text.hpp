#pragma once
// Exact text in and out, one specialisation per scalar type: `from_text` rounds a decimal literal once, to the nearest
// number of the type; `to_text` writes as many digits as it takes to read the same number back.

#include <array>
#include <charconv>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace cradle {

template <class T> struct Text;

namespace detail {

// The standard types: std::from_chars and std::to_chars are exact in both directions and know no locale.
template <class T> struct StandardText {
  // Throws std::invalid_argument for anything but a finite decimal literal. Beyond the type's range: 0 or infinity.
  static T from(std::string_view literal) {
    T value{};
    const std::string_view digits = literal.starts_with('+') ? literal.substr(1) : literal;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
      throw std::invalid_argument("not a number (" + std::string(literal) + "): give a decimal literal");
    if (error == std::errc::result_out_of_range) {
      const auto exponent = digits.find_first_of("eE");
      const bool small = exponent == std::string_view::npos ? digits.find_first_of("123456789") > digits.find('.')
                                                            : digits.substr(exponent + 1).starts_with('-');
      const T size = small ? T(0) : std::numeric_limits<T>::infinity();
      return digits.starts_with('-') ? -size : size;
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

template <class T> T from_text(std::string_view literal) { return Text<T>::from(literal); }
template <class T> std::string to_text(const T& value) { return Text<T>::to(value); }

}  // namespace cradle
