#pragma once
// The order of the collisions of a few particles, written compactly: letters are gaps from the left, and letters that
// repeat stand once, with the number of repetitions. A self-similar collapse takes one row, however deep it is.
//
// Letters that do not touch commute; they are put into alphabetical order as far as `most_waiting` letters allow, so
// that one motion is written in one way. A block is the repetition that covers most letters, of the periods up to
// `longest`: (ababcb)^9, not (ab)^2 cb (ab)^2 cb ... Letters that begin no repetition are collected in a block of one.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/words/word.hpp"

namespace cradle {

class CollisionWord {
 public:
  static constexpr std::size_t longest = 32;

  struct Block {
    std::string letters;
    std::uint64_t repeats = 1, first = 0;  // the number of its first collision, from 0
    double time = 0;                       // of that collision
    static auto state(auto& self) { return fields(self.letters, self.repeats, self.first, self.time); }
  };

  void add(std::size_t gap, double time) {
    auto place = waiting_.size();
    for (auto k = place; k > 0 && !words::touch(waiting_[k - 1].gap, gap); --k)
      if (waiting_[k - 1].gap > gap) place = k - 1;
    waiting_.insert(waiting_.begin() + static_cast<std::ptrdiff_t>(place), {gap, time});
    if (waiting_.size() <= most_waiting) return;
    extend(waiting_.front());
    waiting_.pop_front();
  }

  /// All blocks so far.
  std::vector<Block> blocks() const {
    CollisionWord all = *this;
    for (const Letter& letter : waiting_) all.extend(letter);
    while (all.count_ > 0) {
      for (std::size_t period = 1; period <= longest; ++period) all.end(period);
      for (const Letter& letter : all.close()) all.extend(letter);
    }
    return std::move(all.blocks_);
  }

  static auto state(auto& self) {
    return fields(self.blocks_, self.waiting_, self.recent_, self.head_, self.count_, self.written_, self.alive_,
                  self.covered_, self.period_, self.start_);
  }
  void loaded() const {
    require_state(recent_.size() == std::min<std::uint64_t>(count_, most_recent) &&
                      head_.size() == std::min<std::uint64_t>(count_, longest) && period_ <= head_.size() &&
                      covered_ <= count_ && (period_ == 0 || alive_ != 0 || count_ - covered_ <= recent_.size()),
                  "a word");
  }

 private:
  static constexpr std::size_t most_waiting = 12, most_recent = 2 * longest;

  struct Letter {
    std::uint64_t gap = 0;
    double time = 0;
    static auto state(auto& self) { return fields(self.gap, self.time); }
  };

  // The open block takes letters until no period fits any more. A period of p letters is alive, bit p - 1, as long as
  // each letter is the one p before it.
  void extend(const Letter& letter) {
    for (std::size_t period = 1; period <= std::min<std::uint64_t>(longest, count_); ++period)
      if (letter.gap != recent_[recent_.size() - period].gap) end(period);
    if (count_ >= longest && alive_ == 0) {
      for (const Letter& left : close()) extend(left);
      return extend(letter);
    }
    if (count_ == 0) start_ = letter.time;
    if (head_.size() < longest) head_ += static_cast<char>('a' + letter.gap);
    recent_.push_back(letter);
    if (recent_.size() > most_recent) recent_.pop_front();
    ++count_;
  }

  void end(std::size_t period) {
    const std::uint64_t bit = std::uint64_t{1} << (period - 1), covered = count_ / period * period;
    if ((alive_ & bit) == 0) return;
    alive_ &= ~bit;
    if (covered < 2 * period || covered < covered_ || (covered == covered_ && period > period_)) return;
    covered_ = covered, period_ = period;
  }

  // Writes the open block, or its first letter if nothing repeats, and returns the letters behind it: fewer than
  // `most_recent`, since the last period to end, p, covers all but p letters, or less than two periods were there.
  std::deque<Letter> close() {
    const bool repeats = period_ > 0;
    const std::uint64_t written = repeats ? covered_ : 1;
    if (!repeats && !blocks_.empty() && blocks_.back().repeats == 1)
      blocks_.back().letters += head_[0];
    else
      blocks_.push_back({head_.substr(0, repeats ? period_ : 1), repeats ? covered_ / period_ : 1, written_, start_});
    written_ += written;
    std::deque<Letter> left(recent_.end() - static_cast<std::ptrdiff_t>(count_ - written), recent_.end());
    recent_.clear(), head_.clear();
    count_ = covered_ = period_ = 0, alive_ = all_periods;
    return left;
  }

  static constexpr std::uint64_t all_periods = (std::uint64_t{1} << longest) - 1;

  std::vector<Block> blocks_;
  std::deque<Letter> waiting_;  // may still change places with letters to come
  std::deque<Letter> recent_;   // the last ones of the open block
  std::string head_;            // its first ones
  std::uint64_t count_ = 0, written_ = 0, alive_ = all_periods;
  std::uint64_t covered_ = 0, period_ = 0;  // the best repetition that has ended; 0: none
  double start_ = 0;
};

}  // namespace cradle
