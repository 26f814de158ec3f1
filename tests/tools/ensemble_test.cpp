// Ensembles from scene to file: the same bytes for any number of threads, interrupted, killed and continued, split and
// merged; replicas that fail or collapse; statistics against those of single runs; and what is refused.

#include "cradle/tools/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests {
namespace {

using tools::attribute;
using tools::Column;
using tools::Exit;
using tools::read_result;
using tools::Result;
using tools::RunOutcome;
using tools::Scene;

constexpr const char* shock = R"(
[law]
type = "inelastic"
restitution = 0.99
cutoff = 1e-5
[initial]
type = "rows"
particles = 300
speed = 0.5
perturbation = 0.05
[run]
until = 200
[output]
series = { points = 50 }
snapshots = [100]
profiles = { times = [50, 100], bins = 20, range = [-30, 30] }
)";

// Two of the three bodies collapse, at a time that depends on the replica, before until.
constexpr const char* collapse = R"(
[law]
type = "inelastic"
restitution = 0.05
[initial]
type = "rows"
particles = 4
speed = 1
perturbation = 0.4
[run]
until = 2
collapse = "stop"
[output]
series = { points = 41 }
profiles = { times = [0.5, 1.5], bins = 2, range = [-2, 2] }
)";

// Clusters in two columns (left and right), missing until there are any; an average over the interaction zone.
constexpr const char* wet = R"(
[law]
type = "wet"
loss = 0.05
[initial]
type = "rows"
particles = 400
speed = 0.5
perturbation = 0.05
[run]
until = 380
[output]
series = { points = 20 }
profiles = { times = [300], bins = 10, range = [-20, 20] }
zone = { from = 200, samples = 16, bins = 8 }
)";

class Ensembles : public ProgramTest {
 protected:
  Ensembles() {
    write("wet.toml", wet);
    write("shock.toml", shock);
    write("collapse.toml", collapse);
  }

  std::string path(const std::string& name) const { return (folder / name).string(); }
  Result result(const std::string& name) const { return read_result(path(name)); }
  Scene scene(const std::string& name) const { return tools::read_scene(path(name)); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }

  void run(const std::string& command, int status = 0) const {
    const Printed printed = shell("cradle " + command);
    ASSERT_EQ(printed.status, status) << command << "\n" << printed.err;
  }
  void expect_same(const std::string& a, const std::string& b) const {
    ASSERT_FALSE(contents(folder / a).empty()) << a;
    EXPECT_TRUE(contents(folder / a) == contents(folder / b)) << a << " and " << b << " differ";
  }

  static const Column& column(const Result& result, const std::string& group, const std::string& name) {
    if (const auto* found = result.find(group))
      for (const Column& c : found->columns)
        if (c.name == name) return c;
    throw std::out_of_range(group + "/" + name);
  }
  static std::vector<double> numbers(const Result& result, const std::string& group, const std::string& name) {
    return std::visit([](const auto& v) { return std::vector<double>(v.begin(), v.end()); },
                      column(result, group, name).values);
  }
};

// ---- the same bytes

TEST_F(Ensembles, SameBytesOnAnyNumberOfThreads) {
  run("ensemble shock.toml --replicas 60 --threads 1 -o one.h5");
  for (const auto* threads : {"2", "3", "8"}) {
    run(std::string("ensemble shock.toml --replicas 60 -o other.h5 --threads ") + threads);
    expect_same("one.h5", "other.h5");
    std::filesystem::remove(folder / "other.h5");
  }
}

TEST_F(Ensembles, MoreReplicasAreAddedToAFinishedFile) {
  run("ensemble shock.toml --replicas 60 -o whole.h5");
  run("ensemble shock.toml --replicas 13 -o grown.h5");
  const Printed more = shell("cradle ensemble shock.toml --replicas 60 -o grown.h5");
  EXPECT_NE(more.out.find("47 of them now"), std::string::npos) << more.out;
  expect_same("whole.h5", "grown.h5");
  const Printed nothing = shell("cradle ensemble shock.toml --replicas 60 -o grown.h5");
  EXPECT_EQ(nothing.status, 0);
  EXPECT_NE(nothing.out.find("nothing to do"), std::string::npos) << nothing.out;
  expect_same("whole.h5", "grown.h5");
  EXPECT_FALSE(exists("grown.h5.part"));
}

TEST_F(Ensembles, SplitAndMergedInAnyOrder) {
  run("ensemble shock.toml --replicas 60 -o whole.h5");
  run("ensemble shock.toml --replicas 21 -o a.h5");
  run("ensemble shock.toml --first 21 --replicas 19 -o b.h5");
  run("ensemble shock.toml --first 40 --replicas 20 -o c.h5");
  run("merge a.h5 b.h5 c.h5 -o abc.h5");
  run("merge c.h5 a.h5 -o ca.h5");
  run("merge ca.h5 b.h5 -o cab.h5");
  expect_same("whole.h5", "abc.h5");
  expect_same("whole.h5", "cab.h5");
  // A gap filled later.
  run("ensemble shock.toml --replicas 60 -o ca.h5");
  expect_same("whole.h5", "ca.h5");
  const Printed overlap = shell("cradle merge a.h5 ca.h5 -o d.h5");
  EXPECT_EQ(overlap.status, 2);
  EXPECT_NE(overlap.err.find("ca.h5: has replicas that another of the files has too"), std::string::npos)
      << overlap.err;
  EXPECT_FALSE(exists("d.h5"));
}

// Runs a command until its journal has grown by some replicas, then sends it a signal.
std::string until_journalled(const std::string& command, const std::string& file, const std::string& signal) {
  return "size() { stat -c %s " + file + ".part 2>/dev/null || echo 0; }; enough=$(($(size) + 300000)); cradle " +
         command + " & pid=$!; while [ $(size) -lt $enough ]; do sleep 0.01; done; kill -" + signal +
         " $pid; wait $pid";
}

constexpr const char* long_one = "ensemble shock.toml --replicas 3000 --threads 2 -o ";

TEST_F(Ensembles, KilledAndContinuedIsTheSameAsInOneGo) {
  run(std::string(long_one) + "whole.h5");
  for (int kill = 0; kill < 3; ++kill) {
    EXPECT_EQ(shell(until_journalled(std::string(long_one) + "killed.h5", "killed.h5", "KILL")).status, 137);
    ASSERT_TRUE(exists("killed.h5.part"));
    EXPECT_FALSE(exists("killed.h5"));
  }
  const Printed go_on = shell("cradle " + std::string(long_one) + "killed.h5");
  EXPECT_EQ(go_on.status, 0) << go_on.err;
  EXPECT_NE(go_on.err.find("killed.h5.part: "), std::string::npos) << "says what it took from there: " << go_on.err;
  EXPECT_EQ(go_on.out.find("3000 of them now"), std::string::npos) << "not all of them again: " << go_on.out;
  expect_same("whole.h5", "killed.h5");
  EXPECT_FALSE(exists("killed.h5.part"));
}

TEST_F(Ensembles, InterruptedLeavesItsReplicasInTheJournal) {
  run(std::string(long_one) + "whole.h5");
  for (const auto& [signal, status] : {std::pair("INT", 130), std::pair("TERM", 143), std::pair("USR1", 143)}) {
    const Printed stopped = shell(until_journalled(std::string(long_one) + "stopped.h5", "stopped.h5", signal));
    EXPECT_EQ(stopped.status, status) << stopped.err;
    EXPECT_NE(stopped.err.find("stopped.h5.part"), std::string::npos) << stopped.err;
    EXPECT_FALSE(exists("stopped.h5"));
  }
  run(std::string(long_one) + "stopped.h5");
  expect_same("whole.h5", "stopped.h5");
}

TEST_F(Ensembles, DamagedJournalLosesOnlyWhatIsDamaged) {
  run("ensemble shock.toml --replicas 200 -o whole.h5");
  EXPECT_EQ(shell(until_journalled("ensemble shock.toml --replicas 3000 -o damaged.h5", "damaged.h5", "KILL")).status,
            137);
  const std::string journal = contents(folder / "damaged.h5.part");
  for (const bool torn : {true, false}) {
    std::string damaged = journal.substr(0, 200000);
    if (!torn) damaged[100000] = static_cast<char>(damaged[100000] ^ 1);
    write("damaged.h5.part", damaged);
    const Printed go_on = shell("cradle ensemble shock.toml --replicas 200 -o damaged.h5");
    EXPECT_EQ(go_on.status, 0) << go_on.err;
    EXPECT_NE(go_on.err.find("its end was damaged"), std::string::npos) << go_on.err;
    expect_same("whole.h5", "damaged.h5");
    std::filesystem::remove(folder / "damaged.h5");
  }
}

TEST_F(Ensembles, JournalLeftBehindAFinishedFileAddsNothing) {
  run(std::string(long_one) + "whole.h5");
  EXPECT_EQ(shell(until_journalled(std::string(long_one) + "a.h5", "a.h5", "KILL")).status, 137);
  // Killed between writing the file and removing the journal.
  run("ensemble shock.toml --replicas 3000 -o finished.h5");
  std::filesystem::copy(folder / "a.h5.part", folder / "finished.h5.part");
  run("ensemble shock.toml --replicas 3001 -o finished.h5");
  run("ensemble shock.toml --replicas 3001 -o whole.h5");
  expect_same("whole.h5", "finished.h5");
  EXPECT_FALSE(exists("finished.h5.part"));
}

TEST_F(Ensembles, JournalsOfRanksThatAreGoneAreTaken) {
  // As a killed MPI job leaves them: one for each rank.
  run("ensemble shock.toml --replicas 3000 -o whole.h5");
  EXPECT_EQ(shell(until_journalled("ensemble shock.toml --replicas 1500 -o a.h5", "a.h5", "KILL")).status, 137);
  EXPECT_EQ(shell(until_journalled("ensemble shock.toml --first 1500 --replicas 1500 -o b.h5", "b.h5", "KILL")).status,
            137);
  std::filesystem::rename(folder / "b.h5.part", folder / "a.h5.part.3");
  const Printed go_on = shell("cradle ensemble shock.toml --replicas 3000 -o a.h5");
  EXPECT_NE(go_on.err.find("a.h5.part.3: "), std::string::npos) << go_on.err;
  expect_same("whole.h5", "a.h5");
  EXPECT_FALSE(exists("a.h5.part.3"));
}

TEST_F(Ensembles, OneProgramAtATimeWritesAFile) {
  const Printed both = shell(
      "cradle ensemble shock.toml --replicas 100000 -o a.h5 & pid=$!; while [ ! -e a.h5.part ]; do sleep 0.01; done; "
      "cradle ensemble shock.toml --replicas 10 -o a.h5; status=$?; kill $pid; wait $pid; exit $status");
  EXPECT_EQ(both.status, 4);
  EXPECT_NE(both.err.find("another program"), std::string::npos) << both.err;
}

TEST_F(Ensembles, JournalWrittenAnewGivesTheSameBytes) {
  const tools::Study study = tools::ensemble_of(scene("shock.toml"));
  run("ensemble shock.toml --replicas 100 -o whole.h5");
  {
    tools::EnsembleStore store(study, path("anew.h5"));
    store.start_journal(0, 1);  // as soon as it is larger than a byte, and then when it has grown fourfold
    const auto& layout = store.states()[0]->layout();
    for (std::uint64_t k = 0; k < 64; ++k) {
      const RunOutcome end = tools::run_scene(tools::replica_scene(study.scene, k), {tools::ProgressLine::Show::never});
      store.add(0, layout.row(k, end), layout.values(end));
    }
    EXPECT_LT(std::filesystem::file_size(folder / "anew.h5.part"), 32 * 8 * layout.entries) << "64 vectors otherwise";
  }
  run("ensemble shock.toml --replicas 100 -o anew.h5");
  expect_same("whole.h5", "anew.h5");
}

// ---- what the numbers are

class StatisticsOf : public Ensembles, public testing::WithParamInterface<const char*> {};

TEST_P(StatisticsOf, ReplicasAreThoseOfTheRunsOneByOne) {
  constexpr std::size_t n = 12;
  const std::string scene = std::string(GetParam()) + ".toml";
  run("ensemble " + scene + " --replicas 12 -o all.h5");
  const Result all = result("all.h5");
  std::vector<Result> runs;
  for (std::size_t k = 0; k < n; ++k) {
    run(fmt::format("run {} --quiet --set initial.replica={} -o run.h5", scene, k));
    runs.push_back(result("run.h5"));
  }
  EXPECT_EQ(numbers(all, "ensemble/series", "time"), numbers(runs[0], "series", "time"));
  EXPECT_EQ(numbers(all, "ensemble/profiles/0000", "x"), numbers(runs[0], "profiles/0000", "x"));
  EXPECT_EQ(attribute<double>(all.find("ensemble/profiles/0000")->attributes, "time", ""),
            attribute<double>(runs[0].find("profiles/0000")->attributes, "time", ""));
  std::size_t compared = 0;
  for (const auto& group : runs[0].groups) {
    const bool kept = group.name.starts_with("series") || group.name.starts_with("profiles/") || group.name == "zone";
    if (!kept) continue;
    for (const Column& quantity : group.columns) {
      if (quantity.name == "time" || quantity.name == "x") continue;
      const std::string place = "ensemble/" + group.name + "/" + quantity.name;
      const auto mean = numbers(all, place, "mean"), sem = numbers(all, place, "sem"),
                 least = numbers(all, place, "min"), greatest = numbers(all, place, "max");
      std::vector<std::vector<double>> of_runs;
      for (const Result& one : runs) of_runs.push_back(numbers(one, group.name, quantity.name));
      ASSERT_EQ(mean.size(), of_runs[0].size());
      EXPECT_EQ(column(all, place, "mean").width, quantity.width) << place;
      EXPECT_EQ(column(all, place, "mean").unit, quantity.unit) << place;
      for (std::size_t i = 0; i < mean.size(); ++i) {
        std::vector<double> values;
        for (const auto& values_of_run : of_runs)
          if (!std::isnan(values_of_run[i])) values.push_back(values_of_run[i]);
        const auto count = static_cast<double>(values.size());
        if (values.empty()) {
          EXPECT_TRUE(std::isnan(mean[i])) << place;
          continue;
        }
        if (values.size() < n) {
          EXPECT_EQ(numbers(all, place, "count")[i], count);
        }
        const double plain = std::accumulate(values.begin(), values.end(), 0.0) / count;
        double squares = 0, size = 0;
        for (const double x : values) squares += (x - plain) * (x - plain), size = std::max(size, std::abs(x));
        // A dozen roundings each of at most half a unit of the largest value.
        EXPECT_NEAR(mean[i], plain, 3 * n * 0x1p-53 * size) << place << " " << i;
        if (values.size() > 1) {
          EXPECT_NEAR(sem[i], std::sqrt(squares / (count - 1) / count), 1e-12 * size) << place << " " << i;
        }
        EXPECT_EQ(least[i], *std::min_element(values.begin(), values.end())) << place;
        EXPECT_EQ(greatest[i], *std::max_element(values.begin(), values.end())) << place;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 300U);
  for (std::size_t k = 0; k < n; ++k) {  // the table of replicas
    EXPECT_EQ(numbers(all, "replicas", "index")[k], static_cast<double>(k));
    EXPECT_EQ(numbers(all, "replicas", "outcome")[k], 0);
    for (const auto* name : {"contacts", "merges", "energy"})
      EXPECT_EQ(numbers(all, "replicas", name)[k], numbers(runs[k], "series", name).back()) << name << k;
  }
  EXPECT_NE(numbers(all, "replicas", "contacts")[0], numbers(all, "replicas", "contacts")[1]);
}

INSTANTIATE_TEST_SUITE_P(Scenes, StatisticsOf, testing::Values("shock", "wet"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_F(Ensembles, OneReplicaAloneIsTheRunOfThatReplica) {
  run("ensemble shock.toml --first 17 --replicas 1 -o alone.h5");
  run("run shock.toml --quiet --set initial.replica=17 -o run.h5");
  EXPECT_EQ(numbers(result("alone.h5"), "ensemble/series/energy", "mean"),
            numbers(result("run.h5"), "series", "energy"));
}

TEST_F(Ensembles, SeedIsPartOfTheScene) {
  run("ensemble shock.toml --replicas 3 --seed 1 -o a.h5");
  run("ensemble shock.toml --replicas 3 --seed 2 -o b.h5");
  EXPECT_NE(numbers(result("a.h5"), "replicas", "contacts"), numbers(result("b.h5"), "replicas", "contacts"));
}

TEST_F(Ensembles, CollapseIsAnOutcome) {
  run("ensemble collapse.toml --replicas 40 --threads 2 -o c.h5");
  run("ensemble collapse.toml --replicas 15 -o d.h5");
  run("ensemble collapse.toml --replicas 40 --threads 1 -o d.h5");
  expect_same("c.h5", "d.h5");
  const Result all = result("c.h5");
  const auto outcome = numbers(all, "replicas", "outcome"), time = numbers(all, "replicas", "collapse_time");
  const auto times = numbers(all, "ensemble/series", "time");
  std::vector<double> expected(times.size(), 0), profiled(2, 0);
  std::size_t collapsed = 0;
  for (std::size_t k = 0; k < outcome.size(); ++k) {
    collapsed += outcome[k] == 1;
    EXPECT_EQ(outcome[k] == 1, !std::isnan(time[k])) << k;
    for (std::size_t i = 0; i < times.size(); ++i) expected[i] += outcome[k] == 0 || times[i] < time[k];
    for (std::size_t i = 0; i < 2; ++i) profiled[i] += outcome[k] == 0 || (i == 0 ? 0.5 : 1.5) < time[k];
  }
  EXPECT_GT(collapsed, 10U);
  EXPECT_LT(expected.back(), expected.front()) << "some collapse before the end";
  EXPECT_EQ(numbers(all, "ensemble/series/energy", "count"), expected);
  for (std::size_t i = 0; i < 2; ++i)  // a bin without bodies has no number either, but a density
    EXPECT_EQ(profiled[i] < 40 ? numbers(all, fmt::format("ensemble/profiles/000{}/density", i), "count")[0] : 40,
              profiled[i])
        << i;
}

TEST_F(Ensembles, ValuesAreCountedInBinsWhereAskedFor) {
  const std::string spread = " --spread energy=0:40:4000 --spread profiles/0000/density=0:4:8 ";
  run("ensemble shock.toml --replicas 25" + spread + "-o a.h5");
  run("ensemble shock.toml --first 25 --replicas 26" + spread + "-o b.h5");
  run("merge b.h5 a.h5 -o ab.h5");
  run("ensemble shock.toml --replicas 51" + spread + "-o a.h5");
  expect_same("a.h5", "ab.h5");
  const Result all = result("a.h5");
  const Column& counts = column(all, "ensemble/spread/series/energy", "counts");
  EXPECT_EQ(counts.width, 4002U);
  const auto& of_bins = std::get<std::vector<std::uint64_t>>(counts.values);
  for (std::size_t row = 0; row < counts.rows(); ++row)
    EXPECT_EQ(std::accumulate(of_bins.begin() + static_cast<std::ptrdiff_t>(row * 4002),
                              of_bins.begin() + static_cast<std::ptrdiff_t>((row + 1) * 4002), std::uint64_t{0}),
              51U);
  auto energies = numbers(all, "replicas", "energy");
  std::sort(energies.begin(), energies.end());
  EXPECT_NEAR(numbers(all, "ensemble/spread/series/energy", "quantile_50").back(), energies[25], 0.01);
  EXPECT_EQ(shell("cradle ensemble shock.toml --replicas 60 -o a.h5").status, 2)
      << "without the bins: another ensemble";
  EXPECT_EQ(shell("cradle ensemble shock.toml --replicas 60 --spread enrgy=0:1:2 -o e.h5").status, 2);
  EXPECT_EQ(shell("cradle ensemble shock.toml --replicas 60 --spread energy=0:1 -o e.h5").status, 2);
}

// ---- replicas that fail

TEST_F(Ensembles, FailedReplicasAreListedAndHarmNoOther) {
  const Scene shocks = scene("shock.toml");
  const auto fails = [](const Scene& replica) { return replica.initial.replica % 5 == 2; };
  tools::EnsembleOptions options;
  options.replicas = {0, 23};
  options.progress = tools::ProgressLine::Show::never;
  options.runner = [&](const Scene& replica) -> RunOutcome {
    Scene changed = replica;
    if (fails(replica)) {  // an initial state that throws: bodies of a list out of order
      changed.initial = {};
      changed.initial.type = tools::InitialType::list;
      changed.initial.x = {tools::Decimal("1"), tools::Decimal("0")};
      changed.initial.v = {tools::Decimal("0"), tools::Decimal("0")};
    }
    return tools::run_scene(changed, {tools::ProgressLine::Show::never});
  };
  for (const unsigned threads : {1U, 2U}) {
    options.threads = threads;
    const auto end = tools::run_ensemble(shocks, options, path(fmt::format("failed-{}.h5", threads)));
    EXPECT_EQ(end.status, Exit::lost);
    EXPECT_NE(end.warning.find("replica 7 failed: "), std::string::npos) << end.warning;
    EXPECT_EQ(end.outcome, "18 reached the end, 5 failed");
  }
  expect_same("failed-1.h5", "failed-2.h5");
  const Result failed = result("failed-1.h5");
  EXPECT_EQ(numbers(failed, "replicas/failed", "index"), (std::vector<double>{2, 7, 12, 17, 22}));
  const auto& messages = attribute<std::string>(failed.find("replicas/failed")->attributes, "messages", "");
  EXPECT_EQ(std::count(messages.begin(), messages.end(), '\n'), 4) << messages;
  EXPECT_EQ(messages.rfind("replica 2: ", 0), 0U) << messages;

  // The others: what they give without those that failed.
  run("ensemble shock.toml --replicas 2 -o others.h5");
  for (const auto* first : {"3", "8", "13", "18"}) {
    run(std::string("ensemble shock.toml --replicas 4 -o part.h5 --first ") + first);
    run("merge others.h5 part.h5 -o others.h5");
    std::filesystem::remove(folder / "part.h5");
  }
  const Result others = result("others.h5");
  for (const auto* statistic : {"mean", "sem", "min", "max"})
    EXPECT_EQ(numbers(failed, "ensemble/series/energy", statistic),
              numbers(others, "ensemble/series/energy", statistic));

  // They are not run again, and stay listed when the file grows, by the program too.
  const Printed more = shell("cradle ensemble shock.toml --replicas 26 -o failed-1.h5");
  EXPECT_EQ(more.status, 5) << more.err;
  EXPECT_NE(more.out.find("3 of them now"), std::string::npos) << more.out;
  EXPECT_NE(more.err.find("replica 7 failed: "), std::string::npos) << more.err;
  const Result grown = result("failed-1.h5");
  EXPECT_EQ(attribute<std::string>(grown.find("replicas/failed")->attributes, "messages", ""), messages);
}

TEST_F(Ensembles, AllReplicasMayFail) {
  tools::EnsembleOptions options;
  options.replicas = {0, 3};
  options.runner = [](const Scene&) -> RunOutcome { throw std::runtime_error("two\nlines"); };
  EXPECT_EQ(tools::run_ensemble(scene("shock.toml"), options, path("none.h5")).status, Exit::lost);
  EXPECT_TRUE(std::isnan(numbers(result("none.h5"), "ensemble/series/energy", "mean")[0]));
  run("ensemble shock.toml --replicas 4 -o none.h5", 5);
}

TEST_F(Ensembles, NumbersOfWholeRunsAreColumnsOfTheTable) {
  // What run_scene tells in RunOutcome::summary, whatever it is, and energy, are there for every replica.
  tools::EnsembleOptions options;
  options.replicas = {0, 3};
  tools::run_ensemble(scene("shock.toml"), options, path("a.h5"));
  const Scene replica = tools::replica_scene(scene("shock.toml"), 1);
  const RunOutcome alone = tools::run_scene(replica, {tools::ProgressLine::Show::never});
  EXPECT_EQ(numbers(result("a.h5"), "replicas", "energy")[1], alone.energy);
  for (const auto& [name, value] : alone.summary) EXPECT_EQ(numbers(result("a.h5"), "replicas", name)[1], value);
}

// ---- what is refused

TEST_F(Ensembles, OtherScenesAndOtherFilesAreRefused) {
  run("ensemble shock.toml --replicas 3 -o a.h5");
  run("run shock.toml --quiet -o run.h5");
  write("not.h5.part", "not a journal");
  const std::string before = contents(folder / "a.h5");
  struct Refused {
    const char* command;
    int status;
    const char* message;
  };
  for (const auto& [command, status, message] :
       {Refused{"ensemble shock.toml --replicas 5 --set law.restitution=0.98 -o a.h5", 2,
                "a.h5: holds ensembles of something else (found law.restitution = 0.99, here 0.98)"},
        Refused{"ensemble shock.toml --replicas 5 -o run.h5", 2, "run.h5: holds no ensemble"},
        Refused{"ensemble shock.toml --replicas 5 -o not.h5", 4, "not.h5.part: not a journal"},
        Refused{"ensemble shock.toml --replicas 5 --set initial.replica=3 -o b.h5", 2, "initial.replica: "},
        Refused{"ensemble shock.toml --replicas 5 --set output.profiles.range= -o b.h5", 2, "output.profiles.range: "},
        Refused{"ensemble shock.toml -o b.h5", 2, ""}, Refused{"ensemble shock.toml --replicas 0 -o b.h5", 2, ""},
        Refused{"ensemble shock.toml --replicas many -o b.h5", 2, ""},
        Refused{"ensemble shock.toml --replicas 3 -o no/such/folder/b.h5", 4, ""},
        Refused{"merge a.h5 run.h5 -o b.h5", 2, "run.h5: holds no ensemble"},
        Refused{"merge run.h5 a.h5 -o b.h5", 2, "run.h5: holds no ensemble"},
        Refused{"merge a.h5 nothing.h5 -o b.h5", 4, "nothing.h5: "}}) {
    const Printed refused = shell(std::string("cradle ") + command);
    EXPECT_EQ(refused.status, status) << command << refused.err;
    EXPECT_EQ(refused.err.rfind(std::string("cradle: ") + message, 0), 0U) << command << "\n" << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }
  EXPECT_FALSE(exists("b.h5"));
  EXPECT_TRUE(contents(folder / "a.h5") == before);
}

TEST_F(Ensembles, JournalOfAnotherSceneIsRefused) {
  EXPECT_EQ(shell(until_journalled(std::string(long_one) + "a.h5", "a.h5", "KILL")).status, 137);
  const Printed other = shell("cradle ensemble shock.toml --set law.cutoff=1e-4 --replicas 5 -o a.h5");
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("a.h5.part: holds ensembles of something else (found law.cutoff = 1e-5, here 1e-4)"),
            std::string::npos)
      << other.err;
}

TEST_F(Ensembles, InfoTellsWhatFilesAndJournalsHold) {
  run("ensemble shock.toml --replicas 3 -o a.h5");
  const Printed file = shell("cradle info a.h5");
  for (const auto* text : {"3 reached the end", "law.restitution = 0.99", "/replicas", "max of bodies, contacts"})
    EXPECT_NE(file.out.find(text), std::string::npos) << text << "\n" << file.out;
  EXPECT_EQ(file.out.find("ensemble/nodes"), std::string::npos) << "only with --all";
  EXPECT_EQ(shell(until_journalled(std::string(long_one) + "b.h5", "b.h5", "KILL")).status, 137);
  const Printed journal = shell("cradle info b.h5.part");
  EXPECT_EQ(journal.status, 0) << journal.err;
  for (const auto* text : {" replicas finished", "law.restitution = 0.99"})
    EXPECT_NE(journal.out.find(text), std::string::npos) << text << "\n" << journal.out;
}

TEST_F(Ensembles, ListedBodiesArePartOfTheScene) {
  write("list.toml", "[law]\ntype = \"inelastic\"\nrestitution = 0.9\n[initial]\ntype = \"list\"\nfile = "
                     "\"bodies.csv\"\n[run]\nuntil = 5\n");
  write("bodies.csv", "x,v\n0,1\n1,0\n");
  run("ensemble list.toml --replicas 2 -o list.h5");
  write("bodies.csv", "x,v\n0,1\n2,0\n");
  run("ensemble list.toml --replicas 4 -o list.h5", 2);
}

TEST_F(Ensembles, WideTypesOnSeveralThreads) {
  for (const auto* precision : {"double-double", "mpfr --set run.digits=40"}) {
    const std::string scene = std::string("ensemble shock.toml --replicas 6 --set initial.particles=60 --set "
                                          "run.until=50 --set output.profiles.times=[] --set run.precision=") +
                              precision;
    run(scene + " --threads 1 -o a.h5");
    run(scene + " --threads 2 -o b.h5");
    expect_same("a.h5", "b.h5");
    std::filesystem::remove(folder / "a.h5");
    std::filesystem::remove(folder / "b.h5");
  }
}

}  // namespace
}  // namespace cradle::tests
