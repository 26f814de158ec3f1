// Pictures: every kind is made from a small run, without a display, as PNG and as SVG, and twice with the same bytes.
// The contents of a file decide which pictures it has: the names that the program prints are checked.

#include <algorithm>
#include <string>
#include <vector>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::plots_test {

struct Kind {
  const char* name;
  const char* command;              // makes `it.h5`
  std::vector<std::string> others;  // pictures beside the main one
  int status = 0;
};

void PrintTo(const Kind& kind, std::ostream* stream) { *stream << kind.command; }

class Pictures : public ProgramTest, public testing::WithParamInterface<Kind> {
 protected:
  // Names of the pictures of it.h5, the main one `name` with this extension.
  std::vector<std::string> plot(const std::string& name, const std::string& extension) const {
    std::vector<std::string> names{name + extension};
    for (const auto& other : GetParam().others) names.push_back(name + "-" + other + extension);
    std::string printed;
    for (const auto& file : names) printed += file + "\n";
    const Printed plot = shell("env -u DISPLAY -u WAYLAND_DISPLAY cradle plot it.h5 -o " + names.front(), 0);
    EXPECT_EQ(plot.out, printed);
    EXPECT_EQ(plot.err, "");
    return names;
  }
};

TEST_P(Pictures, AreMadeWithoutDisplayAndTwiceTheSame) {
  const Printed run = shell(GetParam().command + std::string(" --quiet -o it.h5"));
  ASSERT_EQ(run.status, GetParam().status) << run.err;
  for (const std::string extension : {".png", ".svg"}) {
    const auto once = plot("once", extension), again = plot("again", extension);
    for (std::size_t k = 0; k < once.size(); ++k) {
      const std::string picture = contents(folder / once[k]);
      EXPECT_EQ(picture.substr(0, 5), extension == ".png" ? "\x89PNG\r" : "<?xml") << once[k];
      EXPECT_GT(picture.size(), 10000U) << once[k];
      EXPECT_EQ(picture, contents(folder / again[k])) << once[k];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Pictures,
    testing::Values(
        Kind{"Sticky",
             "cradle run fig1 --set initial.left.particles=100 --set initial.right.particles=100 --set run.until=100 "
             "--set output.snapshots=[0,50,100] --set output.profiles.times=[0,50,100] "
             "--set output.profiles.range=[-80,80]",
             {"energy"}},
        Kind{"Shock",
             "cradle run fig2 --set initial.particles=200 --set run.until=60 --set output.snapshots=[20,60] "
             "--set output.profiles.times=[30] --set output.series.points=20",
             {"energy"}},
        Kind{"Structure",
             "cradle run fig3 --set initial.particles=400 --set law.restitution=0.97 --set run.until=230 "
             "--set output.snapshots=[230] --set output.series.points=20",
             {"energy"}},
        Kind{"Beyond",
             "cradle run beyond --set initial.particles=400 --set law.restitution=0.97 --set run.until=450 "
             "--set output.snapshots=[250,300,320,321,322,323,324,325,326,327,328,329,330,331,332,333,334,335,336,337]",
             {"distributions", "spacetime", "shock", "structure", "energy"}},
        Kind{"BeyondSweep",
             "cradle sweep beyond --vary law.cutoff=1e-3,1e-2 --replicas 2 --set initial.particles=400 "
             "--set law.restitution=0.97 --set run.until=420",
             {"rates", "parameters"}},
        Kind{"SpaceTime", "cradle run fig5", {}},
        Kind{"WetShock",
             "cradle run fig6 --set initial.particles=400 --set law.loss=0.01 --set run.until=150 "
             "--set output.snapshots=[20,50,100] --set output.profiles.times=[20,50,100] --set output.masses=[100] "
             "--set output.series.points=20",
             {"energy"}},
        Kind{"Zone",
             "cradle run fig7 --set initial.particles=2000 --set law.loss=0.01 --set run.until=1000 "
             "--set output.snapshots=[1000] --set output.zone.from=300 --set output.zone.samples=100 "
             "--set output.series.points=20",
             {"shock", "energy"}},
        Kind{"Clusters",
             "cradle run fig11 --set initial.particles=20000 --set run.until=19000 --set output.masses=[1000,19000] "
             "--set output.series.points=400",
             {"scaling", "energy"}},
        Kind{"ClusterModel", "cradle run fig10 --set run.until=500", {"scaling", "energy"}},
        Kind{"Particles", "cradle run collapse3", {}, 3},
        Kind{"Certificate",
             "cradle certify fig2 --set initial.particles=100 --set law.restitution=0.97 --set run.until=60 "
             "--set output.snapshots=[60] --set output.profiles.times=[] --set output.series.points=20",
             {"energy", "certificate"}},
        Kind{"Cooling",
             "cradle run cooling --set initial.particles=500 --set run.until=100 --set output.series.points=20 "
             "--set output.snapshots=[10,100] --set output.masses=[10,100]",
             {"field", "masses"}},
        Kind{"Blast",
             "cradle ensemble classics/blast --replicas 2 --set initial.particles=400 --set run.until=60 "
             "--set output.series.points=20 --set output.profiles.times=[20,60] --set output.profiles.range=[-80,80]",
             {}},
        Kind{"Domino", "cradle run classics/domino --set run.until=40", {}},
        Kind{"Splash",
             "cradle sweep classics/splash --vary initial.seed=1,2 --replicas 2 --set initial.particles=200 "
             "--set run.until=200 --set output.series.points=20 --set output.profiles.times=[20,50,100,200] "
             "--set output.profiles.range=[0,200]",
             {}},
        Kind{"CollapseNumber",
             "cradle sweep classics/collapse_number --vary initial.particles=6,10,14 --replicas 5 "
             "--set law.restitution=0.5",
             {}},
        Kind{"Marbles", "cradle sweep classics/marbles --replicas 2 --set run.until=20", {}},
        Kind{"BetweenWalls", "cradle sweep classics/between_walls --replicas 1 --set run.until=5", {}},
        Kind{
            "Bouncing", "cradle sweep classics/bouncing --vary walls.left.amplitude=1,1.4,1.7 --set run.until=100", {}},
        Kind{"Column", "cradle sweep classics/column --set run.until=40", {}},
        Kind{"Universality",
             "cradle sweep classics/universality --set initial.particles=200 --set run.until=50 "
             "--set output.series.points=20",
             {}},
        Kind{"Ensemble",
             "cradle ensemble fig2 --replicas 4 --set initial.particles=40 --set law.restitution=0.6 "
             "--set law.cutoff=0 --set run.stop_gap=1e-12 --set run.until=30 --set output.snapshots=[] "
             "--set output.series.points=20 --set output.profiles.times=[2,4] --set output.profiles.range=[-8,8]",
             {"profiles", "collapse"}},
        Kind{"CoolingSweep",
             "cradle sweep cooling --set initial.particles=500 --set run.until=100 --set output.series.points=20",
             {}},
        Kind{"ZoneSweep",
             "cradle sweep fig8 --cuts --vary initial.speed=0.5,1 --vary law.loss=0.01,0.02 --replicas 2 "
             "--set initial.particles=1000 --set run.until=500 --set output.zone.from=100 "
             "--set output.zone.samples=100 --set output.series.points=20",
             {"parameters"}},
        Kind{"MapSweep",
             "cradle sweep fig2 --vary law.restitution=0.5,0.9 --vary initial.speed=0.5,1 --set initial.particles=40 "
             "--set run.until=10 --set output.snapshots=[] --set output.series.points=5 "
             "--set output.profiles.times=[]",
             {}}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

class Plots : public ProgramTest {};

TEST_F(Plots, WhatCannotBeDrawnIsOneMessage) {
  shell("cradle run fig5 --quiet -o it.h5 && echo junk > junk.h5 && head -c 3000 it.h5 > cut.h5", 0);
  struct Case {
    const char* arguments;
    int status;
    const char* names;
  };
  for (const Case& wrong :
       {Case{"it.h5 -o it.gif", 2, ".gif"}, Case{"it.h5 -o no/such/it.png", 4, "no/such/it.png"},
        Case{"junk.h5", 4, "junk.h5"}, Case{"cut.h5", 4, "cut.h5"}, Case{"nothing.h5", 4, "nothing.h5"}}) {
    const Printed plot = shell(std::string("cradle plot ") + wrong.arguments, wrong.status);
    EXPECT_TRUE(has(plot.err, wrong.names));
    EXPECT_EQ(std::count(plot.err.begin(), plot.err.end(), '\n'), 1) << plot.err;
  }
}

TEST_F(Plots, AreMadeWhereNobodyReadsTheirNames) {
  shell("cradle run fig5 --quiet -o it.h5", 0);
  // The reader has closed its end before anything is written.
  const Printed plot =
      shell("mkfifo gone; (cat gone; cradle plot it.h5; echo $? >status) | (exec <&-; echo >gone); cat status");
  EXPECT_EQ(plot.out, "0\n");
  EXPECT_EQ(plot.err, "");
  EXPECT_TRUE(exists("it.png"));
}

TEST_F(Plots, LeaveNoFilesBehind) {
  shell("cradle run fig5 --quiet -o it.h5 && mkdir temporary", 0);
  shell("TMPDIR=$PWD/temporary cradle plot it.h5", 0);
  EXPECT_EQ(shell("ls temporary").out, "");
  shell("TMPDIR=$PWD/nowhere cradle plot it.h5", 4);
}

}  // namespace cradle::tests::plots_test
