#pragma once
// `Followed` finds how far a sequence of collisions follows a word, repeated for ever. Collisions of gaps that do not
// touch commute (word.hpp), so a place in the word is a set of letters made, closed under what must come before: for
// each two touching gaps, how many of their letters. A sequence may begin at any place; all that fit so far are kept.

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/words/word.hpp"

namespace cradle::words {

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

  static auto state(auto& self) { return std::tie(self.open_, self.kept_); }
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
