#pragma once
// Words: the order in which the gaps of a few particles close, over and over. A letter is a gap, counted from the left:
// `ab` says that the first and the second gap of three particles close in turn, for ever.
//
// Two letters *touch* if their gaps share a particle or are the same. Collisions of letters that do not touch commute,
// so their order in a word means nothing (a trace, in the words of Cartier and Foata, 1969), and neither does the
// letter with which a period begins. With equal masses a word and its mirror image are the same motion.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"

namespace cradle::words {

using Word = std::vector<std::size_t>;  // gaps, from 0

inline bool touch(std::size_t a, std::size_t b) { return a <= b + 1 && b <= a + 1; }

inline std::string text_of(const Word& word) {
  std::string text;
  for (const std::size_t letter : word) text += static_cast<char>('a' + letter);
  return text;
}

// Thrown for words that no particles can repeat: what is wrong, what was found, what to do.
struct BadWord : std::invalid_argument {
  BadWord(const std::string& wrong_, std::string found_, std::string advice_)
      : std::invalid_argument(wrong_), found(std::move(found_)), advice(std::move(advice_)) {}
  std::string found, advice;
};

// The letters of `word` that are `low` or `low` + 1, as places in it.
inline std::vector<std::size_t> places_of(const Word& word, std::size_t low) {
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < word.size(); ++k)
    if (word[k] == low || word[k] == low + 1) places.push_back(k);
  return places;
}

// Whether a trace is another one, repeated: then the restrictions to any two touching letters are, equally often.
inline bool is_repetition(const Word& word, std::size_t gaps) {
  for (std::size_t times = 2; times <= word.size(); ++times) {
    bool all = true;
    for (std::size_t low = 0; low + 1 < gaps && all; ++low) {
      const auto places = places_of(word, low);
      all = places.size() % times == 0;
      const std::size_t period = places.size() / times;
      for (std::size_t k = period; k < places.size() && all; ++k) all = word[places[k]] == word[places[k - period]];
    }
    if (all) return true;
  }
  return false;
}

// The place of a letter that follows one of the same gap with no touching one between, and so cannot close again; the
// length of the word if there is none.
inline std::size_t place_twice_running(const Word& word) {
  for (std::size_t k = 0; k < word.size(); ++k) {
    for (std::size_t step = 1; step <= word.size(); ++step) {
      const std::size_t next = (k + step) % word.size();
      if (word[next] == word[k]) return next;
      if (touch(word[next], word[k])) break;
    }
  }
  return word.size();
}

// Throws BadWord if no particles with so many gaps can repeat the word.
inline void require_word(const Word& word, std::size_t gaps) {
  const std::string text = text_of(word), last(1, static_cast<char>('a' + gaps - 1));
  for (std::size_t letter = 0; letter < gaps; ++letter)
    if (std::find(word.begin(), word.end(), letter) == word.end())
      throw BadWord(std::string("gap ") + static_cast<char>('a' + letter) + " never closes", text,
                    "use every letter from a to " + last + ", or fewer particles");
  if (const std::size_t place = place_twice_running(word); place < word.size())
    throw BadWord(std::string("gap ") + static_cast<char>('a' + word[place]) +
                      " closes twice running, but particles that have collided part until a neighbour is hit",
                  text,
                  "put a letter beside it in the alphabet between the two (the word repeats: its end meets its "
                  "beginning)");
  if (is_repetition(word, gaps))
    throw BadWord("a word that repeats a shorter one", text, "give the shorter one: it is repeated anyway");
}

// Reads letters; `gaps` is how many there are. Throws BadWord.
inline Word read_word(std::string_view text, std::size_t gaps) {
  const std::string last(1, static_cast<char>('a' + gaps - 1));
  Word word;
  for (const char c : text) {
    if (c < 'a' || static_cast<std::size_t>(c - 'a') >= gaps)
      throw BadWord("a letter that is no gap", std::string(1, c) + " in " + std::string(text),
                    "use the letters a to " + last + ", which are the gaps from the left");
    word.push_back(static_cast<std::size_t>(c - 'a'));
  }
  if (word.empty()) throw BadWord("no letters", "an empty word", "use the letters a to " + last);
  require_word(word, gaps);
  return word;
}

inline Word mirrored(Word word, std::size_t gaps) {
  for (std::size_t& letter : word) letter = gaps - 1 - letter;
  return word;
}

// The places of letters that can stand first: they touch none before them.
inline std::vector<std::size_t> first_places(const Word& word) {
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < word.size(); ++k)
    if (std::none_of(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(k),
                     [&](std::size_t before) { return touch(before, word[k]); }))
      places.push_back(k);
  return places;
}

// Of all words of the same trace the first in the alphabet.
inline Word sorted(Word word) {
  Word result;
  while (!word.empty()) {
    std::size_t least = 0;
    for (const std::size_t place : first_places(word))
      if (word[place] < word[least]) least = place;
    result.push_back(word[least]);
    word.erase(word.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return result;
}

// All sorted words of the same motion, wherever a period of it begins.
inline std::set<Word> same_motion(const Word& word) {
  std::set<Word> found{sorted(word)};
  std::vector<Word> open{*found.begin()};
  while (!open.empty()) {
    const Word next = std::move(open.back());
    open.pop_back();
    for (const std::size_t place : first_places(next)) {
      Word moved = next;
      moved.erase(moved.begin() + static_cast<std::ptrdiff_t>(place));
      moved.push_back(next[place]);
      moved = sorted(std::move(moved));
      if (found.insert(moved).second) open.push_back(std::move(moved));
    }
  }
  return found;
}

inline Word rotated(Word word, std::size_t by) {
  std::rotate(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(by), word.end());
  return word;
}

// Whether the second half of a word is the mirror image of the first.
inline bool has_mirrored_half(const Word& word, std::size_t gaps) {
  return word.size() % 2 == 0 && rotated(mirrored(word, gaps), word.size() / 2) == word;
}

// Calls f with one word of every motion of up to `longest` letters that particles with so many gaps might repeat; with
// `mirror`, mirror images are the same.
template <class F> void for_each_word(std::size_t gaps, std::size_t longest, bool mirror, F f) {
  std::set<Word> seen;
  for (std::size_t length = 2; length <= longest; ++length) {
    seen.clear();
    Word word(length, 0);  // a period can begin with any letter, so with a
    const auto extend = [&](auto&& self, std::size_t at) -> void {
      if (at == length) {
        try {
          require_word(word, gaps);
        } catch (const BadWord&) {
          return;
        }
        if (sorted(word) != word || seen.contains(word)) return;
        seen.merge(same_motion(word));
        if (mirror) seen.merge(same_motion(mirrored(word, gaps)));
        f(word);
        return;
      }
      for (std::size_t letter = 0; letter < gaps; ++letter) {
        // Neither twice running nor, in the sorted word, behind a later letter with which it commutes.
        if (letter == word[at - 1] || (letter < word[at - 1] && !touch(letter, word[at - 1]))) continue;
        word[at] = letter;
        self(self, at + 1);
      }
    };
    extend(extend, 1);
  }
}

// `Followed` finds how far a sequence of collisions follows a word, repeated for ever. Collisions of gaps that do not
// touch commute, so a place in the word is a set of letters made, closed under what must come before: for each two
// touching gaps, how many of their letters. A sequence may begin at any place; all that fit so far are kept.
class Followed {
 public:
  Followed(Word word, std::size_t gaps) : word_(std::move(word)), gaps_(gaps) {
    // Every place is reached from the beginning, by letters in the word's order.
    std::vector<Place> reached{Place(gaps - 1, 0)};
    std::map<Place, std::uint64_t> number{{reached.front(), 0}};
    for (std::size_t from = 0; from < reached.size(); ++from) {
      next_.emplace_back(gaps, nowhere);
      for (std::size_t letter = 0; letter < gaps; ++letter) {
        const auto to = after(reached[from], letter);
        if (!to) continue;
        const auto [found, added] = number.emplace(*to, reached.size());
        if (added) reached.push_back(*to);
        next_[from][letter] = found->second;
      }
    }
    for (std::uint64_t place = 0; place < next_.size(); ++place) open_.push_back(place);
  }

  void add(std::size_t letter) {
    std::vector<std::uint64_t> still_open;
    for (const std::uint64_t place : open_)
      if (next_[place][letter] != nowhere) still_open.push_back(next_[place][letter]);
    open_ = std::move(still_open);
    kept_ += follows();
  }

  bool follows() const { return !open_.empty(); }
  std::uint64_t kept() const { return kept_; }  // letters before the first that is not the word's
  std::uint64_t periods() const { return kept_ / word_.size(); }

  static auto state(auto& self) { return fields(self.open_, self.kept_); }
  void loaded() const {
    for (const std::uint64_t place : open_) require_state(place < next_.size(), "a place in a word");
  }

 private:
  // For gaps k and k + 1, how many of their letters are made since the period began.
  using Place = std::vector<std::size_t>;
  static constexpr std::uint64_t nowhere = ~std::uint64_t{0};

  std::optional<Place> after(Place place, std::size_t letter) const {
    for (std::size_t low = letter == 0 ? 0 : letter - 1; low <= letter && low + 1 < gaps_; ++low) {
      const auto places = places_of(word_, low);
      if (word_[places[place[low]]] != letter) return {};
      place[low] = (place[low] + 1) % places.size();
    }
    return place;
  }

  Word word_;
  std::size_t gaps_;
  std::vector<std::vector<std::uint64_t>> next_;  // place and letter
  std::vector<std::uint64_t> open_;
  std::uint64_t kept_ = 0;
};

}  // namespace cradle::words
