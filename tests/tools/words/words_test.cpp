// Scenes that start from a word keep it for as long as their digits last. (How far collisions follow a word, letter by
// letter: tests/words/word_cases.cpp. What `cradle words` prints and writes: tests/tools/outputs.txt. What is
// refused: tests/tools/messages.txt.)
#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::words_test {

using WordsCommand = ProgramTest;

// An error of the last bit grows by the state's factor in every period, until it is as large as the state: 230 digits
// are 766 bits. How large it has to be to change a collision, and how large it was, is worth a period or two. From
// positions and velocities cut off after 230 decimals it is as many as a separate program found that started from an
// eigenvector in 230 digits.
TEST_F(WordsCommand, RunsKeepTheirWordForAsLongAsTheirDigitsLast) {
  const auto periods = [&](const std::string& file) {
    const tools::Result result = read(file);
    const auto& attributes = result.find("sequence")->attributes;
    const auto kept = tools::attribute<std::uint64_t>(attributes, "periods", file);
    EXPECT_EQ(tools::attribute<std::uint64_t>(attributes, "follows", file), 0U);
    EXPECT_GT(tools::attribute<double>(attributes, "left_at", file), 0.9);
    EXPECT_EQ(numbers<std::string>(result, "sequence", "letters").front(), "ababcb");
    EXPECT_LE(kept - numbers<std::uint64_t>(result, "sequence", "repeats").front(), 1U) << "commuting letters";
    return static_cast<double>(kept);
  };
  for (const auto& [restitution, found_elsewhere] :
       {std::pair("0.09", 113), std::pair("0.1", 154), std::pair("0.101", 160)}) {
    SCOPED_TRACE(restitution);
    shell("cradle words 4 ababcb --digits 10 --force -o factor.h5 --at " + std::string(restitution), 0);
    const double factor = numbers(read("factor.h5"), "words", "factor").front();
    write("word.toml", "[law]\ntype = 'inelastic'\nrestitution = " + std::string(restitution) +
                           "\n[initial]\ntype = 'list'\nword = 'ababcb'\n[run]\nuntil = 5\nprecision = 'mpfr'\n"
                           "digits = 230\nstop_gap = '1e-2000'\n[output]\nword = 'ababcb'\n"
                           "series = { points = 3 }\n");
    shell("cradle run word.toml --quiet --force -o word.h5; cradle export word.h5 --to csv --force");
    EXPECT_NEAR(periods("word.h5"), 766 * std::log(2.) / std::log(factor), 2);
    write("cut.toml", std::regex_replace(contents(path("csv/scene.toml")), std::regex("(\\.[0-9]{230})[0-9]+"), "$1"));
    shell("cradle run cut.toml --quiet --force -o cut.h5");
    EXPECT_NEAR(periods("cut.h5"), found_elsewhere, 2);
  }
}

TEST_F(WordsCommand, ScenesStartFromAWordInEveryType) {
  const std::string scene = "[law]\ntype = 'inelastic'\nrestitution = 0.05\n[initial]\ntype = 'list'\nword = 'ababcb'\n"
                            "[run]\nuntil = 5\nstop_gap = 1e-30\n[output]\nword = 'ababcb'\nseries = { points = 3 }\n";
  const auto expect_kept = [](const tools::Result& result) {
    // Errors of 1e-16 grow by 15,000 in a period.
    EXPECT_GE(tools::attribute<std::uint64_t>(result.find("sequence")->attributes, "periods", ""), 3U);
  };
  expect_kept(result_of(scene, "", 3));
  in_wide_types(scene, expect_kept, 3);
}

}  // namespace cradle::tests::words_test
