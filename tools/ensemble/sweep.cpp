#include "cradle/tools/ensemble/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cradle/tools/scene/source.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

// The assignments of a key that varies.
std::vector<std::string> varied(const std::string& text, double most) {
  const auto wrong = [&](const std::string& what) {
    return Error({"", 0, "--vary"}, what, text, "give KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or KEY=VALUE,VALUE,...");
  };
  const auto equals = text.find('=');
  if (equals == text.npos || equals == 0 || equals + 1 == text.size()) throw wrong("not a key and values");
  const std::string assign = text.substr(0, equals + 1), values = text.substr(equals + 1);
  const auto parts = split(values, ':');
  std::vector<std::string> all;
  if (parts.size() == 1) {
    for (const std::string& value : split(values, ',')) all.push_back(assign + value);
    return all;
  }
  const bool logarithmic = parts.size() == 4 && parts[3] == "log";
  if (parts.size() != 3 && !logarithmic) throw wrong("not a range of values");
  const auto from = to_number(parts[0]), to = to_number(parts[1]), count = to_number(parts[2]);
  if (!from || !to || !count || *count < 2 || *count > most || *count != std::floor(*count))
    throw wrong("not a range of 2 values or more");
  if (logarithmic && !(*from > 0 && *to > 0)) throw wrong("no logarithms of these ends");
  const auto last = static_cast<int>(*count) - 1;
  for (int k = 0; k <= last; ++k) {
    const double share = static_cast<double>(k) / last;
    const double value = logarithmic ? *from * std::pow(*to / *from, share) : *from + (*to - *from) * share;
    // Twelve digits, so that 0.1 + 0.2 becomes 0.3.
    all.push_back(assign + (k == 0 ? parts[0] : k == last ? parts[1] : fmt::format("{:.12g}", value)));
  }
  return all;
}

SweepPoint given_point(const std::string& text) {
  SweepPoint point;
  for (const std::string& assignment : split(text, ' ')) {
    if (assignment.empty()) continue;
    const auto equals = assignment.find('=');
    if (equals == assignment.npos || equals == 0)
      throw Error({"", 0, "--point"}, "not keys and values", text, "give KEY=VALUE KEY=VALUE ...");
    point.push_back(assignment);
  }
  return point;
}

std::string text_of(const SweepPoint& point) { return fmt::format("{}", fmt::join(point, " ")); }

// Called before memory is allocated. A point of a grid has a value for every key.
void check_count(const std::vector<std::vector<std::string>>& keys, bool cuts, double most) {
  double points = cuts ? 0 : 1;
  for (const auto& one : keys) {
    const auto values = static_cast<double>(one.size());
    points = cuts ? points + values : points * values;
  }
  if (points > most)
    throw Error({"", 0, "--vary"}, "too many points", fmt::format("{:.3g}", points),
                fmt::format("vary fewer keys or give fewer values, {:.0g} points at most", most));
  const double values = points * static_cast<double>(cuts ? 1 : keys.size());
  if (values > 8 * most)
    throw Error({"", 0, "--vary"}, "too many values", fmt::format("{:.3g} in all points", values),
                fmt::format("vary fewer keys or give fewer values, {:.0g} at most", 8 * most));
}

// Columns of numbers, one row per point, added in the order of first use; NaN if a point has no value.
struct Table {
  void put(std::size_t point, const std::string& name, const std::string& unit, const std::string& description,
           double value) {
    auto at = std::ranges::find(columns, name, &Column::name);
    if (at == columns.end()) at = columns.insert(at, {name, unit, description, std::vector<double>(points, missing)});
    std::get<std::vector<double>>(at->values)[point] = value;
  }

  std::size_t points;
  std::vector<Column> columns = {};
};

// Adds in the order of the replicas' indices, so that the bits do not depend on the order of computing.
void put_mean(Table& table, std::size_t point, const Column& about, const std::vector<double>& values) {
  double n = 0, mean = 0, squares = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    n += 1;
    const double before = value - mean;
    mean += before / n;
    squares += before * (value - mean);
  }
  table.put(point, about.name, about.unit, "mean over replicas: " + about.description, n > 0 ? mean : missing);
  table.put(point, about.name + "_error", about.unit, "standard error of that mean",
            n > 1 ? std::sqrt(squares / (n * (n - 1))) : missing);
  table.put(point, about.name + "_replicas", "1", "replicas that have this number", n);
}

}  // namespace

std::optional<double> to_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<SweepPoint> sweep_points(const Sweep& sweep, double most) {
  std::vector<SweepPoint> points;
  for (const std::string& text : sweep.points) points.push_back(given_point(text));
  std::vector<std::vector<std::string>> keys;
  for (const std::string& text : sweep.vary) {
    keys.push_back(varied(text, most));
    check_count(keys, sweep.cuts, most);
  }
  if (sweep.cuts) {
    for (const auto& one : keys)
      for (const std::string& assignment : one) points.push_back({assignment});
  } else if (!keys.empty()) {
    std::vector<SweepPoint> grid(1);
    for (const auto& one : keys) {
      std::vector<SweepPoint> finer;
      for (const SweepPoint& point : grid)
        for (const std::string& assignment : one) {
          finer.push_back(point);
          finer.back().push_back(assignment);
        }
      grid = std::move(finer);
    }
    points.insert(points.end(), grid.begin(), grid.end());
  }
  if (points.empty())
    throw Error({"", 0, "--vary"}, "nothing to vary", "",
                "give --vary KEY=FROM:TO:COUNT, or --point, or a scene with a table [sweep]");
  for (const SweepPoint& point : points)
    for (auto at = point.begin(); at != point.end(); ++at) {
      const auto key = key_of(*at);
      if (std::ranges::find(point.begin(), at, key, key_of) != at)
        throw Error({"", 0, std::string(key)}, "twice in a point of the sweep", text_of(point), "give one of the two");
      if (key.starts_with("sweep."))
        throw Error({"", 0, std::string(key)}, "says how to sweep", text_of(point), "give a key of the system instead");
    }
  return points;
}

Group sweep_summary(const Sweep& sweep, const EnsembleStates& states) {
  const std::vector<SweepPoint> points = sweep_points(sweep);
  Table table{points.size()};
  Group group{"sweep", {}, {}};
  for (std::size_t p = 0; p < points.size(); ++p) {
    group.attributes.emplace_back(fmt::format("label_{:04}", p), text_of(points[p]));
    for (const std::string& assignment : points[p])
      if (const auto number = to_number(assignment.substr(assignment.find('=') + 1)))
        table.put(p, std::string(key_of(assignment)), "", "varied", *number);
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    const EnsembleState& state = *states[p];
    const auto& replicas = state.table();
    table.put(p, "replicas", "1", "replicas that ended", static_cast<double>(replicas.size()));
    table.put(p, "failed", "1", "replicas that failed, lost the order of collisions or exhausted the resolution",
              static_cast<double>(state.failures().size()));
    const auto order = replicas.order();
    const auto mean = [&](const Column& about, auto of) {
      std::vector<double> values;
      for (const std::size_t k : order) values.push_back(static_cast<double>(std::invoke(of, replicas, k)));
      put_mean(table, p, about, values);
    };
    mean({"collisions", "1", "collisions", {}}, &ReplicaTable::collisions);
    mean({"merges", "1", "merges", {}}, &ReplicaTable::merges);
    const auto& numbers = state.layout().numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      mean(numbers[i], [i](const ReplicaTable& all, std::size_t k) { return all.number(k, i); });
  }
  group.columns = std::move(table.columns);
  return group;
}

Study sweep_of(const std::string& scene, const std::vector<std::string>& overrides, const Sweep& sweep) {
  const auto points = sweep_points(sweep);
  Scene varied = read_scene(scene, overrides, points.front());
  varied.sweep = sweep;
  for (const std::string& given : overrides) {
    const auto key = key_of(given);
    const auto sets = [&](const SweepPoint& point) { return std::ranges::find(point, key, key_of) != point.end(); };
    if (std::ranges::all_of(points, sets))
      throw Error({"--set", 0, std::string(key)}, "every point of the sweep sets it too", given,
                  "leave out one of the two");
  }
  Study study{.kind = "sweep", .scene = std::move(varied), .points = {}};
  study.scene.sweep.replicas = 1;  // the number of replicas is not part of the study
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<std::string> all = overrides;
    all.insert(all.end(), points[p].begin(), points[p].end());
    Scene at = read_scene(scene, all);
    at.sweep = {};
    at.sweep.replicas = 1;
    study.points.push_back({fmt::format("points/{:04}", p), std::move(at)});
  }
  return study;
}

}  // namespace cradle::tools
