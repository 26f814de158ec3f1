#pragma once
// What is required of a caller's numbers, with messages that say what is wrong (what was found): what to do.

#include <concepts>
#include <stdexcept>
#include <string>

#include "cradle/core/base/real.hpp"

namespace cradle {

// A part of a message: text, or a number.
template <class Part> std::string in_message(const Part& part) {
  if constexpr (std::convertible_to<const Part&, std::string>)
    return part;
  else if constexpr (std::integral<Part>)
    return std::to_string(part);
  else
    return std::to_string(to_double(part));
}

// Throws std::invalid_argument, with a message of these parts, unless the condition holds.
template <class... Parts> void require(bool holds, const Parts&... parts) {
  if (!holds) [[unlikely]]
    throw std::invalid_argument((std::string() + ... + in_message(parts)));
}

// Throws std::invalid_argument unless the number is finite; `name` names it in parts, for example "mass ", 3.
template <Real T, class... Name> void require_finite(const T& x, const Name&... name) {
  require(is_finite(x), name..., " is not finite (", x, "): give a number within the range of the scalar type");
}

}  // namespace cradle
