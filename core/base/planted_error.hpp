#pragma once
// Errors that tests plant, to see that they are found: a program that is compiled with CRADLE_PLANTED_ERRORS has the
// one whose number is in the environment, all others have none.

#ifdef CRADLE_PLANTED_ERRORS
#include <cstdlib>
#endif

namespace cradle {

#ifdef CRADLE_PLANTED_ERRORS
inline namespace with_errors {  // a name of its own, for programs that also link what has none
inline bool planted(int error) {
  static const char* const number = std::getenv("CRADLE_PLANTED_ERROR");
  static const int chosen = number != nullptr ? std::atoi(number) : 0;
  return error == chosen;
}
}  // namespace with_errors
#else
constexpr bool planted(int) { return false; }
#endif

}  // namespace cradle
