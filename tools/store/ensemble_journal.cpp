#include "cradle/tools/store/ensemble_journal.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cradle/tools/ensemble/state.hpp"
#include "cradle/tools/ensemble/sweep.hpp"
#include "cradle/tools/store/journal.hpp"

namespace cradle::tools {

std::string header_of(const Study& study, ReplicaRange wanted) {
  ByteWriter header;
  header.put(study.identity()).put(study.kind).put(effective_toml(study.scene)).put(study.scene.name);
  header.put(std::uint64_t{study.spreads.size()});
  for (const auto& [name, bins] : study.spreads)
    header.put(name).put(bins.from).put(bins.to).put(std::uint64_t{bins.bins});
  header.put(wanted.first).put(wanted.count);
  for (const auto& [group, scene] : study.points) header.put(group).put(effective_toml(scene));
  return std::move(header).bytes();
}

JournalContents header_in(std::string_view bytes) {
  ByteReader header(bytes);
  JournalContents contents;
  contents.identity = header.integer();
  contents.kind = header.text();
  contents.scene = header.text();
  contents.name = header.text();
  for (std::uint64_t left = header.integer(); left > 0; --left) {
    SpreadRequest spread;
    spread.name = header.text();
    spread.bins.from = header.number<double>();
    spread.bins.to = header.number<double>();
    spread.bins.bins = header.integer();
    if (!(spread.bins.from < spread.bins.to) || spread.bins.bins < 1 || spread.bins.bins > 1'000'000)
      throw Error({}, "a journal of no bins", fmt::format("{}", spread.bins.bins), "take it from a copy", Exit::io);
    contents.spreads.push_back(std::move(spread));
  }
  contents.wanted.first = header.integer();
  contents.wanted.count = header.integer();
  constexpr std::uint64_t most = std::uint64_t{1} << 53;
  if (contents.wanted.first > most || contents.wanted.count > most)
    throw Error({}, "a journal of too many replicas", "", "take it from a copy", Exit::io);
  while (!header.empty()) {
    const std::string group = header.text();
    contents.scenes.emplace_back(group, header.text());
  }
  return contents;
}

Study study_in(const JournalContents& journal, const std::string& path) {
  Scene scene = parse_scene(journal.scene, path);
  scene.name = journal.name;
  Study study =
      journal.kind == "sweep"
          ? sweep_at(scene,
                     [&](const std::string& group) {
                       const auto at = std::find_if(journal.scenes.begin(), journal.scenes.end(),
                                                    [&](const auto& point) { return point.first == group; });
                       if (at == journal.scenes.end())
                         throw Error({path, 0, ""}, "a sweep without one of its points", group, "remove it", Exit::io);
                       return parse_scene(at->second, path);
                     })
          : ensemble_of(scene, journal.spreads);
  if (study.identity() != journal.identity)
    throw Error({path, 0, ""}, "of another version of the program", "", "continue with that one, or remove it",
                Exit::io);
  return study;
}

JournalContents read_journal_contents(const std::string& path) {
  JournalReader reader(path, JournalOf::replicas);
  JournalContents contents = header_in(reader.header());
  contents.replicas.resize(contents.scenes.size());
  for (std::string record; reader.next(record);) {
    const std::uint64_t point = EnsembleState::point(record);
    if (point >= contents.replicas.size())
      throw Error({path, 0, ""}, "a record of no ensemble", fmt::format("number {}", point), "remove the file",
                  Exit::io);
    contents.replicas[point] += EnsembleState::replicas_in(record);
  }
  contents.torn_bytes = reader.torn_bytes();
  return contents;
}

}  // namespace cradle::tools
