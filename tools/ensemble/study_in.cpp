// Which study a journal or a result file belongs to, by its own account, and several files as one.
#include <fmt/format.h>

#include <algorithm>

#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/ensemble/sweep.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_journal.hpp"

namespace cradle::tools {

JournalHeader header_in(const Result& result, const std::string& file, const char* otherwise) {
  const auto& of_file = result.attributes;
  if (std::ranges::find(of_file, "identity", &Attribute::first) == of_file.end())
    throw Error({file}, "holds no ensemble", "a single run, or another command's result", otherwise);
  JournalHeader header{attribute<std::string>(of_file, "kind", file),
                       attribute<std::uint64_t>(of_file, "identity", file),
                       attribute<std::string>(of_file, "scene", file), attribute<std::string>(of_file, "name", file)};
  const std::string spread = "ensemble/spread/", below = "/ensemble";
  for (const Group& group : result.groups) {
    const auto& here = group.attributes;
    if (group.name == "ensemble") {
      header.points.emplace_back("", header.scene);
    } else if (group.name.starts_with("points/") && group.name.ends_with(below)) {
      header.points.emplace_back(group.name.substr(0, group.name.size() - below.size()),
                                 attribute<std::string>(here, "scene", file));
    } else if (group.name.starts_with(spread) && !group.columns.empty()) {
      header.spreads.push_back({group.name.substr(spread.size()),
                                {attribute<double>(here, "from", file), attribute<double>(here, "to", file),
                                 attribute<std::uint64_t>(here, "bins", file)}});
      if (const SpreadRequest& found = header.spreads.back(); !found.bins_are_possible())
        throw Error({file, 0, group.name}, "no bins", fmt::format("{}", found.bins.bins), "make the file anew",
                    Exit::io);
    }
  }
  return header;
}

namespace {

Study study_described(const JournalHeader& header, const std::string& path, const Error& of_other_scenes) {
  Study study{header.kind, scene_of(header, path), {}, header.spreads};
  for (const auto& [group, scene] : header.points) {
    study.points.push_back({group, parse_scene(scene, path)});
    study.points.back().scene.name = header.name;
  }
  if (study.identity() != header.identity) throw of_other_scenes;
  // The identity is that of the points, not of the scene that is varied.
  if (const std::size_t n = study.points.size(); study.kind == "sweep" && sweep_points(study.scene.sweep).size() != n)
    throw Error({path}, "a sweep with other points than its scene", fmt::format("{} points", n),
                "make it anew, or remove it", Exit::io);
  return study;
}

std::string describe(const std::vector<ReplicaRange>& ranges) {
  const std::string several = ranges.size() > 1 ? fmt::format("{} ranges, ", ranges.size()) : "";
  return fmt::format("{}{} to {}", several, ranges.front().first, ranges.back().end() - 1);
}

}  // namespace

Study study_in(const JournalHeader& journal, const std::string& path) {
  return study_described(journal, path,
                         {{path},
                          "its scenes are not those of its replicas",
                          "another identity",
                          "take it from a copy, or remove it",
                          Exit::io});
}

std::unique_ptr<EnsembleStore> merged(const std::vector<std::string>& files) {
  const std::string& first = files.front();
  const Study study = study_described(
      header_in(read_result(first), first, "give a file that `cradle ensemble` or `cradle sweep` wrote"), first,
      {{first},
       "cannot be merged here",
       "another version's file, or a scene that was changed in it",
       "use the program that wrote it"});
  auto all = std::make_unique<EnsembleStore>(study, "");
  for (const std::string& file : files) {
    EnsembleStore one(study, file);
    one.load_result("leave it out, since files of one scene with the same --spread are merged");
    for (std::size_t k = 0; k < all->states().size(); ++k) {
      EnsembleState &into = *all->states()[k], &from = *one.states()[k];
      if (into.holds_any_of(from))
        throw Error({file}, "has replicas that another of the files has too", describe(from.replicas().present()),
                    "merge files of different replicas (--first)");
      into.take(from);
    }
  }
  return all;
}

}  // namespace cradle::tools
