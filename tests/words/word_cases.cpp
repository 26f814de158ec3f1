// What a word is: its letters, other ways to write it, words that no particles can repeat. And the order of collisions
// written compactly (core/observe/collision_word.hpp), and how far it follows a word (core/words/word.hpp). Twin:
// the letters themselves, which must come back from the blocks; restrictions of a sequence to two touching letters,
// which commuting leaves alone.
#include <random>

#include "cradle/core/observe/collision_word.hpp"
#include "cradle/core/words/word.hpp"
#include "cradle/tests/core/compare.hpp"

namespace cradle::tests::word_cases {

using namespace words;

std::string refused(const std::string& text, std::size_t gaps) {
  try {
    read_word(text, gaps);
  } catch (const BadWord& bad) {
    return std::string(bad.what()) + " | " + bad.found + " | " + bad.advice;
  }
  return "accepted";
}

TEST(Word, ThatCannotBeRepeatedSaysWhy) {
  const auto expect = [](const std::string& text, std::size_t gaps, const std::string& part) {
    EXPECT_NE(refused(text, gaps).find(part), std::string::npos) << text << ": " << refused(text, gaps);
  };
  expect("abd", 3, "a letter that is no gap | d in abd | use the letters a to c");
  expect("aBc", 3, "a letter that is no gap | B in aBc");
  expect("", 3, "no letters");
  expect("ab", 3, "gap c never closes");
  expect("aabc", 3, "gap a closes twice running");
  expect("abca", 3, "gap a closes twice running");  // the end meets the beginning
  expect("acab", 3, "gap a closes twice running");  // c does not touch a
  expect("abab", 2, "a word that repeats a shorter one");
  expect("acbcab", 3, "a word that repeats a shorter one");  // as acb acb: a and c commute
  EXPECT_EQ(refused("acb", 3), "accepted");
  EXPECT_EQ(refused("ababcb", 3), "accepted");
}

TEST(Word, IsTheSameWhereverItBegins) {
  const auto same = same_motion(read_word("ababcb", 3));
  for (const char* text : {"babcba", "abcbab", "bcbaba", "cbabab"})
    EXPECT_TRUE(same.contains(sorted(read_word(text, 3)))) << text;
  EXPECT_FALSE(same.contains(sorted(read_word("cbcbab", 3)))) << "its mirror image";
  EXPECT_TRUE(same_motion(mirrored(read_word("ababcb", 3), 3)).contains(sorted(read_word("bcbabc", 3))));
  EXPECT_EQ(same_motion(read_word("acb", 3)), same_motion(read_word("abc", 3))) << "a and c commute";
}

// Blocks between two letters b are a, c or ac: words are necklaces of these, without repetition, up to reflection.
TEST(Word, SearchFindsEveryMotionOnce) {
  std::set<Word> seen;
  std::size_t found = 0;
  for_each_word(3, 9, true, [&](const Word& word) {
    ++found;
    for (const Word& other : {word, mirrored(word, 3)})
      for (const Word& same : same_motion(other)) {
        const bool fresh = seen.insert(same).second;
        EXPECT_TRUE(other != word || fresh || same_motion(mirrored(word, 3)).contains(same)) << text_of(same);
      }
  });
  // All words of these lengths, tried one by one.
  std::set<std::set<Word>> motions;
  for (std::size_t length = 2; length <= 9; ++length) {
    std::size_t all = 1;
    for (std::size_t k = 0; k < length; ++k) all *= 3;
    for (std::size_t code = 0; code < all; ++code) {
      Word word(length);
      std::size_t rest = code;
      for (std::size_t& letter : word) letter = rest % 3, rest /= 3;
      try {
        require_word(word, 3);
      } catch (const BadWord&) {
        continue;
      }
      auto motion = same_motion(word);
      motion.merge(same_motion(mirrored(word, 3)));
      motions.insert(motion);
    }
  }
  EXPECT_EQ(found, motions.size());
  EXPECT_GT(found, 10U);
}

TEST(Word, OfTheSameHalvesIsFound) {
  EXPECT_TRUE(has_mirrored_half(read_word("abcb", 3), 3));
  EXPECT_TRUE(has_mirrored_half(read_word("ab", 2), 2));
  EXPECT_FALSE(has_mirrored_half(read_word("ababcb", 3), 3));
}

// ---- collisions as a word

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
    for (const std::size_t place : places_of(made, low)) all.back().push_back(made[place]);
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
      if (touch(k, gap)) open[k] = k != gap;
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
    for_each_word(gaps, 9, false, [&](const Word& word) {
      ++tried;
      const auto blocks = recorded(repeated(word, 1000)).blocks(), fewer = recorded(repeated(word, 100)).blocks();
      EXPECT_EQ(blocks.size(), fewer.size()) << text_of(word);
      EXPECT_LE(blocks.size(), 6U) << text_of(word);
      std::uint64_t most = 0;
      for (const auto& block : blocks) most = std::max(most, block.repeats);
      EXPECT_GE(most, 997U) << text_of(word);
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
    for_each_word(gaps, 8, false, [&](const Word& word) {
      Word made = rotated(repeated(word, 4), random() % word.size());
      for (std::size_t swap = 0; swap < 100; ++swap)
        if (const std::size_t k = random() % (made.size() - 1); !touch(made[k], made[k + 1]))
          std::swap(made[k], made[k + 1]);
      Followed followed(word, gaps);
      for (const std::size_t gap : made) followed.add(gap);
      EXPECT_TRUE(followed.follows()) << text_of(word);
      EXPECT_EQ(followed.kept(), made.size());
      EXPECT_EQ(followed.periods(), 4U);
      followed.add(made.back());  // it closes twice running
      followed.add(made.front());
      EXPECT_FALSE(followed.follows()) << text_of(word);
      EXPECT_EQ(followed.kept(), made.size());
      ++tried;
    });
  EXPECT_GT(tried, 50U);
}

}  // namespace cradle::tests::word_cases
