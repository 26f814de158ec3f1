// The collisions of a few particles as letters (core/observe/collision_word.hpp), and how far they follow the word of
// the scene (core/words/word.hpp): the table `sequence`.
#pragma once

#include <optional>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/observe/collision_word.hpp"
#include "cradle/core/words/word.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

class WordMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "word",
      .at_end = "sequence",
      .wanted = [](const Scene& scene) { return scene.output.word.has_value(); },
      .leave_out = [](Output& output) { output.word.reset(); },
      .averaged = false,
  };

  explicit WordMeasurement(const Measured& of)
      : word_(*of.scene.output.word), wall_(of.scene.walls.left.position ? 1 : 0), gaps_(of.scene.gaps()) {
    if (word_ != any_word) followed_.emplace(words::read_word(word_, gaps_), gaps_);
  }

  void collision(const ObservedCollision& c) {
    const auto gap = static_cast<std::size_t>(c.left + wall_);
    made_.add(gap, c.time);
    if (!followed_ || !followed_->follows()) return;
    followed_->add(gap);
    if (!followed_->follows()) left_at_ = c.time;
  }

  void finish(const RunState&, TableSink& put) { put.add(table()); }

  static auto state(auto& self) { return fields(self.made_, self.followed_, self.left_at_); }

 private:
  Group table() const {
    using Block = CollisionWord::Block;
    const std::vector<Block> blocks = made_.blocks();
    Group table{
        "sequence",
        {{"gaps", std::uint64_t{gaps_}}},
        {{"letters", "1", "gaps from the left that close one after the other", numbers_of(blocks, &Block::letters)},
         {"repeats", "1", "how often these letters follow each other", numbers_of(blocks, &Block::repeats)},
         {"first", "1", "number of the first of these collisions, from 0", numbers_of(blocks, &Block::first)},
         {"time", "t", "time of that collision, rounded", numbers_of(blocks, &Block::time)}}};
    if (!followed_) return table;
    append(table.attributes, {{"word", word_},
                              {"kept", followed_->kept()},
                              {"periods", followed_->periods()},
                              {"follows", std::uint64_t{followed_->follows()}},
                              {"left_at", left_at_}});
    return table;
  }

  std::string word_;
  ParticleIndex wall_;
  std::size_t gaps_;
  CollisionWord made_;
  std::optional<words::Followed> followed_;
  double left_at_ = none();
};

}  // namespace cradle::tools
