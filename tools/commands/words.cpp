#include "cradle/tools/words/words.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "cradle/tools/commands/commands.hpp"

namespace cradle::tools {

namespace {

struct WordsArguments : OutputOptions {
  std::string particles, word, masses, walls;
  std::optional<std::string> at;
  std::uint64_t search = 0, digits = 30;
  bool quiet = false;
};

std::optional<Decimal> restitution(const std::optional<std::string>& text) {
  if (!text) return {};
  if (const Decimal r(canonical_decimal(*text).value_or("0")); r > Decimal("0") && r < Decimal("1")) return r;
  throw Error({"", 0, "--at"}, "not a restitution", *text, "give a number between 0 and 1");
}

std::string command_of(const WordsArguments& options) {
  std::string command = "words " + options.particles;
  command += options.word.empty() ? fmt::format(" --search {}", options.search) : " " + options.word;
  if (!options.masses.empty()) command += " --masses " + options.masses;
  if (!options.walls.empty()) command += " --walls " + options.walls;
  if (options.at) command += " --at " + *options.at;
  if (options.digits != 30) command += fmt::format(" --digits {}", options.digits);
  return command;
}

Exit run_words(const WordsArguments& options) {
  const WordParticles particles =
      word_particles(options.particles, options.masses, options.walls, static_cast<unsigned>(options.digits));
  if (options.word.empty() == (options.search == 0))
    throw Error({}, options.word.empty() ? "no word" : "a word and a search", options.word,
                "give either a word or --search LENGTH");
  if (options.at && options.word.empty())
    throw Error({"", 0, "--at"}, "acts on nothing in a search", *options.at, "give it with a word");
  const std::string output = !options.output.empty() ? options.output
                             : options.word.empty()  ? "words-" + options.particles + ".h5"
                                                     : options.word + ".h5";
  const words::Word word =
      options.word.empty() ? words::Word() : word_at({"", 0, "WORD"}, options.word, particles.gaps());
  const FileClaim claim = options.claim(output, command_of(options), nullptr);
  std::vector<WordReport> reports;
  std::size_t tried = 1;
  if (!word.empty()) {
    reports.push_back(report_word(particles, word, restitution(options.at)));
    fmt::print("{}", word_text(particles, reports.back()));
  } else {
    tried = 0;
    fmt::print("{}\n{:<14} {:<18} {:<18}  {:<9} {:<23}  upper end\n", particles.text(), "word", "r from", "to",
               "existence", "stable (seen)");
    const auto print = [](const WordReport& report) {
      fmt::print("{}", word_line(report));
      std::fflush(stdout);
    };
    reports = search_words(particles, options.search, print, tried);
    fmt::print("{} of {} words up to {} letters exist for some restitution\n", reports.size(), tried, options.search);
  }
  put_result(words_result(particles, reports, tried, command_of(options)), output, "", options.quiet);
  return Exit::done;
}

}  // namespace

void add_words(CommandLine& program) {
  Command command = program.add("words", "for which restitutions a few particles repeat a word of collisions for ever",
                                "cradle words 4 ababcb");
  auto& options = command.runs<WordsArguments>(run_words);
  command.argument("N", options.particles, "number of particles, 3 to 6");
  command.argument("WORD", options.word, "letters are gaps from the left: a, b, ...", Needed::no);
  command.option("--masses", options.masses, "masses from the left, with commas between (default: equal)");
  command.option("--walls", options.walls, "left, right or both: walls at rest, with the restitution of the particles");
  command.option("--at", options.at, "restitution of the state that is printed (default: the middle)");
  command.option("--search", options.search, {2, 16}, "all words up to so many letters instead of one");
  command.option("--digits", options.digits, {10, 250}, "digits to which ends are proved (default: 30)");
  command.flag("--quiet", options.quiet, "no message about the file");
  add_output_options(command, options, "result file (default: WORD.h5, or words-N.h5)");
}

}  // namespace cradle::tools
