#include "cradle/tools/ensemble/merge.hpp"

#include <fmt/format.h>

#include "cradle/tools/result/reader.hpp"

namespace cradle::tools {

namespace {

std::string describe(const std::vector<ReplicaRange>& ranges) {
  const std::string several = ranges.size() > 1 ? fmt::format("{} ranges, ", ranges.size()) : "";
  return fmt::format("{}{} to {}", several, ranges.front().first, ranges.back().end() - 1);
}

}  // namespace

std::unique_ptr<EnsembleStore> merged(const std::vector<std::string>& files) {
  const Study study = study_in(read_result(files.front()), files.front());
  auto all = std::make_unique<EnsembleStore>(study, "");
  for (const std::string& file : files) {
    EnsembleStore one(study, file);
    one.load_result("leave it out, since files of one scene with the same --spread are merged");
    for (std::size_t k = 0; k < all->states().size(); ++k) {
      EnsembleState &into = *all->states()[k], &from = *one.states()[k];
      if (into.holds_any_of(from))
        throw Error({file, 0, ""}, "has replicas that another of the files has too",
                    describe(from.replicas().present()), "merge files of different replicas (--first)");
      into.take(from);
    }
  }
  return all;
}

}  // namespace cradle::tools
