// The other commands. (Bad input: tests/tools/messages.txt.)

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::commands_test {

class Commands : public ProgramTest {
 protected:
  void make_small_result() const {
    shell("cradle run fig2 --quiet --set initial.particles=200 --set run.until=60 --set output.snapshots=[20,60] --set "
          "output.profiles.times=[30] --set output.series.points=5 -o small.h5",
          0);
  }
};

TEST_F(Commands, InfoPrintsSceneTimesAndCounts) {
  make_small_result();
  const Printed info = shell("cradle info small.h5", 0);
  for (const auto* text : {"reached the end", "initial.particles = 200", "/snapshots/0001", "time = 60", "energy"})
    EXPECT_TRUE(has(info.out, text));
  EXPECT_FALSE(has(info.out, "initial.seed")) << "defaults only with --all";
  EXPECT_TRUE(has(shell("cradle info small.h5 --all").out, "initial.seed = 1"));
}

TEST_F(Commands, ExportWritesOneFilePerGroupWithFullDigits) {
  make_small_result();
  shell("cradle export small.h5 --to csv", 0);
  const std::string series = contents(folder / "csv/series.csv");
  EXPECT_EQ(std::count(series.begin(), series.end(), '\n'), 6) << "a head line and five samples";
  EXPECT_TRUE(has(series, "time"));
  const std::string snapshot = contents(folder / "csv/snapshots/0001.csv");
  EXPECT_EQ(snapshot.substr(0, 2), "# ");
  EXPECT_TRUE(has(snapshot, "# time = 60"));
  EXPECT_TRUE(exists("csv/profiles/0000.csv"));
}

TEST_F(Commands, TheoryKnowsTheTurnoverOfTheFront) {
  const Printed csv = shell("cradle theory fig2 --csv", 0);
  EXPECT_TRUE(has(csv.out, "turnover_time,(4) = 0,continuous,,19"));
  EXPECT_TRUE(has(csv.out, "maximal_front,x_max,continuous,,386.4477"));
  EXPECT_TRUE(has(csv.out, "maximal_front,max(x_n - x_0),discrete,,386.447771"));
  EXPECT_TRUE(has(shell("cradle theory fig2").out, "misprinted"));
}

TEST_F(Commands, TheoryThatIsNotThereIsOneSentence) {
  EXPECT_TRUE(begins(shell("cradle theory classics/domino", 0).out, "no predictions: "));
  const std::string sticky = shell("cradle theory fig1", 0).out, ring = shell("cradle theory cooling", 0).out;
  EXPECT_FALSE(has(sticky, "Misprints")) << "of a table without printed forms";
  EXPECT_EQ(has(ring, "Misprints"), has(shell("cradle theory cooling --csv").out, ",printed,"));
}

TEST_F(Commands, ScenesAreListedAndPrinted) {
  const Printed list = shell("cradle scenes");
  for (const auto* name : {"fig2", "fig3", "fig4", "collapse3"}) {
    EXPECT_TRUE(has(list.out, name));
    shell(std::string("cradle scenes ") + name + " > copy.toml && cradle check copy.toml", 0);
  }
  shell("cradle scenes nothing", 2);
  const auto line = list.out.find("\ncollapse_times  "),
             title = list.out.find("  collapse times of the inelastic shock\n");
  EXPECT_TRUE(line < title && list.out.find('\n', line + 1) > title) << list.out;
}

TEST_F(Commands, CheckPrintsEffectiveValuesAndCost) {
  // Counted: 57079264, and 12153997, where many particles have most of their collisions still before them.
  const std::string fig11 = shell("cradle check fig11").out;
  for (const auto* text : {"collisions: about 5.7e+07\n", "end: 100 at most", "memory: about 20 MB"})
    EXPECT_TRUE(has(fig11, text));
  EXPECT_TRUE(has(shell("cradle check fig6").out, "collisions: about 1.5e+07\n"));
  // Counted: 34681883.
  EXPECT_TRUE(
      has(shell("cradle check fig2").out, "collisions: about 3.5e+07\ntime: about 1.7 s at 2e+07 collisions/s\n"));
  EXPECT_TRUE(has(shell("cradle check fig2 --set run.precision=mpfr --set run.digits=50").out, "time: about 21 s at"))
      << "13.9 s at 2.5 million collisions/s, in proportion to the 2e7 assumed for double";
  EXPECT_TRUE(
      has(shell("cradle check fig2 --set run.until=9000").out, "until inelastic collapse at about t = 6.5e+03"));
  EXPECT_TRUE(has(shell("cradle check cooling").out, "particles in the active zone at the end: 1e+05"));
  const Printed check = shell("cradle check fig2 --set run.until=100", 0);
  for (const auto* text : {"law.restitution = 0.999", "run.until = 100", "collisions: about", "memory: about"})
    EXPECT_TRUE(has(check.out, text));
  EXPECT_FALSE(exists("fig2.h5"));
}

// A run past its collapse may take for ever: `run` prints the line of `check` before it starts, and ends as without it.
TEST_F(Commands, RunWarnsOfCollapseAsCheckDoes) {
  const std::string past = "fig2 --set law.restitution=0.9 --set run.until=70", line = "collisions: about";
  const std::string checked = shell("cradle check " + past + " | grep '^" + line + "'", 0).out;
  EXPECT_TRUE(has(checked, " until inelastic collapse at about t = 61.8, without limit after it\n")) << checked;
  EXPECT_TRUE(has(shell("cradle run " + past, 0).err, checked));
  EXPECT_EQ(shell("cradle run " + past + " --quiet", 0).err, "");
  EXPECT_FALSE(has(shell("cradle run " + past + " --set run.until=50 --force", 0).err, line));
  EXPECT_TRUE(has(shell("cradle check " + past + " --set run.collapse=stop").out, "where the run stops\n"));
  const Printed merge = shell("cradle check " + past + " --set run.collapse=merge --set run.merge_speed=1e-8");
  EXPECT_TRUE(has(merge.out, "after which particles merge\n")) << merge.out;
}

// Plain rows of 200: said beforehand, ended within seconds, with status 3. Restitution 0.8 takes 2e6 collisions, 0.9
// 1e7.
TEST_F(Commands, ACollapseOfManyParticlesEndsAsSaidBeforehand) {
  write("rows.toml", "law = { type = 'inelastic', restitution = 0.8 }\nrun.until = 1e4\n"
                     "initial = { type = 'rows', particles = 200, speed = 0.5, spacing = 1, perturbation = 0.3 }\n");
  const Printed run = shell("timeout 100 cradle run rows.toml", 3);
  EXPECT_TRUE(has(run.out, "that this is an inelastic collapse is not proved")) << run.out;
  EXPECT_TRUE(has(run.out, "inelastic collapse of many particles, not proved: t = 3")) << run.out;
  EXPECT_TRUE(has(run.err, "where the run stops\nthe run ends (status 3) where a collapse is proved or")) << run.err;
  EXPECT_TRUE(has(shell("cradle check rows.toml").out, run.err));
  EXPECT_TRUE(has(shell("cradle info rows.h5").out, "inelastic collapse of many particles, not proved"));
}

TEST_F(Commands, CheckShowsLongListsByTheirEnds) {
  std::string csv = "x,v\n";
  for (int k = 0; k < 1000; ++k) csv += std::to_string(k) + ",1\n";
  write("b.csv", csv);
  write("s.toml", "law.type = 'sticky'\nrun.until = 1\ninitial = { type = 'list', file = 'b.csv' }\n");
  const Printed check = shell("cradle check s.toml");
  EXPECT_TRUE(has(check.out, "initial.x = [0, 1, ..., 999] (1000 values)\n"));
}

TEST_F(Commands, WhatIsPrintedArrivesOrTheStatusSaysSo) {
  make_small_result();
  for (const auto* command :
       {"scenes", "scenes fig2", "scenes --keys", "check fig2", "info small.h5", "theory fig2 --csv", "theory fig2",
        "run collapse3 --set law.restitution=0.9 --set run.stop_gap=", "--version", "--help", "run --help"}) {
    const Printed full = shell(std::string("cradle ") + command + " > /dev/full", 4);
    EXPECT_TRUE(has(full.err, "output")) << command;
  }
}

TEST_F(Commands, PlotMakesPicturesInEveryFormat) {
  make_small_result();
  for (const auto* name : {"small.png", "small.pdf", "small.svg"}) {
    shell(std::string("cradle plot small.h5 -o ") + name, 0);
    EXPECT_GT(contents(folder / name).size(), 10000U) << name;
  }
}

TEST_F(Commands, VersionNamesCompilerAndScalarTypes) {
  const Printed version = shell("cradle --version", 0);
  for (const auto* text : {"cradle 0.", "compiler", "-ffp-contract=off", "double"}) EXPECT_TRUE(has(version.out, text));
}

TEST_F(Commands, EveryHelpEndsWithAnExampleAndTheExitStatuses) {
  for (const std::string command : {"", "run", "check", "info", "export", "theory", "scenes", "plot", "trust",
                                    "certify", "ensemble", "sweep", "merge"}) {
    const Printed help = shell("cradle " + command + " --help", 0);
    EXPECT_TRUE(has(help.out, "\nExample: cradle " + command));
    EXPECT_TRUE(has(help.out, "\nExit status: 0 done"));
  }
}

}  // namespace cradle::tests::commands_test
