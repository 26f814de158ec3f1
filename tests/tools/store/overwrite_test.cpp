// What is overwritten of proofs whose precision was raised, and of studies that were forced and interrupted; of two
// programs that write to one name the second is refused before it has done anything, at any time. (All else that is
// replaced or not: tests/tools/outputs.txt.)
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/overwrite.hpp"

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tests::overwrite_test {

using namespace cradle::tools;

using Overwriting = ProgramTest;

constexpr const char* scene = "law = { type = 'inelastic', restitution = 0.9 }\nrun.until = 4\n"
                              "initial = { type = 'rows', particles = 6, perturbation = 0.05 }\n";

TEST_F(Overwriting, AProofWhosePrecisionWasRaisedIsMadeAgain) {
  const Scene given = parse_scene(scene, "s.toml"), raised = parse_scene(scene, "s.toml", {"run.precision=float128"});
  Result result{{{"scene", effective_toml(raised)}, {"name", "s"}, {"precision", precision_name(raised.run)}}, {}};
  result.attributes.insert(result.attributes.begin(), {"format_version", std::uint64_t{2}});
  say_how_made(result, "certify", given);
  write_result(result, path("proof.h5"));
  check_overwrite(path("proof.h5"), "certify", &given, Force::no);
  EXPECT_TRUE(has(refusal(Exit::bad_input, [&] { check_overwrite(path("proof.h5"), "certify", &raised, Force::no); }),
                  "another command (found cradle certify --set 'run.precision=double', here certify)"));
}

// A forced study that was interrupted continues; its journal says that it replaces what is there.
TEST_F(Overwriting, AForcedEnsembleCanBeResumed) {
  write("s.toml", scene);
  shell("cradle ensemble s.toml --replicas 2 -o e.h5", 0);
  const Study other = ensemble_of(parse_scene(scene, "s.toml", {"law.restitution=0.8"}));
  {
    EnsembleStore store(other, path("e.h5"));
    store.load(Force::yes);
    store.start_journal(0, {0, 3}, 1 << 20);
  }
  EXPECT_TRUE(exists("e.h5.part"));
  shell("cradle resume e.h5", 0);
  EXPECT_EQ(attribute<std::uint64_t>(read("e.h5").attributes, "replicas", "e.h5"), 3U);
  EXPECT_TRUE(has(attribute<std::string>(read("e.h5").attributes, "scene", "e.h5"), "restitution = 0.8"));
}

// ---- two writers

// The second comes when the first one is about to run its first replica.
TEST_F(Ensembles, SecondOfTwoThatBeginAfreshIsRefused) {
  struct First : OneProcess {
    using OneProcess::OneProcess;
    int share(const std::vector<JobRange>& jobs, const std::function<void(const NextJob&)>& work,
              const std::function<void(std::uint64_t)>& others_took) override {
      begun();
      return OneProcess::share(jobs, work, others_took);
    }
    std::function<void()> begun;
  };
  Printed second{-1, "", ""};
  Interrupt interrupt;
  First first(interrupt);
  first.begun = [&] {
    EXPECT_FALSE(exists("a.h5"));
    second = shell("cradle ensemble shock.toml --first 4 --replicas 4 -o a.h5");
  };
  const EnsembleOptions options{.replicas = {0, 4}, .progress = ProgressLine::Show::never};
  EXPECT_EQ(run_study(ensemble_of(scene("shock.toml")), options, path("a.h5"), first).status, Exit::done);
  EXPECT_EQ(second.status, 4);
  EXPECT_TRUE(begins(second.err, "cradle: a.h5: another program is writing this file (found process "));
  // It comes again when the first one is done: nothing is lost.
  run("ensemble shock.toml --first 4 --replicas 4 -o a.h5");
  run("ensemble shock.toml --replicas 8 -o whole.h5");
  expect_same("whole.h5", "a.h5");
}

TEST_F(Ensembles, OneRunAtATimeWritesToAName) {
  write("a.h5", "old");
  write("a.h5.new", "another user's");
  {
    const FileClaim first(path("a.h5"));
    for (const auto* command : {"run shock.toml -o a.h5", "trust shock.toml --digits 16,31 -o a.h5",
                                "merge a.h5 a.h5 -o a.h5", "sweep shock.toml --vary law.cutoff=0,1 -o a.h5"})
      EXPECT_TRUE(has(shell(std::string("cradle ") + command, 4).err, "a.h5: another program is writing this file"));
    EXPECT_TRUE(contents(folder / "a.h5") == "old");
  }
  run("run shock.toml --quiet --force -o a.h5");
  EXPECT_NE(read("a.h5").find("series"), nullptr);
  EXPECT_EQ(contents(folder / "a.h5.new"), "another user's");
}

}  // namespace cradle::tests::overwrite_test
