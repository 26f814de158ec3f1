#include "cradle/tools/ensemble/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "cradle/tools/record/schedule.hpp"

namespace cradle::tools {

namespace {

[[noreturn]] void no_record_of(const std::string& group, const std::string& name) {
  throw std::logic_error(fmt::format("a run recorded no {}/{}, which others of its scene have", group, name));
}

double at(const Numbers& values, std::size_t i) {
  if (const auto* whole = std::get_if<std::vector<std::uint64_t>>(&values)) return static_cast<double>((*whole)[i]);
  return std::get<std::vector<double>>(values)[i];
}

// How many samples a run took at planned times. A run that ended early has an additional sample at its end.
std::size_t samples_taken(const std::vector<double>& time, const std::vector<double>& planned) {
  std::size_t taken = std::min(time.size(), planned.size());
  if (taken > 0 && time[taken - 1] != planned[taken - 1]) --taken;
  return taken;
}

constexpr const char* collapse_time = "collapse_time";

}  // namespace

Scene replica_scene(const Scene& scene, std::uint64_t index) {
  Scene replica = scene;
  replica.initial.replica = index;
  for (const MeasurementRow* row : measurement_rows())
    if (!row->averaged && !(row->kept && scene.output.every_replica)) row->leave_out(replica.output);
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
  const Schedule plan(scene);
  ReplicaLayout layout;
  const auto add = [&](const Column& column, const std::string& group, std::size_t rows,
                       std::optional<std::size_t> number = {}) {
    layout.quantities.push_back(
        {group, column.name, column.unit, column.description, layout.entries, rows, column.width, number});
    layout.entries += layout.quantities.back().size();
  };
  std::vector<std::pair<std::size_t, const MeasurementRow*>> rows;  // that ensembles average, with their numbers
  for (const MeasurementRow* row : measurement_rows())
    if (row->averaged && row->wanted(scene)) rows.emplace_back(row_number(row->name), row);
  for (const auto& [number, row] : rows)
    for (const Group& group : row->growing ? row->growing(scene) : std::vector<Group>())
      for (std::size_t k = 0; k < group.columns.size(); ++k)
        if (const Column& column = group.columns[k]; column.name == "time")
          layout.time = column;  // the first column of "series"
        else if (!column.names)
          add(column, group.name, plan.series().size(), group.name == "series" ? std::optional(k) : std::nullopt);
  layout.time.values = plan.series().rounded();
  const auto add_binned = [&](const Group& table, const std::string& group, std::vector<Attribute> attributes) {
    layout.binned.push_back({group, std::move(attributes), {}});
    std::vector<Column>& bins = layout.binned.back().bins;
    for (const Column& column : table.columns)
      if (column.rows() > 0)
        bins.push_back(column);
      else if (!column.name.ends_with("_sem"))  // of one run; the replicas have one of their own
        add(column, group, bins.front().rows());
  };
  for (const auto& [number, row] : rows)
    if (row->table_at)
      for (std::size_t k = 0; const double time : plan.of[number].tables.rounded())
        add_binned(row->table_at(scene), fmt::format("{}/{:04}", row->name, k++), {{"time", time}});
  for (const auto& [number, row] : rows)
    if (row->tables_at_end)
      for (const Group& table : row->tables_at_end(scene)) add_binned(table, table.name, table.attributes);
  layout.numbers.push_back({"energy", "m l^2/t^2", "kinetic energy at the end", {}});
  if (stops_at_collapse(scene))
    layout.numbers.push_back({collapse_time, "t", "time of inelastic collapse; NaN: there was none", {}});
  for (const auto& [number, row] : rows)
    if (row->summary)
      for (const std::string& name : row->summary(scene)) layout.numbers.push_back({name, "", "of the whole run", {}});
  return layout;
}

void ReplicaLayout::put_row(std::uint64_t index, const RunOutcome& run, ReplicaRow& row) const {
  row.index = index, row.collisions = run.collisions, row.merges = run.merges;
  row.outcome = end_row(run.end).status == Exit::collapse ? RunEnd::collapsed : run.end;
  row.numbers.assign(numbers.size(), missing);
  row.numbers.front() = run.energy;
  const auto put = [&](std::string_view name, double value) {
    for (std::size_t k = 1; k < numbers.size(); ++k)
      if (numbers[k].name == name) return void(row.numbers[k] = value);
    throw std::logic_error(fmt::format("a run recorded a number that others of its scene do not: {}", name));
  };
  if (run.collapsed_at) put(collapse_time, *run.collapsed_at);
  for (const auto& [name, value] : run.summary) put(name, value);
}

std::vector<double> ReplicaLayout::values(const RunOutcome& run) const {
  SeriesNumbers series;
  if (const Group* table = run.result.find("series"))
    for (const Column& column : table->columns) {
      series.emplace_back();
      for (std::size_t i = 0; i < column.rows() * column.width; ++i) series.back().push_back(at(column.values, i));
    }
  std::vector<double> numbers_of_run;
  put_values(run.end, series, run.result.groups, numbers_of_run);
  return numbers_of_run;
}

void ReplicaLayout::put_values(RunEnd end, const SeriesNumbers& series, const std::vector<Group>& tables,
                               std::vector<double>& values) const {
  values.assign(entries, missing);
  if (series.empty()) no_record_of("series", "time");
  const std::size_t samples = samples_taken(series.front(), std::get<std::vector<double>>(time.values));
  const bool early = end_row(end).status == Exit::collapse || end == RunEnd::exhausted;
  if (!early && samples != time.rows()) throw std::logic_error("a run that reached its end has not taken all samples");
  const auto wrong = [](const Quantity& of) {
    return std::logic_error(fmt::format("{}/{} is not of the size that others of its scene have", of.group, of.name));
  };
  for (const Quantity& quantity : quantities) {
    double* const to = values.data() + quantity.offset;
    if (quantity.column) {
      if (*quantity.column >= series.size() || series[*quantity.column].size() < samples) throw wrong(quantity);
      std::copy_n(series[*quantity.column].begin(), samples, to);
      continue;
    }
    const auto table = std::ranges::find(tables, quantity.group, &Group::name);
    const bool of_times = quantity.group == "series" || quantity.group.starts_with("series/");
    if (!of_times && early && table == tables.end()) continue;  // the run ended before this profile
    const Column* column = table == tables.end() ? nullptr : table->find(quantity.name);
    if (column == nullptr) no_record_of(quantity.group, quantity.name);
    const std::size_t rows = of_times ? samples : quantity.rows;
    if (column->width != quantity.width || column->rows() < rows) throw wrong(quantity);
    for (std::size_t i = 0; i < rows * quantity.width; ++i) to[i] = at(column->values, i);
  }
}

}  // namespace cradle::tools
