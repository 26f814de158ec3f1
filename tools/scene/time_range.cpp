// A range of times is read before anything else is known of its scene: its ends may be run.start and run.until.
#include <fmt/format.h>

#include <algorithm>
#include <compare>
#include <optional>

#include "cradle/tools/scene/checks.hpp"

namespace cradle::tools {
namespace {

constexpr std::string_view advice_on_parts = "give from, until and every, or from, until, points and spacing";

class TimeRange {
 public:
  // `first`: one of the entries of the table `key`.
  TimeRange(const Entries& entries, std::string key, const Value& first)
      : entries_(entries), key_(std::move(key)), table_{first.place.source, first.place.line, key_} {}

  // The list; nothing if an end of the range is that of a run which has none, as the reader will report.
  std::optional<Value> list() const {
    refuse_unknown();
    const Value *every = part("every"), *points = part("points"), *spacing = part("spacing");
    if (every != nullptr && points != nullptr)
      throw Error(points->place, "two ways to divide a range of times", "every and points", "remove one of them");
    if (every == nullptr && points == nullptr)
      throw Error(table_, "a range of times that is not divided", "neither every nor points",
                  std::string(advice_on_parts));
    if (every != nullptr && spacing != nullptr)
      throw Error(spacing->place, "spacing of a range that every divides", describe(*spacing),
                  "remove it, or give points instead of every");
    const auto from = end("from", "run.start", "0"), until = end("until", "run.until", "");
    if (!from || !until) return {};
    if (*until < *from)
      throw Error(place("until"), "a range of times that ends before it begins",
                  fmt::format("from {} until {}", from->text, until->text), "give from the lower time");
    return value(every != nullptr ? by_step(*from, *until, *every) : by_points(*from, *until, *points, spacing));
  }

 private:
  const Value* part(std::string_view name) const {
    const auto entry = entries_.find(fmt::format("{}.{}", key_, name));
    return entry == entries_.end() ? nullptr : &entry->second;
  }
  Place place(std::string_view name) const {
    const Value* value = part(name);
    return value == nullptr ? table_ : value->place;
  }

  void refuse_unknown() const {
    constexpr std::string_view parts[] = {"from", "until", "every", "points", "spacing"};
    for (auto entry = entries_.lower_bound(key_ + '.'); entry != entries_.end() && entry->first.starts_with(key_ + '.');
         ++entry)
      if (std::ranges::find(parts, std::string_view(entry->first).substr(key_.size() + 1)) == std::end(parts))
        throw Error(entry->second.place, "unknown key in a range of times", describe(entry->second),
                    std::string(advice_on_parts));
  }

  static Decimal number(const Value& value) {
    const bool scalar = value.kind == Value::Kind::number || value.kind == Value::Kind::text;
    const auto literal = scalar ? canonical_decimal(value.text) : std::nullopt;
    if (!literal) throw Error(value.place, "not a decimal number", describe(value), "give a number");
    return Decimal(*literal);
  }

  std::optional<Decimal> end(std::string_view name, std::string_view of_run, std::string_view fallback) const {
    if (const Value* given = part(name)) return number(*given);
    const auto entry = entries_.find(of_run);
    const auto literal = canonical_decimal(entry == entries_.end() ? fallback : std::string_view(entry->second.text));
    return literal ? std::optional(Decimal(*literal)) : std::nullopt;
  }

  static DecimalColumn by_step(const Decimal& from, const Decimal& until, const Value& every) {
    const Decimal step = number(every);
    if (!(step > Decimal("0"))) throw Error(every.place, "out of range", step.text, "give a number above 0");
    const auto steps = static_cast<double>(bin_float((precise(until) - precise(from)) / precise(step)));
    if (!(steps < most))
      throw Error(every.place, "too many times", fmt::format("{}, which makes {:.3g} of them", step.text, steps),
                  fmt::format("give a longer time, {:.0g} times at most", most));
    if (!of_one_scale(from, step, until))
      throw Error(every.place, "times of thousands of digits", step.text, "give from, until and every fewer digits");
    return decimals_by_step(from, step, until);
  }

  DecimalColumn by_points(const Decimal& from, const Decimal& until, const Value& points, const Value* spacing) const {
    const auto given = decimal_integer(number(points).text);
    if (!given || *given < 2 || static_cast<double>(*given) > most)
      throw Error(points.place, "out of range", number(points).text,
                  fmt::format("give an integer from 2 to {:.0g}", most));
    const bool log = spacing != nullptr && spacing->text == "log";
    if (spacing != nullptr && !log && spacing->text != "linear")
      throw Error(spacing->place, "no such choice", describe(*spacing), "give one of linear, log");
    if (log && !(from > Decimal("0")))
      throw Error(place("from"), "equal ratios from a time that is not above 0", from.text,
                  "give from a time above 0, or spacing = \"linear\"");
    const auto last = static_cast<std::int64_t>(*given) - 1;
    const bin_float first = precise(from), span = precise(until) - first, ratio = log ? precise(until) / first : span;
    constexpr int digits = 15;
    DecimalColumn times{from.text};
    for (std::int64_t k = 1; k <= last; ++k) {
      const bin_float part = bin_float(k) / bin_float(last);
      const bin_float time = log ? bin_float(first * pow(ratio, part)) : bin_float(first + span * part);
      times.push_back(k == last ? until.text : Decimal(time.str(digits)).text);
      if (std::is_lt(compare_decimals(times[times.size() - 2], times.back()))) continue;
      throw Error(points.place, "times closer to each other than 15 digits resolve",
                  fmt::format("{} from {} until {}", *given, from.text, until.text),
                  "give fewer points, a longer range, or every");
    }
    return times;
  }

  // Times outside the run are reported as those of the end which is outside.
  Value value(const DecimalColumn& times) const {
    Value list{Value::Kind::array, "", {}, place("until")};
    list.place.key = key_;
    list.items.reserve(times.size());
    for (std::size_t k = 0; k < times.size(); ++k)
      list.items.push_back({Value::Kind::number, std::string(times[k]), {}, place(k == 0 ? "from" : "until")});
    return list;
  }

  static constexpr double most = 1e6;

  const Entries& entries_;
  std::string key_;
  Place table_;
};

}  // namespace

bool takes_times(const Field& field) { return field.unit == "t" && type_name(field).starts_with("list of numbers"); }

void expand_time_ranges(Entries& entries) {
  for (const Field& field : scene_fields()) {
    if (!takes_times(field)) continue;
    const std::string key(field.key), inside = key + '.';
    const auto first = entries.lower_bound(inside);
    if (first == entries.end() || !first->first.starts_with(inside)) continue;
    const auto list = TimeRange(entries, key, first->second).list();
    std::erase_if(entries, [&](const auto& entry) { return entry.first.starts_with(inside); });
    if (list) entries.insert_or_assign(key, *list);
  }
}

}  // namespace cradle::tools
