// What a word is: its letters, other ways to write it, words that no particles can repeat.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "cradle/core/words/word.hpp"

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

}  // namespace cradle::tests::word_cases
