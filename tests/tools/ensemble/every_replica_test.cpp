// The snapshots and profiles of every replica: those of the runs, to the last bit; the same file after a kill (for any
// other history: same_bytes_test.cpp); and nothing of it where the scene does not ask for it.
#include <cmath>

#include "cradle/tests/tools/ensemble/ensembles.hpp"

namespace cradle::tests::every_replica_test {

TEST_F(Ensembles, KeepWhatEveryReplicaRecords) {
  run("ensemble shock.toml --replicas 5 --set output.every_replica=true -o e.h5");
  const Result all = read("e.h5");
  for (const std::string table : {"snapshots/0000", "profiles/0000", "profiles/0001"}) {
    const tools::Group& kept = *all.find("replicas/" + table);
    const auto replica = std::get<std::vector<std::uint64_t>>(column(kept, "replica").values);
    std::size_t row = 0;
    for (std::uint64_t k = 0; k < 5; ++k) {
      run("run shock.toml --quiet --force -o r.h5 --set initial.replica=" + std::to_string(k));
      const Result alone = read("r.h5");
      const tools::Group& own = *alone.find(table);
      EXPECT_EQ(kept.columns.size(), own.columns.size() + 1);
      EXPECT_EQ(attribute<double>(kept.attributes, "time", ""), attribute<double>(own.attributes, "time", ""));
      const std::size_t rows = own.columns.front().rows();
      for (const Column& c : own.columns) {
        const auto here = numbers(all, kept.name, c.name), there = numbers(alone, table, c.name);
        ASSERT_EQ(here.size(), replica.size());
        for (std::size_t i = 0; i < there.size(); ++i)
          EXPECT_TRUE(here[row + i] == there[i] || (std::isnan(here[row + i]) && std::isnan(there[i]))) << c.name;
        // Between n particles there are n - 1 gaps.
        for (std::size_t i = there.size(); i < rows; ++i) EXPECT_TRUE(std::isnan(here[row + i])) << c.name;
      }
      for (std::size_t i = 0; i < rows; ++i) EXPECT_EQ(replica[row + i], k);
      row += rows;
    }
    EXPECT_EQ(row, replica.size());
  }
  run("ensemble shock.toml --replicas 5 -o plain.h5");
  for (const tools::Group& group : read("plain.h5").groups)
    EXPECT_FALSE(has(group.name, "replicas/snapshots") || has(group.name, "replicas/profiles")) << group.name;
}

// A replica that has collapsed has its last state in place of a snapshot, at a time of its own.
TEST_F(Ensembles, KeepTheTimesOfLastStates) {
  write("ring.toml", R"(
law = {type = "inelastic", restitution = 0.03}
initial = {type = "ring", particles = 3, perturbation = 0.4, seed = 7}
run.until = 30
output = {series = {points = 7}, snapshots = [1, 5], every_replica = true}
)");
  // The second call reads what the first has written.
  for (const std::string replicas : {"2", "4"}) run("ensemble ring.toml --replicas " + replicas + " -o e.h5");
  const Result all = read("e.h5");
  const tools::Group& kept = *all.find("replicas/snapshots/0001");
  EXPECT_EQ(tools::find_attribute<double>(kept.attributes, "time"), nullptr);
  const auto replica = std::get<std::vector<std::uint64_t>>(column(kept, "replica").values);
  const auto time = numbers(all, kept.name, "time");
  for (std::uint64_t k = 0; k < 4; ++k) {
    shell("cradle run ring.toml --quiet --force -o r.h5 --set initial.replica=" + std::to_string(k));
    const Result alone = read("r.h5");
    const double own = attribute<double>(alone.find("snapshots/0001")->attributes, "time", "");
    for (std::size_t row = 0; row < replica.size(); ++row)
      if (replica[row] == k) {
        EXPECT_EQ(time[row], own) << k;
      }
  }
  run("ensemble ring.toml --replicas 4 -o whole.h5");
  shell("cmp e.h5 whole.h5", 0);
}

// The first kill leaves records of replicas, which the second call rewrites as statistics and tables of replicas.
TEST_F(Ensembles, KeepEveryReplicaWhereTheyAreKilled) {
  write("shock.toml", std::string(shock) + "every_replica = true\n");
  for (int kill = 0; kill < 2; ++kill) shell(until_journalled("killed.h5", "KILL"), 137);
  expect_continued("killed.h5");
}

TEST_F(Ensembles, OfASweepKeepEveryReplicaToo) {
  const std::string command = "sweep collapse.toml --vary law.restitution=0.05,0.9 --replicas 3 --set "
                              "output.every_replica=true --set output.snapshots=[0.25,1.75] -o s.h5";
  run(command);
  const Result sweep = read("s.h5");
  for (const std::string point : {"points/0000/", "points/0001/"}) {
    const auto replica = numbers(sweep, point + "replicas/snapshots/0000", "replica");
    EXPECT_EQ(replica.front(), 0);
    EXPECT_EQ(replica.back(), 2);
  }
  run(command);
}

}  // namespace cradle::tests::every_replica_test
