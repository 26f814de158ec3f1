#include "cradle/tools/store/run_journal.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>

#include "cradle/tools/record/tables.hpp"
#include "cradle/tools/result/result_bytes.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/support/bytes.hpp"

namespace cradle::tools {

namespace {

// Of records, their first number.
constexpr std::uint64_t rows_kind = 1, status_kind = 2;

}  // namespace

std::string RunHeader::bytes() const {
  return ByteWriter().put(version).put(scene).put(name).put(every_seconds).put(number).put(first_stands_for).bytes();
}

RunHeader RunHeader::of(std::string_view bytes) {
  ByteReader reader(bytes);
  RunHeader header;
  header.version = reader.text();
  header.scene = reader.text();
  header.name = reader.text();
  header.every_seconds = reader.number<double>();
  header.number = reader.integer();
  header.first_stands_for = reader.integer();
  return header;
}

std::string record_of(const std::vector<Group>& rows) {
  return ByteWriter().put(rows_kind).put(to_bytes(Result{{}, rows})).bytes();
}

std::vector<Group> rows_in(std::string_view record) {
  ByteReader bytes(record);
  return bytes.integer() == rows_kind ? result_of_bytes(bytes.text()).groups : std::vector<Group>();
}

std::string record_of(const RunStatus& status) {
  ByteWriter bytes;
  bytes.put(status_kind).put(status.seconds).put(status.time).put(status.collisions);
  return bytes.put(status.gap_min).put(status.closure_gap).put(status.closure_speed).bytes();
}

namespace {

// Leaves the first and the last row.
void keep_ends(Column& column) {
  std::visit(
      [&](auto& values) {
        const auto width = static_cast<std::ptrdiff_t>(column.width);
        const auto rows = static_cast<std::ptrdiff_t>(values.size()) / width;
        if (rows <= 2) return;
        if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<std::string>>)
          for (const std::string& text : values) column.longest = std::max(column.longest, text.size());
        values.erase(values.begin() + width, values.end() - width);
        column.left_out += static_cast<std::uint64_t>(rows - 2);
      },
      column.values);
}

}  // namespace

void GrowingTables::add(Group&& rows) {
  const auto [at, anew] = by_name_.try_emplace(rows.name, tables_.size());
  if (anew) {
    tables_.push_back(Group{rows.name, rows.attributes, {}});
    for (const Column& column : rows.columns) {
      tables_.back().columns.push_back(column);
      std::visit([](auto& values) { values.clear(); }, tables_.back().columns.back().values);
    }
  }
  const auto refuse = [&] {
    throw Error({{}, 0, rows.name}, "rows of other columns", "", "use the program that wrote them", Exit::io);
  };
  std::vector<Column>& columns = tables_[at->second].columns;
  if (columns.size() != rows.columns.size()) refuse();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column &column = columns[k], &more_rows = rows.columns[k];
    if (column.values.index() != more_rows.values.index() || column.width != more_rows.width ||
        column.name != more_rows.name || more_rows.left_out != 0)
      refuse();
    std::visit(
        [&]<class Values>(Values& values) {
          const Values& more = std::get<Values>(rows.columns[k].values);
          values.insert(values.end(), more.begin(), more.end());
        },
        columns[k].values);
    if (reading_ == Reading::ends) keep_ends(columns[k]);
  }
}

std::vector<Group> GrowingTables::in_order() && {
  const auto rank = [](const Group& table) -> std::ptrdiff_t {
    static const std::array<std::string, 9> order{"series", "series/heaviest", "snapshots/", "profiles/", "masses/",
                                                  "zone",   "scenario",        "events",     "collapse"};
    const std::string_view of = rounded_name(table.name);
    const bool exact = of != table.name;
    const auto place =
        std::find_if(order.begin(), order.end(),
                     [&](const std::string& name) { return name.ends_with('/') ? of.starts_with(name) : of == name; }) -
        order.begin();
    return place + (exact ? std::ptrdiff_t{order.size()} + 1 : 0);
  };
  std::stable_sort(tables_.begin(), tables_.end(), [&](const Group& a, const Group& b) { return rank(a) < rank(b); });
  return std::move(tables_);
}

RunJournal read_run_journal(const std::string& path, Reading reading) {
  JournalReader records(path, JournalOf::run);
  RunJournal journal;
  GrowingTables tables(reading);
  try {
    journal.header = RunHeader::of(records.header());
    for (std::string record; records.next(record);) {
      ByteReader bytes(record);
      if (bytes.integer() != status_kind) {
        for (Group& rows : rows_in(record)) tables.add(std::move(rows));
        continue;
      }
      RunStatus status;
      status.seconds = bytes.number<double>();
      status.time = bytes.number<double>();
      status.collisions = bytes.integer();
      status.gap_min = bytes.number<double>();
      status.closure_gap = bytes.number<double>();
      status.closure_speed = bytes.number<double>();
      journal.statuses.push_back(status);
    }
  } catch (const Error& error) {
    throw Error(path + ": " + error.what(), Exit::io);
  }
  journal.torn_bytes = records.torn_bytes();
  journal.tables = std::move(tables).in_order();
  return journal;
}

std::uint64_t for_each_piece(const std::string& path, const std::function<void(Group&& rows)>& each) {
  JournalReader records(path, JournalOf::run);
  std::uint64_t count = 0;
  for (std::string record; records.next(record); ++count)
    for (Group& rows : rows_in(record)) each(std::move(rows));
  return count;
}

Scene scene_of(const RunHeader& header, const std::string& path) {
  Scene scene = parse_scene(header.scene, path);
  scene.name = header.name;
  return scene;
}

Result result_so_far(RunJournal&& journal, const std::string& path) {
  const Scene scene = scene_of(journal.header, path);
  return {provenance(scene, precision_name(scene.run), "in progress"), std::move(journal.tables)};
}

double collisions_per_second(const std::vector<RunStatus>& statuses) {
  constexpr double minute = 60;
  if (statuses.empty()) return 0;
  const RunStatus& now = statuses.back();
  RunStatus before;  // the start
  for (const RunStatus& status : statuses)
    if (status.seconds < now.seconds - minute) before = status;
  const double seconds = now.seconds - before.seconds;
  return seconds > 0 ? static_cast<double>(now.collisions - before.collisions) / seconds : 0;
}

}  // namespace cradle::tools
