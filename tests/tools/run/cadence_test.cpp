// How often a run is sampled changes only the series: every other number in a result file, attributes included, has the
// same bits. This includes lattices, with very many simultaneous collisions, for which the order of events is hardest
// to keep.
#include <gtest/gtest.h>

#include "cradle/tools/result/difference.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::cadence_test {

struct Lattice {
  std::string name, scene;
};

const std::string rows = "initial = { type = 'rows', particles = 400 }\nrun.until = 100\n",
                  dry = "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n", dry_rows = dry + rows;
const Lattice lattices[] = {
    {"Elastic", "law = { type = 'inelastic', restitution = 1 }\n" + rows},
    {"NearlyElastic", "law = { type = 'inelastic', restitution = 0.999 }\nrun.collapse = 'cutoff'\n" + rows},
    {"Dry", dry_rows},
    {"Positions", dry_rows + "run.coordinates = 'absolute'\n"},
    {"Wet", "law = { type = 'wet', loss = 0.01 }\n" + rows},
    {"Sticky", "law.type = 'sticky'\n" + rows},
    {"StickyCollisionByCollision", "law.type = 'sticky'\noutput.events = true\n" + rows},
    {"DoubleDouble", dry_rows + "run.precision = 'double-double'\n"},
    {"Shock", "law = { type = 'inelastic', restitution = 0.999, cutoff = 1e-5 }\nrun.until = 400\n"
              "initial = { type = 'rows', particles = 600, perturbation = 0.05 }\n"},
    {"Ring", dry + "initial = { type = 'ring', particles = 200 }\nrun.until = 100\n"},
};

class Cadence : public testing::TestWithParam<Lattice> {
 protected:
  static RunOutcome run(const std::string& points) {
    return run_scene(parse_scene(GetParam().scene + "output.snapshots = [50, 100]\noutput.profiles.times = [60]\n",
                                 "lattice.toml", {"output.series.points=" + points}),
                     {Progress::Show::never});
  }
  // Without the scene, which says how often, and of the series the first and the last sample.
  static Result shared(Result result) {
    std::erase_if(result.attributes, [](const Attribute& attribute) { return attribute.first == "scene"; });
    for (Group& group : result.groups)
      if (group.name.starts_with("series"))
        for (Column& column : group.columns)
          std::visit([width = static_cast<std::ptrdiff_t>(column.width)](
                         auto& numbers) { numbers.erase(numbers.begin() + width, numbers.end() - width); },
                     column.values);
    return result;
  }
};

TEST_P(Cadence, ChangesNothingButTheSeries) {
  const RunOutcome seldom = run("2"), often = run("3001");
  EXPECT_EQ(seldom.warning, often.warning);
  for (const Difference& found : differences(shared(seldom.result), shared(often.result), "seldom", "often").found)
    ADD_FAILURE() << found.place << ": " << found.what;
}

INSTANTIATE_TEST_SUITE_P(Lattices, Cadence, testing::ValuesIn(lattices),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace cradle::tools::cadence_test
