#include "cradle/tools/threshold/threshold.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <utility>

#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/tools/proof/certify.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/store/unfinished.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

const std::string kind(threshold_kind);
constexpr const char* closed_form = "closed form";

Error interrupted(const Interrupt& interrupt) {
  return Error({}, "interrupted", "", "the same command continues", status_of_signal(interrupt.signal()));
}

class Search {
 public:
  Search(const ThresholdProblem& question, const std::string& file, const ThresholdOptions& options)
      : question_(question), options_(options), part_(file + ".part"), line_(options.progress),
        threads_(thread_count(options.threads)) {
    const JournalHeader header{kind, question.identity(),
                               effective_toml(question.scene_at(question.low(), false).value()), question.key()};
    take_result(file);
    take_journal(header);
  }

  Threshold find() {
    bracket_.emplace(question_.low(), question_.high(), question_.digits(), question_.whole_numbers());
    RunAt low = at(question_.low()), high = at(question_.high());
    if (low.outcome == high.outcome) {
      ::unlink(part_.c_str());
      const bool exact = low.how == closed_form && high.how == closed_form;
      throw Error({"", 0, "--vary"}, "the same outcome at both ends",
                  fmt::format("{} at {} in {} and at {} in {}", low.outcome, low.value, low.how, high.value, high.how),
                  fmt::format("give ends between which it changes,{} or another outcome (--outcome)",
                              exact ? "" : " a type of more digits (--set run.precision),"));
    }
    while (bracket_->next()) {
      const RunAt run = at(*bracket_->next());
      const bool as_at_low = run.outcome == low.outcome;
      bracket_->narrow(as_at_low);
      (as_at_low ? low : high) = run;
    }
    return {runs_, known_of(low), known_of(high)};
  }

 private:
  void take_result(const std::string& file) {
    std::error_code unreadable;
    if (!std::filesystem::exists(file, unreadable) || took(file) || options_.force == Force::yes) return;
    throw Error({file}, "not a result that this command makes again", "something else",
                "give another -o FILE, or --force to replace it");
  }
  // Whether the file holds a search that this one continues.
  bool took(const std::string& file) {
    try {
      const Result result = read_result(file);
      const Group* table = result.find(kind);
      if (table == nullptr || attribute<std::uint64_t>(result.attributes, "identity", file) != question_.identity())
        return false;
      const auto texts = [&](std::size_t k) { return std::get<std::vector<std::string>>(table->columns.at(k).values); };
      const auto counts = [&](std::size_t k) {
        return std::get<std::vector<std::uint64_t>>(table->columns.at(k).values);
      };
      const auto value = texts(1), outcome = texts(2), how = texts(5);
      const auto collisions = counts(3), merges = counts(4);
      for (std::size_t k = 0; k < value.size(); ++k)
        known_[value[k]] = {value[k], outcome.at(k), collisions.at(k), merges.at(k), how.at(k)};
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }

  void take_journal(const JournalHeader& wanted) {
    const auto there = journal_header(part_);
    const bool of_this = there && there->kind == kind && there->identity == wanted.identity;
    if (there && !of_this && options_.force == Force::no)
      throw Error({part_}, "unfinished work of something else", there->kind,
                  "let its own command finish it, or give another -o FILE, or --force to replace it");
    if (!of_this) return journal_.emplace(part_, wanted), void();
    JournalReader reader(part_);
    while (const auto run = reader.next<RunAt>()) known_[run->value] = *run;
    journal_.emplace(part_, reader.whole_bytes());
  }

  const RunAt& at(const Decimal& value) {
    if (options_.interrupt.signal() != 0) throw interrupted(options_.interrupt);
    draw();
    const auto known = known_.find(value.text);
    if (known != known_.end()) return runs_.emplace_back(known->second);
    const RunAt run = run_at(value);
    journal_->append(to_bytes(run));
    return runs_.emplace_back(known_[value.text] = run);
  }

  RunAt run_at(const Decimal& value) {
    if (question_.what().type == Compare::collapse)
      if (const auto exact = exact_collapse(question_.scene_at(value, false).value()))
        return {value.text, std::string(exact->collapse ? end_row(RunEnd::collapsed).text : no_collapse),
                exact->collisions, 0, closed_form};
    std::string last;
    for (const bool wide : {false, true}) {
      if (!wide && question_.wide_from_the_start()) continue;
      const auto scene = question_.scene_at(value, wide);
      if (!scene) continue;
      if (!expected_cost(*scene).endless.empty()) {
        last = fmt::format("a collapse of more than three particles is not proved, and does not end in {}",
                           precision_name(scene->run));
        continue;
      }
      const RunOutcome run =
          run_scene(without_tables(*scene), {Progress::Show::never, nullptr, &options_.interrupt, workers(threads_)});
      if (run.end == RunEnd::interrupted) throw interrupted(options_.interrupt);
      last = fmt::format("{} in {}", end_row(run.end).text, precision_name(scene->run));
      const auto* ties = find_attribute<std::uint64_t>(run.result.attributes, "simultaneous_collisions");
      if (ties && *ties > 0)
        last += fmt::format(", after {} collisions at which three particles met at one time", *ties);
      if (const auto outcome = question_.outcome(run))
        return {value.text, *outcome, run.collisions, run.merges, precision_name(scene->run)};
    }
    if (runs_.size() < 2) ::unlink(part_.c_str());  // no search has begun that another command could continue
    throw Error({"", 0, "--vary"}, "a run without an outcome",
                fmt::format("{} = {}: {}", question_.key(), value.text, last),
                fmt::format("give {}, a type of more digits (run.precision, run.digits), or compare another outcome "
                            "(--outcome gap with a run.stop_gap, say)",
                            value == question_.low()    ? "a range that begins above it"
                            : value == question_.high() ? "a range that ends below it"
                                                        : "fewer --digits"),
                Exit::lost);
  }

  void draw() {
    if (!line_.due()) return;
    const unsigned left = bracket_->values_left();
    const auto done = static_cast<double>(runs_.size());
    line_.draw(done / (done + left + 1),
               fmt::format("run {} of about {}: between {} and {}", runs_.size() + 1, runs_.size() + left + 1,
                           bracket_->low().text, bracket_->high().text));
  }

  ThresholdEnd known_of(const RunAt& run) {
    const auto seen = [&](const std::string& why) { return ThresholdEnd{run, false, "seen in " + run.how + why}; };
    if (run.how == closed_form) return {run, true, "proved in closed form"};
    if (!options_.prove) return seen("");
    if (question_.what().type == Compare::pair) return seen("; no proof of clusters");
    if (status_of_text(run.outcome) == Exit::collapse) return seen("; `certify` cannot prove a collapse");
    const Decimal value(run.value);
    Scene scene = question_.scene_at(value, false).value();
    if (precision_name(scene.run) != run.how) scene = question_.scene_at(value, true).value();
    scene = without_tables(std::move(scene));
    try {
      check_certifiable(scene);
    } catch (const Error& error) {
      return seen(fmt::format("; {}", error.what()));
    }
    const Certified proof =
        certify(scene, {.progress = options_.progress, .interrupt = &options_.interrupt, .threads = options_.threads});
    if (!proof.proved()) return seen("; the proof is undecided " + proof.undecided());
    if (const auto outcome = question_.outcome(proof.outcome); outcome != run.outcome)
      throw Error({"", 0, "--vary"}, "a run with another outcome than is proved",
                  fmt::format("{} = {}: {} in {}, {} proved", question_.key(), run.value, run.outcome, run.how,
                              outcome.value_or("none")),
                  "repeat it in a type of more digits, --set run.precision=mpfr --set run.digits=50", Exit::lost);
    return {run, true,
            fmt::format("proved: the collisions ({}) are those of the exact system", proof.certificate.collisions)};
  }

  const ThresholdProblem& question_;
  const ThresholdOptions& options_;
  std::string part_;
  ProgressLine line_;
  Threads threads_;
  std::map<std::string, RunAt> known_;
  std::optional<JournalWriter> journal_;
  std::optional<Bracket> bracket_;
  std::vector<RunAt> runs_;
};

}  // namespace

Threshold find_threshold(const ThresholdProblem& question, const std::string& file, const ThresholdOptions& options) {
  return Search(question, file, options).find();
}

std::string threshold_text(const ThresholdProblem& question, const Threshold& found) {
  std::string text = fmt::format("{}\n", question.what().text);
  for (const ThresholdEnd* end : {&found.low, &found.high})
    text += fmt::format("  {} = {}: {}\n    {}\n", question.key(), end->run.value, end->run.outcome, end->how);
  text += fmt::format("The outcome changes in between: {}. {} values tried; it may change elsewhere too.\n",
                      found.proved() ? "proved" : "seen", found.runs.size());
  if (question.what().type == Compare::gap)
    text +=
        fmt::format("That is for run.stop_gap = {}: particles may come as near and part again, without a collapse.\n",
                    question.scene_at(Decimal(found.low.run.value), false)->run.stop_gap->text);
  return text;
}

Result threshold_result(const ThresholdProblem& question, const Threshold& found, const std::string& command) {
  const auto scene = question.scene_at(Decimal(found.low.run.value), false).value();
  Result result;
  result.attributes = provenance(scene, precision_name(scene.run), "threshold of " + question.key());
  result.attributes.emplace_back("kind", std::string(kind));
  result.attributes.emplace_back("identity", question.identity());
  const auto of_runs = [&](auto of) { return numbers_of(found.runs, of); };
  Group group{kind,
              {{"key", question.key()}, {"compared", std::string(question.what().text)}, {"command", command}},
              {{"value", "1", "of the key that varies, rounded",
                of_runs([](const RunAt& run) { return Decimal(run.value).value; })},
               {"value_digits", "1", "the same, all digits", of_runs(&RunAt::value)},
               {"outcome", "1", "of the run with this value", of_runs(&RunAt::outcome)},
               {"collisions", "1", "made in the run; with a closed form, until the outcome was decided",
                of_runs(&RunAt::collisions)},
               {"merges", "1", "made in the run", of_runs(&RunAt::merges)},
               {"how", "1", "type of the run, or closed form: proved without one", of_runs(&RunAt::how)}}};
  for (const auto& [name, end] : {std::pair("low", &found.low), std::pair("high", &found.high)}) {
    const std::string prefix(name);
    append(group.attributes, {{prefix, Decimal(end->run.value).value},
                              {prefix + "_digits", end->run.value},
                              {prefix + "_outcome", end->run.outcome},
                              {prefix + "_proved", std::uint64_t{end->proved}},
                              {prefix + "_how", end->how}});
  }
  result.groups.push_back(std::move(group));
  return result;
}

}  // namespace cradle::tools
