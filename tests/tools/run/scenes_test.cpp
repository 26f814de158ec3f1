// Every scene of the package, at a size of a second or less, ends with the status that it is meant to end with: 0, or 3
// for those that follow a collapse (in sweeps and ensembles a collapse is an outcome, and the status is 0). A scene
// that is added needs a row here.
#include <set>
#include <string>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tests::scenes_test {

struct Meant {
  const char *scene, *command, *smaller;
  int status = 0;
};
const char* const dry = " --set initial.particles=400 --set law.restitution=0.97 --set run.until=210";
const char* const wet = " --set initial.particles=1000 --set law.loss=0.01 --set run.until=500";
const char* const zone = " --set initial.particles=1000 --set run.until=500 --set output.zone.from=100";
const char* const kicked = " --set initial.particles=200 --set run.until=2000 --set output.profiles.range=[0,200]";
const char* const hot = " --set initial.particles=400 --set run.until=60 --set output.profiles.times=[60] "
                        "--set output.profiles.range=[-80,80]";
const char* const gas = " --set initial.particles=500 --set run.until=100";
const Meant scenes[] = {
    {"beyond", "run", " --set initial.particles=400 --set law.restitution=0.97 --set run.until=310"},
    {"beyond", "sweep",
     " --replicas 1 --set initial.particles=100 --set law.restitution=0.9 --set run.until=150 "
     "--set output.snapshots=[]"},
    {"classics/blast", "run", hot},
    {"classics/blast", "ensemble --replicas 2", hot},
    {"classics/collapse_number", "run", " --set law.restitution=0.5 --set initial.particles=20", 3},
    {"classics/collapse_number", "sweep", " --replicas 1 --set run.until=10"},
    {"classics/domino", "run", " --set run.until=40"},
    {"classics/heat_wall", "run", " --set run.until=50"},
    {"classics/splash", "run", kicked},
    {"classics/splash", "sweep", kicked},
    {"classics/universality", "run", gas},
    // With all its particles: rounding decides some orders at restitution 0, from t = 6 on.
    {"classics/universality", "sweep", " --replicas 1 --set run.until=10"},
    {"collapse3", "run", "", 3},
    {"collapse_times", "run", "", 3},
    {"collapse_times", "sweep", " --vary law.restitution=0.8,0.9 --replicas 2"},
    {"cooling", "run", gas},
    {"cooling", "sweep", gas},
    {"fig1", "run", ""},
    {"fig10", "run", " --set run.until=500"},
    {"fig11", "run", " --set initial.particles=20000 --set run.until=19000"},
    {"fig2", "run", dry},
    {"fig3", "run", dry},
    {"fig4", "run", dry},
    {"fig4", "ensemble --replicas 2", dry},
    {"fig5", "run", ""},
    {"fig6", "run", wet},
    {"fig7", "run", zone},
    {"fig8", "run", zone},
    {"fig8", "sweep", " --set initial.particles=500 --set run.until=200 --set output.zone.from=100 --replicas 1"},
    {"fig9", "run", ""},
    {"fig9b", "run", ""},
    {"scenarios", "run", " --set initial.particles=2000 --set run.until=1900"},
    {"scenarios", "sweep", " --replicas 1 --set initial.particles=2000 --set run.until=1900"},
};

class Scenes : public ProgramTest, public testing::WithParamInterface<Meant> {};

TEST_P(Scenes, EndAsTheyAreMeantTo) {
  const auto& [scene, command, smaller, status] = GetParam();
  const std::string line = std::string("cradle ") + command + " " + scene + smaller + " --quiet -o it.h5";
  shell(line, status);
}

INSTANTIATE_TEST_SUITE_P(, Scenes, testing::ValuesIn(scenes), [](const auto& parameter) {
  std::string name = std::string(parameter.param.scene) + "_" + parameter.param.command;
  std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '_'; });
  return name;
});

TEST(ScenesMeant, AreAllThereAre) {
  std::set<std::string> tried, bundled;
  for (const Meant& meant : scenes) tried.insert(meant.scene);
  for (const auto& scene : tools::bundled_scenes()) bundled.emplace(scene.name);
  EXPECT_EQ(tried, bundled);
}

}  // namespace cradle::tests::scenes_test
