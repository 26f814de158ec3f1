#pragma once
// What is required of a caller's numbers, with messages that say what is wrong (what was found): what to do.

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "cradle/core/base/real.hpp"

namespace cradle {

// A part of a message: text, or a number.
using MessagePart = std::variant<std::string_view, std::int64_t, std::uint64_t, double>;
template <class Part> MessagePart message_part(const Part& part) {
  if constexpr (std::convertible_to<const Part&, std::string_view>)
    return std::string_view(part);
  else if constexpr (std::signed_integral<Part>)
    return std::int64_t{part};
  else if constexpr (std::unsigned_integral<Part>)
    return std::uint64_t{part};
  else
    return to_double(part);
}

// Throws std::invalid_argument with a message of these parts. All conditions share it, so that each costs little code.
[[noreturn, gnu::cold, gnu::noinline]] inline void refuse(std::initializer_list<MessagePart> parts) {
  std::string message;
  const auto append = [&]<class Part>(const Part& part) {
    if constexpr (std::same_as<Part, std::string_view>)
      message += part;
    else
      message += std::to_string(part);
  };
  for (const MessagePart& part : parts) std::visit(append, part);
  throw std::invalid_argument(message);
}

// Throws std::invalid_argument, with a message of these parts, unless the condition holds.
template <class... Parts> void require(bool holds, const Parts&... parts) {
  if (!holds) [[unlikely]]
    refuse({message_part(parts)...});
}

// Throws std::invalid_argument unless the number is finite; `name` names it in parts, for example "mass ", 3.
template <Real T, class... Name> void require_finite(const T& x, const Name&... name) {
  require(is_finite(x), name..., " is not finite (", x, "): give a number within the range of the scalar type");
}

}  // namespace cradle
