// Which study a journal or a result file belongs to, by its own account.
#include <fmt/format.h>

#include <algorithm>

#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/ensemble/sweep.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_journal.hpp"

namespace cradle::tools {

JournalHeader header_in(const Result& result, const std::string& file, const char* otherwise) {
  const auto& of_file = result.attributes;
  if (std::ranges::find(of_file, "identity", &Attribute::first) == of_file.end())
    throw Error({file, 0, ""}, "holds no ensemble", "a single run, or another command's result", otherwise);
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
  const Scene scene = scene_of(header, path);
  const auto scene_at = [&](const std::string& group) {
    const auto at = std::ranges::find(header.points, group, &std::pair<std::string, std::string>::first);
    if (at == header.points.end())
      throw Error({path, 0, ""}, "a sweep without one of its points", group, "make it anew, or remove it", Exit::io);
    return parse_scene(at->second, path);
  };
  Study study = header.kind == "sweep" ? sweep_at(scene, scene_at) : ensemble_of(scene, header.spreads);
  if (study.identity() != header.identity) throw of_other_scenes;
  return study;
}

}  // namespace

Study study_in(const JournalHeader& journal, const std::string& path) {
  return study_described(journal, path,
                         {{path, 0, ""},
                          "its scenes are not those of its replicas",
                          "another identity",
                          "take it from a copy, or remove it",
                          Exit::io});
}

Study study_in(const Result& result, const std::string& file) {
  return study_described(header_in(result, file, "give a file that `cradle ensemble` or `cradle sweep` wrote"), file,
                         {{file, 0, ""},
                          "cannot be merged here",
                          "another version's file, or a scene that was changed in it",
                          "use the program that wrote it"});
}

}  // namespace cradle::tools
