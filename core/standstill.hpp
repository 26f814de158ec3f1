#pragma once
// Whether time goes on. Many bodies may meet at one time and place, n(n - 1)/2 contacts if they are elastic. Where more
// follow each other without any time passing, the scalar type cannot tell their times apart, or they have no end.

#include <cstdint>
#include <tuple>

#include "cradle/core/real.hpp"

namespace cradle {

template <Real T> struct Standstill {
  explicit Standstill(const T& start, std::uint64_t contacts = 0) : time(start), contacts_then(contacts) {}

  T time;                       // local, at the last review
  std::uint64_t contacts_then;  // made when time was last seen to go on
  static auto state(auto& self) { return std::tie(self.time, self.contacts_then); }

  // At a review: local time now, contacts made, bodies active.
  bool at(const T& now, std::uint64_t contacts, std::uint64_t active) {
    if (now > time) contacts_then = contacts;
    return contacts - contacts_then > 64 + 4 * active * active;
  }
};

}  // namespace cradle
