#include "cradle/tools/ensemble/merge.hpp"

#include <fmt/format.h>

#include "cradle/tools/result/reader.hpp"

namespace cradle::tools {

namespace {

std::string describe(const std::vector<ReplicaRange>& ranges) {
  if (ranges.empty()) return "none";
  if (ranges.size() > 1)
    return fmt::format("{} ranges, {} to {}", ranges.size(), ranges[0].first, ranges.back().end() - 1);
  return fmt::format("{} to {}", ranges[0].first, ranges[0].end() - 1);
}

void take(EnsembleStore& all, EnsembleStore& other, const std::string& file) {
  for (std::size_t k = 0; k < all.states().size(); ++k) {
    EnsembleState &into = *all.states()[k], &from = *other.states()[k];
    if (into.holds_any_of(from))
      throw Error({file, 0, ""}, "has replicas that another of the files has too", describe(from.replicas().present()),
                  "merge files of different replicas (--first)");
    into.take(from);
  }
}

}  // namespace

std::unique_ptr<EnsembleStore> merged(const std::vector<std::string>& files) {
  const Study study = study_in(read_result(files.front()), files.front());
  auto all = std::make_unique<EnsembleStore>(study, "");
  for (const std::string& file : files) {
    EnsembleStore one(study, file);
    one.load_result("leave it out, since files of one scene with the same --spread are merged");
    take(*all, one, file);
  }
  return all;
}

}  // namespace cradle::tools
