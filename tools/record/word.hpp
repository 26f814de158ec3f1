// The collisions of a few particles as letters (core/observe/collision_word.hpp), and how far they follow the word of
// the scene (core/words/followed.hpp): the table `sequence`.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/observe/collision_word.hpp"
#include "cradle/core/words/followed.hpp"
#include "cradle/tools/record/tables.hpp"

namespace cradle::tools {

class WordRecorder {
 public:
  explicit WordRecorder(const Scene& scene)
      : word_(*scene.output.word), wall_(scene.walls.left.position ? 1 : 0), gaps_(scene.gaps()) {
    if (word_ != any_word) followed_.emplace(words::read_word(word_, gaps_), gaps_);
  }

  /// `left` is the left particle of the collision, or -1 for a wall on the left.
  void add(ParticleIndex left, double time) {
    const auto gap = static_cast<std::size_t>(left + wall_);
    made_.add(gap, time);
    if (!followed_ || !followed_->follows()) return;
    followed_->add(gap);
    if (!followed_->follows()) left_at_ = time;
  }

  Group table() const {
    std::vector<std::string> letters;
    std::vector<std::uint64_t> repeats, first;
    std::vector<double> time;
    for (auto& block : made_.blocks()) {
      letters.push_back(std::move(block.letters)), repeats.push_back(block.repeats);
      first.push_back(block.first), time.push_back(block.time);
    }
    Group table = filled(sequence_table(), std::move(letters), std::move(repeats), std::move(first), std::move(time));
    table.attributes = {{"gaps", std::uint64_t{gaps_}}};
    if (!followed_) return table;
    for (const Attribute& attribute :
         {Attribute("word", word_), Attribute("kept", followed_->kept()), Attribute("periods", followed_->periods()),
          Attribute("follows", std::uint64_t{followed_->follows()}), Attribute("left_at", left_at_)})
      table.attributes.push_back(attribute);
    return table;
  }

  static auto state(auto& self) { return std::tie(self.made_, self.followed_, self.left_at_); }

 private:
  std::string word_;
  ParticleIndex wall_;
  std::size_t gaps_;
  CollisionWord made_;
  std::optional<words::Followed> followed_;
  double left_at_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace cradle::tools
