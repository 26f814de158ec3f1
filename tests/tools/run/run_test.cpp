// The program from scene to file: the Fig. 2 shock from a list of particles against counts of an independent
// event-driven N-particle program (identical in double, binary128 and 100 digits). How often a run is sampled changes
// only the series: every other number in a result file, attributes included, has the same bits. This includes lattices,
// with very many simultaneous collisions, for which the order of events is hardest to keep. With gravity and shaken
// walls the account of energy in a result balances, with balls that rest on a floor too. (The three-particle collapse
// against its closed form, free fall, that two runs and any number of threads give the same bytes:
// tests/tools/run/outputs.txt.)
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/tools/cases.hpp"
#include "cradle/tools/commands/difference.hpp"
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
  const auto counted_from = [&] { return tools::RunGuards::state(guards)([](auto time) { return time; }); };
  const auto checked_at = counted_from();
  guards.check_loaded(engine->last_collision_time());
  EXPECT_EQ(counted_from(), checked_at);
  EXPECT_GT(guards.status(9).gap_min, 0) << "all particles were looked at";
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

// ---- gravity and shaken walls

using tools::Result;

const std::string law = "law = { type = 'inelastic', restitution = 0.95, cutoff = 0.01 }\n";
const std::string beads = "initial = { type = 'list', x = [1, 2, 3.5, 4, 6], v = [0.5, 0, -1, 0, 0.25] }\n";
const std::string ball = "initial = { type = 'list', x = [1], v = [0.5] }\n";
const std::string falls = "gravity.acceleration = -0.5\n";
const std::string output = "run.until = 12\noutput = { series.points = 49, snapshots = [0, 3, 12], events = true }\n";
std::string floor_of(const std::string& motion, const std::string& more = "restitution = 0.9") {
  return "walls.left = { position = 0, motion = '" + motion + "', amplitude = 0.25, frequency = 3, phase = 0.5, " +
         more + " }\n";
}
const std::string falling = law + beads + falls + "walls.left = { position = 0, restitution = 0.9 }\n" + output;
const std::string between = law +
                            "initial = { type = 'gas', particles = 40, perturbation = 0.2 }\nrun.until = 6\n"
                            "gravity.acceleration = 0.25\nwalls.right.temperature = 2\noutput.snapshots = [6]\n"
                            "output.series.points = 7\noutput.profiles = { times = [5], bins = 4, range = [0, 40] }\n";
std::string shaken(const std::string& floor) { return law + beads + falls + floor + output; }

using GravityAndWalls = ProgramTest;

TEST_F(GravityAndWalls, TheAccountOfEnergyBalances) {
  for (const std::string& scene :
       {falling, between, falling + "run.coordinates = 'absolute'\n", shaken(floor_of("sine")),
        shaken(floor_of("sawtooth")), shaken(floor_of("parabola")),
        shaken(floor_of("sine")) + "run.coordinates = 'absolute'\n", law + beads + floor_of("sine") + output,
        law + ball + falls + floor_of("sine", "restitution = 0.25, rest_speed = 0.2") + output,
        shaken(floor_of("sine", "restitution = 0.9, rest_speed = 0.1"))}) {
    SCOPED_TRACE(scene);
    const Result result = result_of(scene);
    const auto of = [&](const std::string& name) { return numbers(result, "series", name); };
    const std::string wall = has(scene, "walls.left") ? "wall_left_" : "wall_right_";
    const auto kinetic = of("energy"), lost = of("energy_lost"), given = of(wall + "energy");
    const auto potential = has(scene, "gravity") ? of("potential_energy") : std::vector<double>(kinetic.size());
    EXPECT_GT(numbers<std::uint64_t>(result, "series", wall + "collisions").back(), has(scene, "gravity") ? 2U : 0U);
    if (has(scene, "motion")) {
      EXPECT_NE(given.back(), 0);
    }
    EXPECT_GT(lost.back(), 0);
    const double scale = std::abs(potential[0]) + kinetic[0] + std::abs(given.back());
    for (std::size_t k = 0; k < kinetic.size(); ++k)
      EXPECT_NEAR(kinetic[k] + potential[k] + lost[k] - given[k], kinetic[0] + potential[0], 1e-13 * scale);
    for (const auto& [name, value] : result.attributes)
      if (name == "ledger_error") {
        EXPECT_LT(std::abs(std::get<double>(value)), 1e-13 * scale);
      }
  }
}

// x(t) = A sin(omega t + phi) in [-A, A] at a sample of the wall's own particle: one that rests on it.
TEST_F(GravityAndWalls, ABallAtRestHasTheMotionOfTheFloor) {
  const Result result = result_of(law + ball + "gravity.acceleration = -4\n" +  // A omega^2 = 2.25 < 4
                                  floor_of("sine", "restitution = 0.25, rest_speed = 0.2") + output);
  EXPECT_NEAR(numbers(result, "snapshots/0002", "x").back(), 0.25 * std::sin(36.5), 1e-14);
  EXPECT_NEAR(numbers(result, "snapshots/0002", "v").back(), 0.75 * std::cos(36.5), 1e-14);
  EXPECT_LT(numbers<std::uint64_t>(result, "series", "collisions").back(), 20U);
}

}  // namespace cradle::tests::run_test
