#include "cradle/tools/ensemble/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "cradle/tools/run/in_precision.hpp"
#include "cradle/tools/run/schedule.hpp"

namespace cradle::tools {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Times {
  std::vector<double> series, profiles;
};

// As runs write them: rounded from the working precision.
Times planned_times(const Scene& scene) {
  return in_precision<Times>(scene, [&]<class T>(std::type_identity<T>) {
    const Schedule<T> plan = schedule<T>(scene);
    Times times;
    for (const T& time : plan.series) times.series.push_back(to_double(time));
    for (const T& time : plan.profiles) times.profiles.push_back(to_double(time));
    return times;
  });
}

bool of_series(const std::string& group) { return group == "series" || group.starts_with("series/"); }

const Column* find(const Group* group, const std::string& name) {
  if (group == nullptr) return nullptr;
  for (const Column& column : group->columns)
    if (column.name == name) return &column;
  return nullptr;
}

const Column& get(const Result& result, const std::string& group, const std::string& name) {
  if (const Column* column = find(result.find(group), name)) return *column;
  throw std::logic_error(fmt::format("a run recorded no {}/{}, which others of its scene have", group, name));
}

double at(const Numbers& values, std::size_t i) {
  return std::visit([i](const auto& v) { return static_cast<double>(v[i]); }, values);
}

// How many samples a run took at planned times: all, unless it ended early; its last one is then where it ended.
std::size_t samples_taken(const Column& time, const std::vector<double>& planned) {
  std::size_t taken = std::min(time.rows(), planned.size());
  if (taken > 0 && at(time.values, taken - 1) != planned[taken - 1]) --taken;
  return taken;
}

Scene at_start(Scene scene) {
  scene.run.until = scene.run.start;
  scene.output.series = {};
  scene.output.series.times = {scene.run.start};
  if (!scene.output.profiles.times.empty()) scene.output.profiles.times = {scene.run.start};
  if (scene.output.zone.from) scene.output.zone.from = scene.run.start;
  return scene;
}

// What runs say of themselves: see run_in.hpp.
const std::array<std::string, outcome_count> outcomes{"reached the end", "inelastic collapse", "order of contacts lost",
                                                      "resolution exhausted", "failed"};

ReplicaOutcome outcome_of(const RunOutcome& run) {
  const auto& text = attribute<std::string>(run.result.attributes, "outcome", "a replica");
  const auto found = std::find(outcomes.begin(), outcomes.end(), text);
  if (found == outcomes.end()) throw std::logic_error("a run ended in a way that ensembles do not know: " + text);
  return static_cast<ReplicaOutcome>(found - outcomes.begin());
}

bool ended_early(ReplicaOutcome outcome) {
  return outcome == ReplicaOutcome::collapsed || outcome == ReplicaOutcome::exhausted;
}

// Bodies that lose energy and do not stick may collapse; elsewhere a column for it would be empty for good.
bool may_collapse(const Scene& scene) {
  return scene.law.type == LawType::inelastic && scene.run.collapse == CollapsePolicy::stop;
}

constexpr const char* collapse_time = "collapse_time";

}  // namespace

const std::string& outcome_text(ReplicaOutcome outcome) { return outcomes.at(static_cast<std::size_t>(outcome)); }

Scene replica_scene(const Scene& scene, std::uint64_t index) {
  Scene replica = scene;
  replica.initial.replica = index;
  replica.output.snapshots.clear();
  replica.output.masses.clear();
  replica.output.events = false;
  replica.output.checkpoint_every = Decimal("0");
  return replica;
}

void check_ensemble(const Scene& scene) {
  check_built(scene);
  if (scene.initial.replica != 0)
    throw Error({"", 0, "initial.replica"}, "an ensemble numbers its replicas itself",
                fmt::format("{}", scene.initial.replica), "remove this key and give --first");
  if (!scene.output.profiles.times.empty() && scene.output.profiles.range.empty())
    throw Error({"", 0, "output.profiles.range"}, "missing", "",
                "give two positions: profiles are averaged over bins that all replicas share");
}

ReplicaLayout replica_layout(const Scene& scene) {
  check_ensemble(scene);
  const Times times = planned_times(scene);
  const RunOutcome run = run_scene(at_start(replica_scene(scene, 0)), {Progress::Show::never});
  const Result& probe = run.result;
  ReplicaLayout layout;
  const auto add = [&](const Column& column, const std::string& group, std::size_t rows) {
    layout.quantities.push_back(
        {group, column.name, column.unit, column.description, layout.entries, rows, column.width});
    layout.entries += layout.quantities.back().size();
  };
  layout.time = get(probe, "series", "time");
  layout.time.values = times.series;
  for (const Group& group : probe.groups)
    for (const Column& column : group.columns)
      if (of_series(group.name) && column.name != "time" && !column.names) add(column, group.name, times.series.size());
  const auto add_binned = [&](const std::string& of_probe, const std::string& group,
                              std::vector<Attribute> attributes) {
    layout.binned.push_back({group, std::move(attributes), get(probe, of_probe, "x")});
    for (const Column& column : probe.find(of_probe)->columns)
      if (column.name != "x") add(column, group, column.rows());
  };
  for (std::size_t k = 0; k < times.profiles.size(); ++k)
    add_binned("profiles/0000", fmt::format("profiles/{:04}", k), {{"time", times.profiles[k]}});
  if (scene.output.zone.from)
    add_binned("zone", "zone", {{"from", scene.output.zone.from->value}, {"until", scene.run.until.value}});
  layout.numbers.push_back({"energy", "m l^2/t^2", "kinetic energy at the end", {}});
  if (may_collapse(scene))
    layout.numbers.push_back({collapse_time, "t", "time of inelastic collapse; NaN: there was none", {}});
  for (const auto& [name, value] : run.summary) layout.numbers.push_back({name, "", "of the whole run", {}});
  return layout;
}

ReplicaRow ReplicaLayout::row(std::uint64_t index, const RunOutcome& run) const {
  ReplicaRow row{index, outcome_of(run), run.contacts, run.merges, std::vector<double>(numbers.size(), none)};
  const auto put = [&](const std::string& name, double value) {
    for (std::size_t k = 0; k < numbers.size(); ++k)
      if (numbers[k].name == name) return void(row.numbers[k] = value);
    throw std::logic_error("a run told a number that others of its scene do not: " + name);
  };
  put("energy", run.energy);
  if (const Group* collapse = run.result.find("collapse"))
    put(collapse_time, attribute<double>(collapse->attributes, "time", "a replica"));
  for (const auto& [name, value] : run.summary) put(name, value);
  return row;
}

std::vector<double> ReplicaLayout::values(const RunOutcome& run) const {
  std::vector<double> numbers_of_run(entries, none);
  const std::size_t samples =
      samples_taken(get(run.result, "series", "time"), std::get<std::vector<double>>(time.values));
  const bool early = ended_early(outcome_of(run));
  if (!early && samples != time.rows()) throw std::logic_error("a run that reached its end has not taken all samples");
  for (const Quantity& quantity : quantities) {
    const bool series = of_series(quantity.group);
    if (!series && early && run.result.find(quantity.group) == nullptr) continue;  // ended before this profile
    const Column& column = get(run.result, quantity.group, quantity.name);
    const std::size_t rows = series ? samples : quantity.rows;
    if (column.width != quantity.width || column.rows() < rows)
      throw std::logic_error(
          fmt::format("{}/{} is not of the size that others of its scene have", quantity.group, quantity.name));
    for (std::size_t i = 0; i < rows * quantity.width; ++i) numbers_of_run[quantity.offset + i] = at(column.values, i);
  }
  return numbers_of_run;
}

}  // namespace cradle::tools
