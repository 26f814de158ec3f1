#pragma once
// std::from_chars for double and long double on every platform. Libraries without it (libc++) read through a stream
// with the classic locale: that is exact too, but slower, and numbers too small for the type become 0 without an error.

#include <charconv>
#include <cstddef>
#include <locale>
#include <sstream>
#include <string>
#include <system_error>

namespace cradle {

template <class T> std::from_chars_result read_by_stream(const char* from, const char* to, T& value) {
  std::istringstream stream(std::string(from, to));
  stream.imbue(std::locale::classic());
  T read{};
  const bool good = static_cast<bool>(stream >> read);
  if (!good && read == T(0)) return {from, std::errc::invalid_argument};
  const bool all = stream.eof();
  stream.clear();  // a stream in a failed state has no position
  const char* const end = all ? to : from + static_cast<std::ptrdiff_t>(stream.tellg());
  if (!good) return {end, std::errc::result_out_of_range};
  value = read;
  return {end, std::errc()};
}

template <class T> std::from_chars_result read_number(const char* from, const char* to, T& value) {
#ifdef __cpp_lib_to_chars
  return std::from_chars(from, to, value);
#else
  return read_by_stream(from, to, value);
#endif
}

}  // namespace cradle
