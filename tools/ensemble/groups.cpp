// An ensemble in a result file: statistics for readers, and the nodes of the tree of replicas with every bit, so that
// it can be continued and merged. The contents depend only on the set of replicas.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "cradle/tools/ensemble/state.hpp"

namespace cradle::tools {

namespace {

Error lacking(const std::string& file, std::string_view what) {
  return {{file},
          "not an ensemble, or a damaged one",
          fmt::format("no {}", what),
          "give a file that `cradle ensemble` or `cradle merge` wrote",
          Exit::io};
}

const Group& get(const Result& result, std::string_view name, const std::string& file) {
  if (const Group* group = result.find(name)) return *group;
  throw lacking(file, name);
}

template <class T> const std::vector<T>& get(const Group& group, std::string_view name, const std::string& file) {
  if (const Column* column = group.find(name))
    if (const auto* values = std::get_if<std::vector<T>>(&column->values)) return *values;
  throw lacking(file, fmt::format("{}/{}", group.name, name));
}

std::string node_name(std::size_t k) { return fmt::format("ensemble/nodes/{:04}", k); }

Group node_group(const TreeNode& node, std::string name) {
  const Moments& m = node.moments;
  Group group{std::move(name),
              {{"first", node.first}, {"level", std::uint64_t{node.level}}, {"replicas", m.replicas}},
              {{"mean", "", "mean of each entry", m.mean},
               {"squares", "", "sum of squared deviations from the mean", m.squares},
               {"least", "", "least of each entry", m.least},
               {"greatest", "", "greatest of each entry", m.greatest}}};
  if (!m.complete()) group.columns.push_back({"counts", "1", "replicas that have the entry", m.counts});
  return group;
}

TreeNode read_node(const Group& group, const std::string& file) {
  const auto level = attribute<std::uint64_t>(group.attributes, "level", file);  // one too large stays too large
  TreeNode node{attribute<std::uint64_t>(group.attributes, "first", file),
                static_cast<unsigned>(std::min<std::uint64_t>(level, 64)),
                {}};
  Moments& m = node.moments;
  m.replicas = attribute<std::uint64_t>(group.attributes, "replicas", file);
  m.mean = get<double>(group, "mean", file);
  m.squares = get<double>(group, "squares", file);
  m.least = get<double>(group, "least", file);
  m.greatest = get<double>(group, "greatest", file);
  if (group.find("counts") != nullptr) m.counts = get<std::uint64_t>(group, "counts", file);
  return node;
}

}  // namespace

Group statistics_group(std::string name, const Quantity& quantity, const Moments& total) {
  std::vector<double> mean, sem, least, greatest;
  std::vector<std::uint64_t> counts;
  bool all_have_all = true;
  for (std::size_t i = quantity.offset; i < quantity.offset + quantity.size(); ++i) {
    const std::uint64_t count = total.replicas > 0 ? total.count(i) : 0;
    mean.push_back(count > 0 ? total.mean[i] : missing);
    sem.push_back(count > 0 ? total.standard_error(i) : missing);
    least.push_back(count > 0 ? total.least[i] : missing);
    greatest.push_back(count > 0 ? total.greatest[i] : missing);
    counts.push_back(count);
    all_have_all = all_have_all && count == total.replicas;
  }
  const std::size_t width = quantity.width;
  Group group{std::move(name),
              {},
              {{"mean", quantity.unit, "mean over replicas: " + quantity.description, std::move(mean), width},
               {"sem", quantity.unit, "standard error of the mean", std::move(sem), width},
               {"min", quantity.unit, "least of all replicas", std::move(least), width},
               {"max", quantity.unit, "greatest of all replicas", std::move(greatest), width}}};
  if (!all_have_all) group.columns.push_back({"count", "1", "replicas that have it", std::move(counts), width});
  return group;
}

Group EnsembleState::quantity_group(const Quantity& quantity, const Moments& total) const {
  Group group = statistics_group(name("ensemble/" + quantity.group + "/" + quantity.name), quantity, total);
  group.attributes = {{"offset", std::uint64_t{quantity.offset}}};
  return group;
}

Group EnsembleState::spread_group(const Spread& spread, const Moments& total) const {
  const auto& [quantity, counts] = spread;
  const FixedBins& bins = counts.bins();
  std::vector<double> edges;
  for (std::size_t e = 0; e <= bins.bins; ++e) edges.push_back(bins.edge(e));
  Group group{
      name("ensemble/spread/" + quantity.group + "/" + quantity.name),
      {{"from", bins.from}, {"to", bins.to}, {"bins", std::uint64_t{bins.bins}}},
      {{"edges", quantity.unit, "edges of the bins", std::move(edges)},
       {"counts", "1", "replicas below the bins, in each of them, above them", counts.all_counts(), bins.bins + 2}}};
  for (const int percent : {5, 25, 50, 75, 95}) {
    std::vector<double> quantiles;
    for (std::size_t entry = 0; entry < counts.entries(); ++entry) {
      const std::size_t i = quantity.offset + entry;
      quantiles.push_back(total.replicas > 0
                              ? counts.quantile(entry, percent / 100.0, total.least[i], total.greatest[i])
                              : counts.quantile(entry, percent / 100.0));
    }
    group.columns.push_back({fmt::format("quantile_{:02}", percent), quantity.unit,
                             fmt::format("{} % of the replicas are below, to the width of a bin", percent),
                             std::move(quantiles), quantity.width});
  }
  return group;
}

Group EnsembleState::replica_group() const {
  const std::vector<std::size_t> rows = table_.order();
  const auto of_rows = [&](auto of) { return numbers_of(rows, of); };
  std::string outcomes;
  for (std::size_t k = 0; k < outcome_count; ++k)
    outcomes += fmt::format("{}{} {}", k == 0 ? "" : ", ", k, run_ends[k].text);
  Group group{name("replicas"), {}, {}};
  const auto add = [&](const char* column, const std::string& text, auto of) {
    group.columns.push_back({column, "1", text, of_rows([&, of](std::size_t row) {
                               return static_cast<std::uint64_t>(std::invoke(of, table_, row));
                             })});
  };
  add("index", "initial.replica of the run", &ReplicaTable::index);
  add("outcome", outcomes, &ReplicaTable::outcome);
  add("collisions", "collisions until the end", &ReplicaTable::collisions);
  add("merges", "merges until the end", &ReplicaTable::merges);
  for (std::size_t i = 0; i < layout_.numbers.size(); ++i) {
    group.columns.push_back(layout_.numbers[i]);
    group.columns.back().values = of_rows([&, i](std::size_t row) { return table_.number(row, i); });
  }
  return group;
}

std::vector<Group> EnsembleState::groups() const {
  const Moments total = tree_.total();
  const auto failed = failures();
  std::vector<Group> groups{
      {name("ensemble"), {{"replicas", tree_.size()}, {"failed", std::uint64_t{failed.size()}}}, {}}};
  if (!group_.empty()) groups.back().attributes.emplace_back("scene", effective_toml(scene_));
  groups.push_back({name("ensemble/series"), {}, {layout_.time}});
  auto binned = layout_.binned.begin();
  for (const Quantity& quantity : layout_.quantities) {
    if (binned != layout_.binned.end() && quantity.group == binned->group) {
      groups.push_back({name("ensemble/" + binned->group), binned->attributes, binned->bins});
      ++binned;
    }
    groups.push_back(quantity_group(quantity, total));
  }
  for (const Spread& spread : spreads_) groups.push_back(spread_group(spread, total));
  groups.push_back(replica_group());
  if (!failed.empty()) {
    std::vector<std::uint64_t> index;
    std::string messages;
    for (const auto& [replica, message] : failed) {
      index.push_back(replica);
      messages += fmt::format("{}replica {}: {}", messages.empty() ? "" : "\n", replica, message);
    }
    groups.push_back({name("replicas/failed"),
                      {{"messages", messages}},
                      {{"index", "1", "initial.replica of the runs that failed", std::move(index)}}});
  }
  for (Group& table : joined_tables(kept_, name(""))) groups.push_back(std::move(table));
  groups.push_back({name("ensemble/nodes"),
                    {{"entries", std::uint64_t{layout_.entries}},
                     {"what", std::string("sets of 2^level replicas from `first` on, for continuation and merging")}},
                    {}});
  const std::vector<TreeNode> nodes = tree_.nodes();
  for (std::size_t k = 0; k < nodes.size(); ++k) groups.push_back(node_group(nodes[k], name(node_name(k))));
  return groups;
}

void EnsembleState::read(const Result& result, const std::string& file) {
  for (std::size_t k = 0; const Group* group = result.find(name(node_name(k))); ++k)
    take(read_node(*group, file), file);
  const Group& table = get(result, name("replicas"), file);
  const auto &index = get<std::uint64_t>(table, "index", file), &outcome = get<std::uint64_t>(table, "outcome", file),
             &collisions = get<std::uint64_t>(table, "collisions", file),
             &merges = get<std::uint64_t>(table, "merges", file);
  std::vector<const std::vector<double>*> numbers;
  for (const Column& column : layout_.numbers) numbers.push_back(&get<double>(table, column.name, file));
  for (const Column& column : table.columns)
    if (column.rows() != index.size()) throw damaged_ensemble({file}, "columns of /replicas of different lengths");
  std::set<ReplicaIndex> stopped;
  for (std::size_t k = 0; k < index.size(); ++k) {
    const auto how = static_cast<RunEnd>(std::min<std::uint64_t>(outcome[k], outcome_count - 1));
    ReplicaRow row{index[k], how, collisions[k], merges[k], {}};
    for (const auto* column : numbers) row.numbers.push_back((*column)[k]);
    table_.add(row);
    if (how == RunEnd::failed) stopped.insert(index[k]);
  }
  check_replicas(file);
  if (const Group* failed = result.find(name("replicas/failed"))) {
    std::istringstream lines(attribute<std::string>(failed->attributes, "messages", file));
    for (const std::uint64_t replica : get<std::uint64_t>(*failed, "index", file)) {
      std::string line;
      std::getline(lines, line);
      const auto colon = line.find(": ");
      if (stopped.contains(replica)) messages_.emplace(replica, colon == line.npos ? line : line.substr(colon + 2));
    }
  }
  kept_ = separated_tables(result, name(""), file);
  for (std::size_t k = 0; k < spreads_.size(); ++k)
    take_counts(k, get<std::uint64_t>(get(result, spread_group(spreads_[k], {}).name, file), "counts", file), file);
}

}  // namespace cradle::tools
