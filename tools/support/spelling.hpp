// The known word that somebody may have meant.
#pragma once

#include <cstddef>
#include <string_view>

namespace cradle::tools {

/// Number of letters to insert, delete, change or swap with a neighbour to get from one word to the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Two words that differ in more letters than this are not similar.
inline std::size_t alike(std::string_view word) { return word.size() < 5 ? 1 : word.size() < 12 ? 2 : word.size() / 4; }

/// The most similar word, the first of several; empty if none is similar.
template <class Words> std::string_view nearest_word(std::string_view word, const Words& known) {
  std::string_view nearest;
  std::size_t least = alike(word) + 1;
  for (const std::string_view candidate : known)
    if (const std::size_t distance = edit_distance(word, candidate); distance < least) {
      least = distance;
      nearest = candidate;
    }
  return nearest;
}

}  // namespace cradle::tools
