#pragma once
// What is required of a caller's numbers, with messages that say what is wrong (what was found): what to do.

#include <concepts>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

#include "cradle/core/base/real.hpp"

namespace cradle {

// A part of a message: text, or a number. Messages are made only where a condition does not hold, by one function, so
// that a condition costs little code.
struct MessagePart {
  template <class Part> static MessagePart of(const Part& part) {
    if constexpr (std::convertible_to<const Part&, std::string_view>)
      return {.text = part};
    else if constexpr (std::integral<Part>)
      return {.integer = static_cast<long long>(part), .is_integer = true};
    else
      return {.number = to_double(part), .is_number = true};
  }
  std::string_view text = {};
  long long integer = 0;
  double number = 0;
  bool is_integer = false, is_number = false;
};

[[noreturn, gnu::cold, gnu::noinline]] inline void refuse(std::initializer_list<MessagePart> parts) {
  std::string message;
  for (const MessagePart& part : parts) {
    if (part.is_integer)
      message += std::to_string(part.integer);
    else if (part.is_number)
      message += std::to_string(part.number);
    else
      message += part.text;
  }
  throw std::invalid_argument(message);
}

// Throws std::invalid_argument, with a message of these parts, unless the condition holds.
template <class... Parts> void require(bool holds, const Parts&... parts) {
  if (!holds) [[unlikely]]
    refuse({MessagePart::of(parts)...});
}

// Throws std::invalid_argument unless the number is finite; `name` names it in parts, for example "mass ", 3.
template <Real T, class... Name> void require_finite(const T& x, const Name&... name) {
  require(is_finite(x), name..., " is not finite (", x, "): give a number within the range of the scalar type");
}

}  // namespace cradle
