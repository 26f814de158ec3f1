#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/threshold/threshold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/source.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/spelling.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

Error wrong(const std::string& what, const std::string& found, const std::string& advice) {
  return Error({"", 0, "--vary"}, what, found, advice);
}

const Field& field_of(std::string_view key, const Scene& scene) {
  if (const Field* field = find_field(key, scene)) return *field;
  std::vector<std::string_view> keys;
  for (const Field& field : scene_fields()) keys.push_back(field.key);
  const auto nearest = nearest_word(key, keys);
  throw wrong("no such key", std::string(key),
              nearest.empty() ? "`cradle scenes --keys` lists them" : fmt::format("did you mean {}?", nearest));
}

}  // namespace

ThresholdProblem::ThresholdProblem(std::string scene, std::vector<std::string> overrides, const std::string& vary,
                                   const std::string& compare, unsigned digits)
    : scene_(std::move(scene)), vary_(vary), overrides_(std::move(overrides)), digits_(digits) {
  const auto equals = std::min(vary.find('='), vary.size()), colon = std::min(vary.find(':', equals), vary.size());
  key_ = vary.substr(0, equals);
  const auto low = plain_decimal(vary.substr(equals, colon - equals).erase(0, 1)),
             high = plain_decimal(vary.substr(colon).erase(0, 1));
  if (key_.empty() || !low || !high) throw wrong("not a key and two numbers", vary, "give KEY=LOW:HIGH");
  low_ = Decimal(*low), high_ = Decimal(*high);
  if (low_ >= high_) throw wrong("no range", vary, "give the lower number first");
  const bool of_list = key_.ends_with(']');
  choose_key(read_scene(scene_, overrides_, of_list ? std::vector<std::string>() : std::vector{assignment(low_)}));
  for (const std::string& given : overrides_)
    if (key_of(given) == key_)
      throw Error({"--set", 0, key_}, "this is the key that is varied", given, "leave out one of the two");
  auto assigned = overrides_;
  assigned.push_back(assignment(low_));
  at_low_ = read_scene(scene_, assigned);
  choose_outcome(compare);
  const bool more = digits_ > at_low_.run.decimal_digits(), fixed = at_low_.initial.type == InitialType::clusters;
  if (fixed && more)
    throw Error({"", 0, "--digits"}, "more digits than this model has", fmt::format("{}", digits_), "give 15 at most");
  wide_ = !whole_ && more;
}

void ThresholdProblem::choose_key(const Scene& given) {
  const auto bracket = key_.find('[');
  const Field& field = field_of(key_.substr(0, bracket), given);
  const std::string_view type = type_name(field);
  const bool list = type == "list of numbers";
  whole_ = type == "integer";
  if (bracket == key_.npos) {
    if (type == "number" || whole_) return;
    throw wrong("not a key with a number", fmt::format("{}, {}", key_, type),
                list ? fmt::format("give one of its numbers, {}[0]=LOW:HIGH", key_) : "give a key with a number");
  }
  for (const Decimal& item : numbers_of(field, given)) items_.push_back(item.text);
  const auto index = decimal_integer(plain_decimal(key_.substr(bracket + 1, key_.size() - bracket - 2)).value_or("-"));
  if (!key_.ends_with(']') || !list || !index || *index >= items_.size())
    throw wrong("not a number of a list", key_,
                items_.empty() ? "give a key with a number"
                               : fmt::format("give {}[0] to {}[{}]", field.key, field.key, items_.size() - 1));
  item_ = static_cast<std::size_t>(*index);
}

void ThresholdProblem::choose_outcome(const std::string& compare) {
  const bool pair = at_low_.initial.type == InitialType::clusters || at_low_.output.scenario;
  compare_ = pair                         ? Compare::pair
             : particles_merge(at_low_)   ? Compare::merges
             : stops_at_collapse(at_low_) ? Compare::collapse
                                          : Compare::collisions;
  if (!compare.empty()) {
    const auto* const row = std::ranges::find(compared, compare, &CompareRow::name);
    if (row == compared.end()) {
      throw Error({"", 0, "--outcome"}, "no such outcome", compare,
                  fmt::format("give one of {}", fmt::join(numbers_of(compared, &CompareRow::name), ", ")));
    }
    compare_ = row->type;
  }
  const auto refuse = [&](const char* what, const char* advice) {
    throw Error({"", 0, "--outcome"}, what, std::string(this->what().name), advice);
  };
  const bool of_collapse = compare_ == Compare::collapse || compare_ == Compare::gap;
  if (of_collapse && !stops_at_collapse(at_low_))
    refuse("the run does not end at a collapse", "give --set run.collapse=stop, or compare another outcome");
  if (compare_ == Compare::gap && !at_low_.run.stop_gap)
    refuse("no gap at which the run ends", "give --set run.stop_gap=GAP");
  if (compare_ == Compare::pair && !pair)
    refuse("nothing says which clusters", "give a scene with output.scenario or initial.type = \"clusters\", or "
                                          "compare merges");
}

std::string ThresholdProblem::assignment(const Decimal& value) const {
  if (items_.empty()) return key_ + "=" + value.text;
  std::string list = key_.substr(0, key_.find('[')) + "=[";
  for (std::size_t k = 0; k < items_.size(); ++k)
    list += (k > 0 ? ", " : "") + ("'" + (k == item_ ? value.text : items_[k]) + "'");
  return list + "]";
}

std::optional<Scene> ThresholdProblem::scene_at(const Decimal& value, bool wide) const {
  std::vector<std::string> all = overrides_;
  all.push_back(assignment(value));
  if (wide) {
    if (at_low_.initial.type == InitialType::clusters) return {};
#ifdef CRADLE_WITH_MPFR
    if (at_low_.run.precision == Precision::mpfr && at_low_.run.digits >= wide_digits()) return {};
    all.emplace_back("run.precision=mpfr");
    all.push_back(fmt::format("run.digits={}", wide_digits()));
#else
    if (at_low_.run.precision == Precision::cpp_bin_float) return {};
    all.emplace_back("run.precision=cpp_bin_float");
#endif
  }
  Scene scene = read_scene(scene_, all);
  if (compare_ == Compare::collapse) scene.run.stop_gap.reset();
  return scene;
}

std::optional<std::string> ThresholdProblem::outcome(const RunOutcome& run) const {
  const bool collapsed = run.end == RunEnd::collapsed || (compare_ == Compare::gap && run.end == RunEnd::small_gap);
  if (!collapsed && run.end != RunEnd::reached) return {};
  if (compare_ == Compare::gap)  // in a collapse, proved or not, gaps fall below any
    return std::string(collapsed ? end_row(RunEnd::small_gap).text : "no gap so small");
  if (compare_ == Compare::collapse || collapsed) return std::string(collapsed ? end_row(run.end).text : no_collapse);
  if (compare_ == Compare::collisions) return fmt::format("{} collisions", run.collisions);
  if (compare_ == Compare::merges) return fmt::format("{} merges", run.merges);
  if (at_low_.initial.type == InitialType::clusters)
    return run.collisions == 0 ? "no meeting" : run.merges > 0 ? "they stick" : "they pass";
  const auto regime = std::ranges::find(run.summary, "regime", &std::pair<std::string, double>::first);
  constexpr std::array regimes{"no pair", "apart", "they pass", "they stick"};
  return regimes.at(regime == run.summary.end() ? 0 : static_cast<std::size_t>(regime->second));
}

std::uint64_t ThresholdProblem::identity() const {
  const auto of = compare_ == Compare::gap ? what().text : what().name;  // earlier, gaps had two outcomes
  std::string text = fmt::format("{}\n{}\n{}\n{} {}\n", version, key_, of, wide_, wide_digits());
  for (const Decimal& end : {low_, high_}) text += end.text + '\n' + effective_toml(scene_at(end, false).value());
  return crc64(text);
}

std::string ThresholdProblem::command(const std::string& scene_file) const {
  std::string text = fmt::format("threshold {} --vary {} --digits {} --outcome {}", shell_word(scene_file),
                                 shell_word(vary_), digits_, what().name);
  for (const std::string& assignment : overrides_) text += " --set " + shell_word(assignment);
  return text;
}

}  // namespace cradle::tools
