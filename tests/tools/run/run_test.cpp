// The program from scene to file: the Fig. 2 shock from a list of particles against counts of an independent
// event-driven N-particle program (identical in double, binary128 and 100 digits). How often a run is sampled changes
// only the series: every other number in a result file, attributes included, has the same bits. This includes lattices,
// with very many simultaneous collisions, for which the order of events is hardest to keep. (The three-particle
// collapse against its closed form, and that two runs give the same bytes: tests/tools/run/outputs.txt.)
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/tools/cases.hpp"
#include "cradle/tools/result/difference.hpp"
#include "cradle/tools/run/run_guards.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tests::run_test {

class Run : public ProgramTest {};

// The shock of tests/core/fixtures.hpp, which is exact in decimals of 28 and fewer places.
TEST_F(Run, ListOfTheFig2ShockGivesThePublishedCounts) {
  constexpr int n = 8000;
  std::string csv = "x,v\n";
  for (int i = 0; i < n; ++i) {
    const auto units = static_cast<double>(test::rshock_displacement(i));
    csv += fmt::format("{:.28f},{}\n", (2 * i - n + 1) / 2.0 + units / 268435456.0, i < n / 2 ? "0.5" : "-0.5");
  }
  write("particles.csv", csv);
  for (const std::string coordinates : {"gaps", "absolute"}) {
    SCOPED_TRACE(coordinates);
    const auto result = result_of("law = { type = 'inelastic', restitution = 0.999, cutoff = 1e-5 }\nrun.until = 6000\n"
                                  "initial = { type = 'list', file = 'particles.csv' }\n"
                                  "output.series.times = [999.5, 1999, 4000, 6000]\n",
                                  "--set run.coordinates=" + coordinates);
    EXPECT_EQ(numbers<std::uint64_t>(result, "series", "collisions"),
              (std::vector<std::uint64_t>{384155, 1299216, 4685816, 16156905}));
    const double energies[] = {887.274363235560075, 738.145120941488556, 492.025770085541422, 262.948286528987387};
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(numbers(result, "series", "energy")[k], energies[k], 1e-12 * 1000) << k;
  }
}

// A state that was loaded is checked at once. Then a resumed run is checked where one that goes through is: if it
// stops, at the same place.
TEST_F(Run, ACheckOfALoadedStateDoesNotPutOffTheNextOne) {
  const tools::Scene scene = tools::parse_scene("law = { type = 'inelastic', restitution = 0.9 }\nrun.until = 9\n"
                                                "initial = { type = 'ring', particles = 20 }\n",
                                                "scene.toml");
  tools::EngineOptions options;
  options.interrupt = [] { return false; };
  options.progress = [](double, const Counts&) {};
  const auto engine = tools::begin_engine(scene, options);
  engine->advance(tools::rounding(scene)("9"), {});
  ASSERT_GT(engine->counts().collisions, 0U);
  tools::RunGuards guards(scene, *engine);
  const auto checked_at = std::get<0>(tools::RunGuards::state(guards));
  guards.check_loaded(engine->last_collision_time());
  EXPECT_EQ(std::get<0>(tools::RunGuards::state(guards)), checked_at);
  EXPECT_GT(guards.status(9).gap_min, 0) << "all particles were looked at";
}

// What nothing measures is not written: not as 0 either.
TEST_F(Run, ClosureErrorsAreWrittenWhereTheyAreMeasured) {
  const auto written = [&](const std::string& law, const std::string& more, const char* name) {
    const auto result = result_of("[law]\n" + law + "\n[initial]\ntype = \"rows\"\nparticles = 2000\n" +
                                  "perturbation = 0.05\n[run]\n" + more + "until = 500\n[output]\nsnapshots = [300]\n");
    const auto* found = tools::find_attribute<double>(result.find("snapshots/0000")->attributes, name);
    return found != nullptr ? std::optional(*found) : std::nullopt;
  };
  const std::string dry = "type = \"inelastic\"\nrestitution = 0.999\ncutoff = 1e-5",
                    wet = "type = \"wet\"\nloss = 0.05";
  EXPECT_NE(written(dry, "", "closure_gap").value_or(0), 0);
  EXPECT_TRUE(written(dry, "", "closure_speed"));
  EXPECT_NE(written(wet, "", "closure_gap").value_or(0), 0);
  EXPECT_FALSE(written(wet, "", "closure_speed"));
  for (const char* name : {"closure_gap", "closure_speed"}) {
    EXPECT_FALSE(written("type = \"sticky\"", "", name)) << name;
    EXPECT_FALSE(written(dry, "coordinates = \"absolute\"\n", name)) << name;
  }
}

// The energy that a collapse leaves is that of the proof, in any type.
TEST_F(Run, EnergyAtACollapseHasDigits) {
  const auto last = [&](const std::string& file) { return numbers(read(file), "series", "energy").back(); };
  const std::string run = "cradle run collapse3 --quiet --force --set output.events=false ";
  shell(run + "-o a.h5", 3);
  const double energy = last("a.h5");
  EXPECT_GT(energy, 1e-257);
  EXPECT_LT(energy, 1e-254);
  shell(run + "--set run.precision=double-double -o b.h5", 3);
  EXPECT_NEAR(last("b.h5") / energy, 1, 1e-13);
  shell("cradle certify collapse3 --quiet -o c.h5", 0);
  const auto proved = read("c.h5");
  EXPECT_NEAR(numbers(proved, "series", "energy_low").back() / energy, 1, 1e-12);
  // Of the run's own: digits and the ledger's difference; and the last snapshot is at the collision, not at a rounded
  // time beside it.
  const auto result = read("a.h5");
  EXPECT_GT(tools::attribute<double>(result.attributes, "energy_digits", ""), 12);
  EXPECT_LT(tools::attribute<double>(result.attributes, "energy_digits", ""), 16);
  EXPECT_LT(std::abs(tools::attribute<double>(result.attributes, "ledger_error", "")), 1e-15);
  EXPECT_EQ(tools::attribute<double>(result.find("snapshots/0000")->attributes, "gap_min", ""), 0);
}

class Cadence : public testing::TestWithParam<ListedCase> {
 protected:
  static tools::RunOutcome run(const std::string& points) {
    return tools::run_scene(
        tools::parse_scene(GetParam().below_name(), GetParam().name() + ".toml", {"output.series.points=" + points}),
        {tools::Progress::Show::never});
  }
  // Without the scene, which says how often, and of the series the first and the last sample.
  static tools::Result shared(tools::Result result) {
    std::erase_if(result.attributes, [](const tools::Attribute& attribute) { return attribute.first == "scene"; });
    for (tools::Group& group : result.groups)
      if (group.name.starts_with("series"))
        for (tools::Column& column : group.columns)
          std::visit([width = static_cast<std::ptrdiff_t>(column.width)](
                         auto& numbers) { numbers.erase(numbers.begin() + width, numbers.end() - width); },
                     column.values);
    return result;
  }
};

TEST_P(Cadence, ChangesNothingButTheSeries) {
  const tools::RunOutcome seldom = run("2"), often = run("3001");
  EXPECT_EQ(seldom.warning, often.warning);
  const auto differences = tools::differences(shared(seldom.result), shared(often.result), "seldom", "often");
  for (const tools::Difference& found : differences.found) ADD_FAILURE() << found.place << ": " << found.what;
}

INSTANTIATE_TEST_SUITE_P(Lattices, Cadence, testing::ValuesIn(cases_in("run/lattices.txt")),
                         [](const auto& parameter) { return parameter.param.name(); });

}  // namespace cradle::tests::run_test
