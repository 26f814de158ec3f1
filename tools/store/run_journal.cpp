#include "cradle/tools/store/run_journal.hpp"
#include "cradle/tools/setup/read_scene.hpp"

#include <fmt/format.h>

#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

RunJournal read_run_journal(const std::string& path, Reading reading) {
  JournalReader records(path);
  if (records.header().kind == threshold_kind)
    throw Error({path}, "runs of a threshold that is not found yet", records.header().name,
                "repeat its command, which continues it", Exit::io);
  if (!records.header().of_run())
    throw Error({path}, "replicas that are not finished, no statistics yet", "",
                fmt::format("`cradle resume {}` continues with them, `cradle info {}` prints how many are finished",
                            path.substr(0, path.rfind(".part")), path),
                Exit::io);
  RunJournal journal{records.header(), {}, {}, 0};
  GrowingTables tables(reading);
  while (auto record = records.next<RunRecord>()) {
    if (const auto* status = std::get_if<RunStatus>(&*record)) {
      journal.statuses.push_back(*status);
      continue;
    }
    try {
      for (Group& rows : std::get<std::vector<Group>>(*record)) tables.add(std::move(rows));
    } catch (const Error& error) {
      throw Error(path + ": " + error.what(), Exit::io);
    }
  }
  journal.torn_bytes = records.torn_bytes();
  journal.tables = in_order(std::move(tables));
  return journal;
}

std::uint64_t for_each_piece(const std::string& path, const std::function<void(Group&& rows)>& each) {
  JournalReader records(path);
  std::uint64_t count = 0;
  for (; auto record = records.next<RunRecord>(); ++count)
    if (auto* pieces = std::get_if<std::vector<Group>>(&*record))
      for (Group& rows : *pieces) each(std::move(rows));
  return count;
}

Scene scene_of(const JournalHeader& header, const std::string& path) {
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
