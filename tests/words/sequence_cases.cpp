// The order of collisions written compactly (core/observe/collision_word.hpp), and how far it follows a word
// (core/words/followed.hpp). Twin: the letters themselves, which must come back from the blocks; restrictions of a
// sequence to two touching letters, which commuting leaves alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "cradle/core/observe/collision_word.hpp"
#include "cradle/core/words/followed.hpp"
#include "cradle/tests/core/saved.hpp"

namespace cradle::tests::sequence_cases {

using words::Followed;
using words::Word;

CollisionWord recorded(const Word& made) {
  CollisionWord word;
  double time = 0;
  for (const std::size_t gap : made) word.add(gap, time++);
  return word;
}

Word spelled_out(const std::vector<CollisionWord::Block>& blocks) {
  Word all;
  for (const auto& block : blocks)
    for (std::uint64_t k = 0; k < block.repeats; ++k)
      for (const char letter : block.letters) all.push_back(static_cast<std::size_t>(letter - 'a'));
  return all;
}

// The letters at gaps `low` and `low` + 1, for each low: equal for sequences that differ in commuting letters only.
std::vector<Word> restrictions(const Word& made, std::size_t gaps) {
  std::vector<Word> all;
  for (std::size_t low = 0; low + 1 < gaps; ++low) {
    all.emplace_back();
    for (const std::size_t place : words::places_of(made, low)) all.back().push_back(made[place]);
  }
  return all;
}

// Letters as collisions can follow each other: none twice without one that touches it between.
Word random_sequence(std::mt19937_64& random, std::size_t gaps, std::size_t length) {
  std::vector<bool> open(gaps, true);
  Word made;
  while (made.size() < length) {
    const std::size_t gap = random() % gaps;
    if (!open[gap]) continue;
    made.push_back(gap);
    for (std::size_t k = 0; k < gaps; ++k)
      if (words::touch(k, gap)) open[k] = k != gap;
  }
  return made;
}

Word repeated(const Word& word, std::size_t times) {
  Word all;
  for (std::size_t k = 0; k < times; ++k) all.insert(all.end(), word.begin(), word.end());
  return all;
}

TEST(Sequence, IsThatOfTheBlocks) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const std::size_t gaps = 2 + random() % 5;
    Word made = random_sequence(random, gaps, random() % 200);
    if (seed % 2 == 0 && made.size() > 3) {
      const Word again = repeated(made, 3 + random() % 9), rest = random_sequence(random, gaps, random() % 100);
      made.insert(made.end(), again.begin(), again.end());
      made.insert(made.end(), rest.begin(), rest.end());
    }
    const auto blocks = recorded(made).blocks();
    EXPECT_EQ(restrictions(spelled_out(blocks), gaps), restrictions(made, gaps));
    std::uint64_t first = 0;
    for (const auto& block : blocks) {
      EXPECT_EQ(block.first, first);
      first += block.repeats * block.letters.size();
    }
  }
}

// A row for the repetitions, and some for what is left before and after them where letters commute.
TEST(Sequence, OfAWordTakesAFewRowsHoweverOftenItRepeats) {
  std::size_t tried = 0;
  for (const std::size_t gaps : std::vector<std::size_t>{2, 3, 4})
    words::for_each_word(gaps, 9, false, [&](const Word& word) {
      ++tried;
      const auto blocks = recorded(repeated(word, 1000)).blocks(), fewer = recorded(repeated(word, 100)).blocks();
      EXPECT_EQ(blocks.size(), fewer.size()) << words::text_of(word);
      EXPECT_LE(blocks.size(), 6U) << words::text_of(word);
      std::uint64_t most = 0;
      for (const auto& block : blocks) most = std::max(most, block.repeats);
      EXPECT_GE(most, 997U) << words::text_of(word);
    });
  EXPECT_GT(tried, 100U);
  // The longest repetition, not the first.
  const Word ababcb{0, 1, 0, 1, 2, 1};
  const auto blocks = recorded(repeated(ababcb, 9)).blocks();
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_EQ(blocks.front().letters, "ababcb");
  EXPECT_EQ(blocks.front().repeats, 9U);
}

TEST(Sequence, ContinuesFromASavedState) {
  std::mt19937_64 random(7);
  Word made = repeated({0, 1, 0, 1, 2, 1}, 40);
  const Word rest = random_sequence(random, 3, 200);
  made.insert(made.end(), rest.begin(), rest.end());
  const auto add = [&](CollisionWord& word, std::size_t k) { word.add(made[k], static_cast<double>(k)); };
  for (std::size_t cut = 0; cut < made.size(); cut += 13)
    test::expect_continues(CollisionWord(), made.size(), cut, add, {});
}

// From every place of the word, in every order of letters that commute; and not one letter beyond the first wrong one.
TEST(Followed, UpToTheFirstLetterThatIsNotTheWords) {
  std::mt19937_64 random(3);
  std::size_t tried = 0;
  for (const std::size_t gaps : std::vector<std::size_t>{2, 3, 4})
    words::for_each_word(gaps, 8, false, [&](const Word& word) {
      Word made = words::rotated(repeated(word, 4), random() % word.size());
      for (std::size_t swap = 0; swap < 100; ++swap)
        if (const std::size_t k = random() % (made.size() - 1); !words::touch(made[k], made[k + 1]))
          std::swap(made[k], made[k + 1]);
      Followed followed(word, gaps);
      for (const std::size_t gap : made) followed.add(gap);
      EXPECT_TRUE(followed.follows()) << words::text_of(word);
      EXPECT_EQ(followed.kept(), made.size());
      EXPECT_EQ(followed.periods(), 4U);
      followed.add(made.back());  // it closes twice running
      followed.add(made.front());
      EXPECT_FALSE(followed.follows()) << words::text_of(word);
      EXPECT_EQ(followed.kept(), made.size());
      ++tried;
    });
  EXPECT_GT(tried, 50U);
}

}  // namespace cradle::tests::sequence_cases
