// The numbers in files of ensembles: statistics compared with those of single runs, how replicas ended, replicas that
// collapse; the points that texts of sweeps describe, and the table of a small sweep, compared with runs made one by
// one. (Replicas that fail, what every one records: tests/tools/outputs.txt. Texts that are refused:
// tests/tools/messages.txt.)
#include <numeric>

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/replica_run.hpp"
#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/support/bytes.hpp"

namespace cradle::tests::ensemble_test {

using tools::RunOutcome;

class StatisticsOf : public Ensembles, public testing::WithParamInterface<const char*> {};

TEST_P(StatisticsOf, ReplicasAreThoseOfTheRunsOneByOne) {
  constexpr std::size_t n = 12;
  const std::string scene = std::string(GetParam()) + ".toml";
  run("ensemble " + scene + " --replicas 12 -o all.h5");
  const Result all = read("all.h5");
  std::vector<Result> runs;
  for (std::size_t k = 0; k < n; ++k) {
    run(fmt::format("run {} --quiet --force --set initial.replica={} -o run.h5", scene, k));
    runs.push_back(read("run.h5"));
  }
  std::size_t compared = 0;
  for (const auto& group : runs[0].groups) {
    if (group.name.starts_with("snapshots/")) continue;
    const tools::Group* bins = all.find("ensemble/" + (group.name.starts_with("series") ? "series" : group.name));
    ASSERT_NE(bins, nullptr) << group.name;
    for (const tools::Attribute& one : bins->attributes)
      EXPECT_EQ(std::ranges::count(group.attributes, one), 1) << group.name << ": " << one.first;
    for (const Column& quantity : group.columns) {
      const std::string place = "ensemble/" + group.name + "/" + quantity.name;
      if (const Column* same = bins->find(quantity.name)) {  // times, bins
        EXPECT_TRUE(same->values == quantity.values) << place;
        continue;
      }
      if (quantity.name == "index" || quantity.name.ends_with("_sem")) {
        EXPECT_EQ(all.find(place), nullptr) << "numbers that name particles and errors of one run have no mean";
        continue;
      }
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
    for (const auto* name : {"collisions", "merges", "energy"})
      EXPECT_EQ(numbers(all, "replicas", name)[k], numbers(runs[k], "series", name).back()) << name << k;
  }
  EXPECT_NE(numbers(all, "replicas", "collisions")[0], numbers(all, "replicas", "collisions")[1]);
}

INSTANTIATE_TEST_SUITE_P(Scenes, StatisticsOf, testing::Values("shock", "wet", "falling"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_F(Ensembles, CollapseIsAnOutcome) {
  run("ensemble collapse.toml --replicas 40 -o c.h5");
  const Result all = read("c.h5");
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
  for (std::size_t i = 0; i < 2; ++i)  // a bin without particles has no number either, but a density
    EXPECT_EQ(profiled[i] < 40 ? numbers(all, fmt::format("ensemble/profiles/000{}/density", i), "count")[0] : 40,
              profiled[i])
        << i;
}

TEST_F(Ensembles, ValuesAreCountedInBinsWhereRequested) {
  const std::string spread = " --spread energy=0:40:4000 --spread profiles/0000/density=0:4:8 ";
  run("ensemble shock.toml --replicas 51" + spread + "-o a.h5");
  const Result all = read("a.h5");
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
}

TEST_F(Ensembles, AMessageOfSeveralLinesIsOneLineOfTheFile) {
  tools::EnsembleRecord record;
  tools::EnsembleState("", scene("shock.toml"), {}).put_failure(record, 0, "two\nlines");
  EXPECT_EQ(record.messages.at(0), "two lines");
}

TEST_F(Ensembles, NumbersOfWholeRunsAreColumnsOfTheTable) {
  // What run_scene reports in RunOutcome::summary, whatever it is, and energy, are there for every replica.
  run("ensemble shock.toml --replicas 3 -o a.h5");
  const Scene replica = tools::replica_scene(scene("shock.toml"), 1);
  const RunOutcome alone = tools::run_scene(replica, {tools::ProgressLine::Show::never});
  EXPECT_EQ(numbers(read("a.h5"), "replicas", "energy")[1], alone.energy);
  for (const auto& [name, value] : alone.summary) EXPECT_EQ(numbers(read("a.h5"), "replicas", name)[1], value);
}

// What a thread keeps from one replica to the next does not show: the records are those of runs that are made anew.
TEST_F(Ensembles, ReplicasThatBeginARunAgainAreRunsOfTheirOwn) {
  const std::string law = "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n";
  for (const std::string& text :
       {std::string(shock), std::string(collapse), std::string(wet),
        law + "initial = { type = 'gas', particles = 20, random_masses = [0.1, 1e3] }\nrun.until = 5\n"
              "output.series.points = 9\n",
        law + "initial = { type = 'gas', particles = 20 }\nrun = { until = 5, precision = 'double-double' }\n"
              "output.series.points = 4\n"}) {
    const Scene scene = tools::parse_scene(text, "again.toml");
    const tools::EnsembleState state("", scene, {});
    tools::Interrupt interrupt;
    tools::ReplicaRun runs(state, interrupt);
    tools::EnsembleRecord again, alone;
    for (std::uint64_t k = 0; k < 5; ++k) {
      runs.add(k, again);
      const RunOutcome run = tools::run_scene(tools::replica_scene(scene, k), {tools::ProgressLine::Show::never});
      state.put(alone, state.layout().row(k, run), state.layout().values(run));
    }
    EXPECT_EQ(again.rows.size(), 5U);
    EXPECT_TRUE(again.messages.empty()) << text;
    EXPECT_TRUE(tools::to_bytes(again) == tools::to_bytes(alone)) << text;
  }
}

// ---- sweeps

using tools::Sweep;
using tools::sweep_points;

Sweep of(std::vector<std::string> vary, bool cuts = false, std::vector<std::string> points = {}) {
  Sweep sweep;
  sweep.vary = std::move(vary), sweep.cuts = cuts, sweep.points = std::move(points);
  return sweep;
}

// Even ones keep their ends as they are written; several keys combine, or are varied one by one.
TEST(SweepPoints, AreThoseOfTheTexts) {
  const std::vector<std::string> two{"law.loss=0.1,0.2", "initial.speed=1:3:3"};
  const std::pair<Sweep, std::string> rows[] = {
      {of({"law.loss=0.1:0.5:5"}), "law.loss=0.1 | law.loss=0.2 | law.loss=0.3 | law.loss=0.4 | law.loss=0.5"},
      {of({"law.loss=1e-3:1e1:5:log"}), "law.loss=1e-3 | law.loss=0.01 | law.loss=0.1 | law.loss=1 | law.loss=1e1"},
      {of(two), "law.loss=0.1 initial.speed=1 | law.loss=0.1 initial.speed=2 | law.loss=0.1 initial.speed=3 | "
                "law.loss=0.2 initial.speed=1 | law.loss=0.2 initial.speed=2 | law.loss=0.2 initial.speed=3"},
      {of(two, true), "law.loss=0.1 | law.loss=0.2 | initial.speed=1 | initial.speed=2 | initial.speed=3"},
      {of({}, false, {"law.type=wet law.loss=0.3", "law.type=sticky"}), "law.type=wet law.loss=0.3 | law.type=sticky"}};
  for (const auto& [sweep, wanted] : rows) {
    std::vector<std::string> points;
    for (const tools::SweepPoint& point : sweep_points(sweep))
      points.push_back(fmt::format("{}", fmt::join(point, " ")));
    EXPECT_EQ(fmt::format("{}", fmt::join(points, " | ")), wanted);
  }
}

// Found by fuzzing: with a million for a thousand, many keys of so many values each were written out before they were
// counted.
TEST(SweepPoints, AreCountedBeforeMemoryForThemIsTaken) {
  const auto refused = [](const Sweep& sweep) { return refusal(Exit::bad_input, [&] { sweep_points(sweep, 1000); }); };
  const std::vector<std::string> nine(9, "law.loss=1:2:1000");  // of which the first two are too many
  EXPECT_TRUE(has(refused(of(nine)), "too many points (found 1e+06)"));
  EXPECT_TRUE(has(refused(of(nine, true)), "too many points (found 2e+03)"));
  std::vector<std::string> of_one_value(8, "law.type=wet");  // in each of the points
  of_one_value.emplace_back("law.loss=1:2:1000");
  EXPECT_TRUE(has(refused(of(of_one_value)), "too many values (found 9e+03 in all points)"));
  EXPECT_EQ(sweep_points(of({"law.loss=1:2:3", "initial.seed=1:3:3"}), 9).size(), 9U);
  EXPECT_THROW(sweep_points(of({"law.loss=1:2:3", "initial.seed=1:3:3"}), 8), tools::Error);
}

using SweepCommand = ProgramTest;

TEST_F(SweepCommand, TableIsTheMeanOfTheRuns) {
  const std::string scene = "fig7 --set initial.particles=200 --set run.until=60 --set output.zone.from=20 "
                            "--set output.series.points=3 ";
  const std::string command = "cradle sweep " + scene + "--vary law.loss=0.01,0.02 --replicas 3 --quiet -o sweep.h5";
  shell(command, 0);
  const Result result = read("sweep.h5");
  EXPECT_EQ(numbers(result, "sweep", "law.loss"), (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(numbers(result, "sweep", "replicas"), (std::vector<double>{3, 3}));
  double sum = 0, squares = 0;
  for (const int replica : {0, 1, 2}) {
    const std::string number = std::to_string(replica);
    shell("cradle run " + scene + "--set law.loss=0.02 --set initial.replica=" + number + " --quiet --force -o one.h5",
          0);
    const double energy = numbers(read("one.h5"), "series", "energy").back();
    sum += energy, squares += energy * energy;
  }
  // Rounding of sums of energies of order 25.
  EXPECT_NEAR(numbers(result, "sweep", "energy")[1], sum / 3, 1e-13);
  EXPECT_NEAR(numbers(result, "sweep", "energy_error")[1], std::sqrt((squares - sum * sum / 3) / 6), 1e-6);
  // The points are ensembles; the same command finds nothing left to do, another sweep is refused.
  EXPECT_NE(result.find("points/0001/replicas"), nullptr);
  const auto before = contents(path("sweep.h5"));
  shell(command, 0);
  EXPECT_EQ(contents(path("sweep.h5")), before);
  shell("cradle sweep " + scene + "--vary law.loss=0.01,0.03 --replicas 3 --quiet -o sweep.h5", 2);
  shell("cradle sweep " + scene + "--vary law.los=0.01,0.03 --quiet -o other.h5", 2);
}

}  // namespace cradle::tests::ensemble_test
