// The tables of a scene are known before it runs, and a run writes exactly these.
#include "cradle/tools/record/rows.hpp"

#include <numeric>

#include "cradle/tests/tools/cases.hpp"
#include "cradle/tools/ensemble/layout.hpp"
#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::tables_test {

void expect_columns(const Group& declared, const Group* written) {
  ASSERT_NE(written, nullptr) << declared.name;
  ASSERT_EQ(declared.columns.size(), written->columns.size()) << declared.name;
  for (std::size_t c = 0; c < declared.columns.size(); ++c) {
    const Column &a = declared.columns[c], &b = written->columns[c];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.unit, b.unit);
    EXPECT_EQ(a.description, b.description);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.names, b.names);
    EXPECT_GT(b.rows(), 0U) << declared.name << "/" << b.name;
    if (a.rows() > 0) {
      EXPECT_EQ(a.values, b.values) << "bins of " << declared.name;
    }
  }
}

TEST(RunTables, AreWhatARunWrites) {
  for (const tests::ListedCase& listed : tests::cases_in("record/scenes.txt")) {
    SCOPED_TRACE(listed.name());
    const Scene scene = parse_scene(listed.below_name(), listed.name() + ".toml");
    const bool gas = listed.name() == "gas";
    const RunOutcome run = run_scene(scene, {Progress::Show::never});
    EXPECT_EQ(run.end, RunEnd::reached);
    std::vector<std::string> summary;
    std::size_t at_times = 0, at_end = 0;
    for (const MeasurementRow* row : measurement_rows()) {
      SCOPED_TRACE(row->name);
      const auto tables = [&](auto* of) { return of == nullptr ? std::vector<Group>() : of(scene); };
      if (!row->wanted(scene)) {
        EXPECT_TRUE(tables(row->tables_at_end).empty());
        for (const Group& group : run.result.groups)
          EXPECT_TRUE(group.name != row->at_end && !group.name.starts_with(std::string(row->name) + "/")) << group.name;
        continue;
      }
      for (const Group& table : tables(row->growing)) expect_columns(table, run.result.find(table.name));
      for (const Group& table : tables(row->tables_at_end))
        expect_columns(table, run.result.find(table.name)), ++at_end;
      if (row->table_at != nullptr && !row->times(scene.output).empty())
        expect_columns(row->table_at(scene), run.result.find(std::string(row->name) + "/0000")), ++at_times;
      if (row->summary != nullptr)
        for (const std::string& number : row->summary(scene)) summary.push_back(number);
    }
    EXPECT_EQ(at_times, (gas ? 2U : 0U) + (scene.output.profiles.times.empty() ? 0U : 1U));
    EXPECT_EQ(at_end, gas ? 11U : listed.name() == "wet" ? 1U : 0U);
    std::vector<std::string> written;
    for (const auto& [number, value] : run.summary) written.push_back(number);
    EXPECT_EQ(summary, written);
  }
}

// Their bins begin and end at the outermost particles that have collided, whose places are rounded in several ways.
TEST(Profiles, WithoutARangeHoldAllParticlesThatHaveCollided) {
  for (const std::string law : {"{ type = 'inelastic', restitution = 0.99 }", "{ type = 'wet', loss = 0.01 }"}) {
    const RunOutcome run = run_scene(
        parse_scene("law = " + law +
                        "\nrun.until = 60\ninitial = { type = 'rows', left = { particles = 100, speed = 0.5 }, "
                        "right = { particles = 100, speed = -0.5 }, perturbation = 0.1 }\noutput = { series = "
                        "{ every = 1 }, profiles = { times = { every = 1 }, bins = 7 } }",
                    "s.toml"),
        {Progress::Show::never});
    const auto values = [&](const std::string& group, const std::string& column) {
      return std::get<std::vector<double>>(run.result.find(group)->find(column)->values);
    };
    const auto& particles = std::get<std::vector<std::uint64_t>>(run.result.find("series")->find("particles")->values);
    for (std::size_t t = 2; t <= 60; ++t) {
      const std::string table = fmt::format("profiles/{:04}", t);
      const std::vector<double> x = values(table, "x"), density = values(table, "density");
      EXPECT_NEAR(std::accumulate(density.begin(), density.end(), 0.) * (x[1] - x[0]),
                  static_cast<double>(particles[t]), 1e-9)
          << law << t;
    }
  }
}

TEST(RunTables, OfEnsemblesAreKnownWithoutSettingUpAnything) {
  // No memory holds these particles.
  const Scene scene =
      parse_scene("law.type = 'sticky'\nrun.until = 3\ninitial = { type = 'ring', particles = 1e15 }", "huge.toml");
  const ReplicaLayout layout = replica_layout(scene);
  EXPECT_EQ(layout.entries, 8U * 1000U);
  EXPECT_EQ(layout.time.rows(), 1000U);
}

TEST(RunTables, AreFilledWithAsManyNumbersAsTheyHave) {
  const Group empty{"masses/0000", {}, {{"mass", "m", "", {}}, {"clusters", "1", "", {}}}};
  EXPECT_THROW(filled(empty, std::vector<double>{1}), std::logic_error);
  const Group table = filled(empty, std::vector<double>{1}, std::vector<std::uint64_t>{2});
  EXPECT_EQ(table.columns[1].values, Numbers(std::vector<std::uint64_t>{2}));
}

// Every table of a scene with all of them is in a row: else it would be written twice when a run is extended, or stand
// anywhere in the file.
TEST(RunTables, HaveAnOrder) {
  GrowingTables tables;
  std::istringstream names("series snapshots/0000 pair_distribution/0001 events averages histograms/gap "
                           "pair_distribution_average sequence collapse exact/series exact/events");
  const std::vector<std::string> order(std::istream_iterator<std::string>(names), {});
  for (auto name = order.rbegin(); name != order.rend(); ++name) tables.add({*name, {}, {}});
  std::vector<std::string> found;
  for (const Group& table : in_order(std::move(tables))) found.push_back(table.name);
  EXPECT_EQ(found, order);
}

}  // namespace cradle::tools::tables_test
