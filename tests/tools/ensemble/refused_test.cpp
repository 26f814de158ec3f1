// Ensembles refuse files, journals and scenes that do not belong to them.

#include "cradle/tests/tools/ensemble/ensembles.hpp"

#include <algorithm>

namespace cradle::tests::refused_test {

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
    const Printed refused = shell(std::string("cradle ") + command, status);
    EXPECT_TRUE(begins(refused.err, std::string("cradle: ") + message)) << command;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }
  EXPECT_FALSE(exists("b.h5"));
  EXPECT_TRUE(contents(folder / "a.h5") == before);
}

TEST_F(Ensembles, JournalOfAnotherSceneIsRefused) {
  shell(until_journalled("a.h5", "KILL"), 137);
  const Printed other = shell("cradle ensemble shock.toml --set law.cutoff=1e-4 --replicas 5 -o a.h5", 2);
  EXPECT_TRUE(has(other.err, "a.h5.part: holds ensembles of something else (found law.cutoff = 1e-5, here 1e-4)"));
}

TEST_F(Ensembles, ListedParticlesArePartOfTheScene) {
  write("list.toml", "[law]\ntype = \"inelastic\"\nrestitution = 0.9\n[initial]\ntype = \"list\"\nfile = "
                     "\"particles.csv\"\n[run]\nuntil = 5\n");
  write("particles.csv", "x,v\n0,1\n1,0\n");
  run("ensemble list.toml --replicas 2 -o list.h5");
  write("particles.csv", "x,v\n0,1\n2,0\n");
  run("ensemble list.toml --replicas 4 -o list.h5", 2);
}

TEST_F(Ensembles, OfListedParticlesAreMergedWhereverTheirFilesAre) {
  write("list.toml", "[law]\ntype = \"inelastic\"\nrestitution = 0.9\n[initial]\ntype = \"list\"\nfile = "
                     "\"particles.csv\"\n[run]\nuntil = 5\n");
  write("particles.csv", "x,v\n0,1\n1.0000000000000000000000001,0\n");
  run("ensemble list.toml --replicas 2 -o a.h5");
  run("ensemble list.toml --first 2 --replicas 3 -o b.h5");
  run("ensemble list.toml --replicas 5 -o whole.h5");
  std::filesystem::remove(folder / "particles.csv");
  const Printed merged = shell("mkdir elsewhere && cd elsewhere && cradle merge ../a.h5 ../b.h5 -o ../merged.h5", 0);
  expect_same("merged.h5", "whole.h5");
  EXPECT_TRUE(
      has(attribute<std::string>(read("merged.h5").attributes, "scene", ""), "x = [0, 1.0000000000000000000000001]"));
}

}  // namespace cradle::tests::refused_test
