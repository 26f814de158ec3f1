// The tables of a scene are known before it runs, and a run writes exactly these.
#include "cradle/tools/record/tables.hpp"

#include <gtest/gtest.h>

#include "cradle/tools/ensemble/layout.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::tables_test {

const std::string rows = "[initial]\ntype = 'rows'\nparticles = 60\nperturbation = 0.05\n[run]\nuntil = 40\n"
                         "[output]\nprofiles = { times = [20], bins = 7, range = [-5, 5] }\nseries.points = 5\n";

const std::pair<const char*, std::string> scenes[] = {
    {"dry", "[law]\ntype = 'inelastic'\nrestitution = 0.9\ncutoff = 1e-3\n" + rows},
    {"core", "[law]\ntype = 'inelastic'\nrestitution = 0.9\ncutoff = 1e-3\n" + rows + "core = true\n"},
    {"wet", "[law]\ntype = 'wet'\nloss = 0.05\n" + rows + "zone = { from = 5, samples = 16, bins = 6, reach = 3 }\n" +
                "scenario = true\ncore = true\n"},
    {"sticky", "[law]\ntype = 'sticky'\n" + rows},
    {"ring", "law.type = 'wet'\nlaw.loss = 0.1\nrun.until = 3\noutput.series.points = 5\n"
             "initial = { type = 'ring', particles = 20 }"},
    {"gas",
     "law = { type = 'inelastic', restitution = 1 }\nrun.until = 40\n"
     "initial = { type = 'rows', particles = 60 }\nwalls = { left = { position = -31, restitution = 0.9 }, right "
     "= { position = 40, temperature = 1 } }\noutput = { averages = { every = 1, bins = 3 }, histograms = "
     "['free_flight', 'pair_flight', 'closing_speed', 'dissipative_closing_speed', 'collisions_per_particle', "
     "'gap', 'cluster'], counting = { every = 20, cluster_gap = 0.5 }, correlations = { every = 1, longest = 30 }, "
     "structure = { every = 5, times = [7], waves = 30 }, pair_distribution = { every = 5, times = [8], distance = 9, "
     "bins = 4 }, series.points = 5 }"},
    {"model", "law.type = 'wet'\nlaw.loss = 0.05\nrun.until = 3\noutput.series.points = 5\n"
              "initial = { type = 'clusters', x = [-1, 1] }"},
};

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
  for (const auto& [name, text] : scenes) {
    SCOPED_TRACE(name);
    const Scene scene = parse_scene(text, std::string(name) + ".toml");
    const RunTables tables = run_tables(scene);
    const RunOutcome run = run_scene(scene, {Progress::Show::never});
    EXPECT_EQ(run.end, RunEnd::reached);
    for (const Group& table : tables.series) expect_columns(table, run.result.find(table.name));
    if (tables.profile) expect_columns(*tables.profile, run.result.find("profiles/0000"));
    if (tables.zone) expect_columns(*tables.zone, run.result.find("zone"));
    if (tables.averages) expect_columns(*tables.averages, run.result.find("averages"));
    EXPECT_EQ(tables.averages.has_value(), std::string(name) == "gas");
    EXPECT_EQ(tables.histograms.size(), std::string(name) == "gas" ? 7U : 0U);
    for (const Group& table : tables.histograms) expect_columns(table, run.result.find(table.name));
    for (const auto& [table, group] : {std::pair(&tables.correlations, "correlations"),
                                       {&tables.structure_average, "structure_average"},
                                       {&tables.structure, "structure/0000"},
                                       {&tables.pair_distribution_average, "pair_distribution_average"},
                                       {&tables.pair_distribution, "pair_distribution/0000"}}) {
      EXPECT_EQ(table->has_value(), std::string(name) == "gas");
      if (*table) expect_columns(**table, run.result.find(group));
    }
    EXPECT_EQ(tables.profile.has_value(), run.result.find("profiles/0000") != nullptr);
    EXPECT_EQ(tables.zone.has_value(), run.result.find("zone") != nullptr);
    std::vector<std::string> summary;
    for (const auto& [number, value] : run.summary) summary.push_back(number);
    EXPECT_EQ(tables.summary, summary);
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
  EXPECT_THROW(filled(masses_table("masses/0000"), std::vector<double>{1}), std::logic_error);
  const Group table = filled(masses_table("masses/0000"), std::vector<double>{1}, std::vector<std::uint64_t>{2});
  EXPECT_EQ(table.columns[1].values, Numbers(std::vector<std::uint64_t>{2}));
}

}  // namespace cradle::tools::tables_test
