#include "cradle/tools/ensemble/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "cradle/precision/read_number.hpp"

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

std::optional<double> to_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = read_number(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

struct Varied {
  std::string key;
  std::vector<std::string> values;
};

Varied varied(const std::string& text) {
  const auto wrong = [&](const std::string& what) {
    return Error({"", 0, "--vary"}, what, text, "give KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or KEY=VALUE,VALUE,...");
  };
  const auto equals = text.find('=');
  if (equals == text.npos || equals == 0 || equals + 1 == text.size()) throw wrong("not a key and values");
  Varied result{text.substr(0, equals), {}};
  const std::string values = text.substr(equals + 1);
  const auto parts = split(values, ':');
  if (parts.size() == 1) {
    result.values = split(values, ',');
    return result;
  }
  const bool logarithmic = parts.size() == 4 && parts[3] == "log";
  if (parts.size() != 3 && !logarithmic) throw wrong("not a range of values");
  const auto from = to_number(parts[0]), to = to_number(parts[1]), count = to_number(parts[2]);
  if (!from || !to || !count || *count < 2 || *count > 1e6 || *count != std::floor(*count))
    throw wrong("not a range of 2 values or more");
  if (logarithmic && !(*from > 0 && *to > 0)) throw wrong("no logarithms of these ends");
  const auto last = static_cast<int>(*count) - 1;
  for (int k = 0; k <= last; ++k) {
    const double share = static_cast<double>(k) / last;
    const double value = logarithmic ? *from * std::pow(*to / *from, share) : *from + (*to - *from) * share;
    // Twelve digits: 0.1 + 0.2 is to be 0.3.
    result.values.push_back(k == 0 ? parts[0] : k == last ? parts[1] : fmt::format("{:.12g}", value));
  }
  return result;
}

SweepPoint given_point(const std::string& text) {
  SweepPoint point;
  for (const std::string& assignment : split(text, ' ')) {
    if (assignment.empty()) continue;
    const auto equals = assignment.find('=');
    if (equals == assignment.npos || equals == 0)
      throw Error({"", 0, "--point"}, "not keys and values", text, "give KEY=VALUE KEY=VALUE ...");
    point.emplace_back(assignment.substr(0, equals), assignment.substr(equals + 1));
  }
  return point;
}

std::string label(const SweepPoint& point) {
  std::string text;
  for (const auto& [key, value] : point) text += (text.empty() ? "" : " ") + key + "=" + value;
  return text;
}

// Columns of numbers, one row per point, appended as they come up; NaN where a point has none.
class Table {
 public:
  explicit Table(std::size_t points) : points_(points) {}
  void put(std::size_t point, const std::string& name, const std::string& unit, const std::string& description,
           double value) {
    const auto [place, fresh] = places_.try_emplace(name, columns_.size());
    if (fresh) {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      columns_.push_back({name, unit, description, std::vector<double>(points_, none)});
    }
    std::get<std::vector<double>>(columns_[place->second].values)[point] = value;
  }
  std::vector<Column> columns() && { return std::move(columns_); }

 private:
  std::size_t points_;
  std::vector<Column> columns_;
  std::map<std::string, std::size_t> places_;
};

// In the order of the replicas' indices: the same bits however they came about.
void put_mean(Table& table, std::size_t point, const Column& about, const std::vector<double>& values) {
  double n = 0, mean = 0, squares = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    n += 1;
    const double before = value - mean;
    mean += before / n;
    squares += before * (value - mean);
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  table.put(point, about.name, about.unit, "mean over replicas: " + about.description, n > 0 ? mean : none);
  table.put(point, about.name + "_error", about.unit, "standard error of that mean",
            n > 1 ? std::sqrt(squares / (n * (n - 1))) : none);
  table.put(point, about.name + "_replicas", "1", "replicas that have this number", n);
}

Group summary(const std::vector<SweepPoint>& points, const EnsembleStates& states) {
  Table table(points.size());
  Group group{"sweep", {}, {}};
  for (std::size_t p = 0; p < points.size(); ++p) {
    group.attributes.emplace_back(fmt::format("label_{:04}", p), label(points[p]));
    for (const auto& [key, value] : points[p])
      if (const auto number = to_number(value)) table.put(p, key, "", "varied", *number);
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    const EnsembleState& state = *states[p];
    const auto& replicas = state.table();
    table.put(p, "replicas", "1", "replicas that ended", static_cast<double>(replicas.size()));
    const auto order = replicas.order();
    const auto mean = [&](const Column& about, auto of) {
      std::vector<double> values;
      for (const std::size_t k : order) values.push_back(of(replicas[k]));
      put_mean(table, p, about, values);
    };
    mean({"contacts", "1", "contacts", {}}, [](const ReplicaRow& row) { return static_cast<double>(row.contacts); });
    mean({"merges", "1", "merges", {}}, [](const ReplicaRow& row) { return static_cast<double>(row.merges); });
    const auto& numbers = state.layout().numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      mean(numbers[i], [i](const ReplicaRow& row) { return row.numbers[i]; });
  }
  group.columns = std::move(table).columns();
  return group;
}

}  // namespace

std::vector<SweepPoint> sweep_points(const Sweep& sweep) {
  std::vector<SweepPoint> points;
  for (const std::string& text : sweep.points) points.push_back(given_point(text));
  std::vector<Varied> keys;
  for (const std::string& text : sweep.vary) keys.push_back(varied(text));
  if (sweep.cuts) {
    for (const Varied& one : keys)
      for (const std::string& value : one.values) points.push_back({{one.key, value}});
  } else if (!keys.empty()) {
    std::vector<SweepPoint> grid(1);
    for (const Varied& one : keys) {
      std::vector<SweepPoint> finer;
      for (const SweepPoint& point : grid)
        for (const std::string& value : one.values) {
          finer.push_back(point);
          finer.back().emplace_back(one.key, value);
        }
      grid = std::move(finer);
    }
    points.insert(points.end(), grid.begin(), grid.end());
  }
  if (points.empty())
    throw Error({"", 0, "--vary"}, "nothing to vary", "",
                "give --vary KEY=FROM:TO:COUNT, or --point, or a scene with a table [sweep]");
  return points;
}

namespace {

// The study of a scene, which names the sweep, with scene_at(point) at each of its points.
template <class SceneAt> Study study_of(Scene scene, SceneAt scene_at) {
  const auto points = sweep_points(scene.sweep);
  Study study;
  study.kind = "sweep";
  study.scene = std::move(scene);
  study.scene.sweep.replicas = 1;  // how many there are is another matter
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::string group = fmt::format("points/{:04}", p);
    study.points.push_back({group, scene_at(points[p], group)});
  }
  study.summary = [points](const EnsembleStates& states) { return std::vector<Group>{summary(points, states)}; };
  return study;
}

}  // namespace

Study sweep_of(const std::string& scene, const std::vector<std::string>& overrides, const Sweep& sweep) {
  Scene varied = read_scene(scene, overrides);
  varied.sweep = sweep;
  return study_of(std::move(varied), [&](const SweepPoint& point, const std::string&) {
    std::vector<std::string> all = overrides;
    for (const auto& [key, value] : point) all.push_back(key + "=" + value);
    Scene at = read_scene(scene, all);
    at.sweep = {};
    at.sweep.replicas = 1;
    return at;
  });
}

Study sweep_in(const Result& result, const std::string& file) {
  Scene scene = parse_scene(attribute<std::string>(result.attributes, "scene", file), file);
  scene.name = attribute<std::string>(result.attributes, "name", file);
  return study_of(scene, [&](const SweepPoint&, const std::string& group) {
    const Group* ensemble = result.find(group + "/ensemble");
    if (ensemble == nullptr)
      throw Error({file, 0, ""}, "a sweep without one of its points", group, "make the file anew", Exit::io);
    Scene at = parse_scene(attribute<std::string>(ensemble->attributes, "scene", file), file);
    at.name = scene.name;
    return at;
  });
}

}  // namespace cradle::tools
