// How often a run is sampled changes only the series: every other number in a result file, attributes included, has the
// same bits. This includes lattices, with very many simultaneous collisions, for which the order of events is hardest
// to keep.
#include "cradle/tests/tools/cases.hpp"
#include "cradle/tools/result/difference.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::cadence_test {

class Cadence : public testing::TestWithParam<tests::ListedCase> {
 protected:
  static RunOutcome run(const std::string& points) {
    return run_scene(
        parse_scene(GetParam().below_name(), GetParam().name() + ".toml", {"output.series.points=" + points}),
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

INSTANTIATE_TEST_SUITE_P(Lattices, Cadence, testing::ValuesIn(tests::cases_in("run/lattices.txt")),
                         [](const auto& parameter) { return parameter.param.name(); });

}  // namespace cradle::tools::cadence_test
