// Nothing is overwritten that the same command would not make again: a result of other settings or of another command,
// a picture, a page or a folder made from another file, anything that is no result. --force replaces it. What the same
// command makes again is replaced without a word, by the same bytes.

#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/overwrite.hpp"

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tests::overwrite_test {

using namespace cradle::tools;

constexpr const char* scene =
    "[law]\ntype = \"inelastic\"\nrestitution = 0.9\n[initial]\ntype = \"rows\"\nparticles = 6\n"
    "perturbation = 0.05\n[run]\nuntil = 4\n[output]\nseries.points = 5\nsnapshots = [1, 4]\n";

class Overwriting : public ProgramTest {
 protected:
  Overwriting() { write("s.toml", scene); }

  // Refused with this in the message, and the file stays; then forced, and it does not.
  void refused_and_forced(const std::string& command, const std::string& file, const std::string& message) const {
    const std::string before = contents(folder / file);
    const Printed refused = shell("cradle " + command, 2);
    EXPECT_TRUE(begins(refused.err, "cradle: " + file + ": ")) << refused.err;
    EXPECT_TRUE(has(refused.err, message)) << refused.err;
    EXPECT_TRUE(has(refused.err, "--force to replace")) << refused.err;
    EXPECT_TRUE(contents(folder / file) == before) << command;
    shell("cradle " + command + " --force", 0);
    EXPECT_FALSE(contents(folder / file) == before) << command;
  }
};

TEST_F(Overwriting, EveryCommandThatComputesReplacesOnlyItsOwnResult) {
  struct Case {
    std::string command, file, changed, found;
  };
  for (const auto& [command, file, changed, found] :
       {Case{"run s.toml", "s.h5", "run s.toml --set run.until=3 --set output.snapshots=[]", "run.until = 4, here 3"},
        Case{"certify s.toml", "s-certified.h5", "certify s.toml --digits 50",
             "cradle certify, here certify --digits 50)"},
        Case{"certify s.toml --replicas 2", "s-certified.h5", "certify s.toml --replicas 3",
             "--replicas 2, here certify --replicas 3)"},
        Case{"trust s.toml --digits 16,31", "s-trust.h5", "trust s.toml --digits 16,31 --both",
             "--digits 16,31, here trust --digits 16,31 --both)"},
        Case{"words 3 ab --digits 10", "ab.h5", "words 3 ab --digits 11",
             "cradle words 3 ab --digits 10, here words 3 ab --digits 11)"},
        Case{"ensemble s.toml --replicas 2", "s-ensemble.h5", "ensemble s.toml --replicas 2 --set law.restitution=0.8",
             "law.restitution = 0.9, here 0.8"},
        Case{"sweep s.toml --vary law.cutoff=0,1", "s-sweep.h5", "sweep s.toml --vary law.cutoff=0,2", "found "}}) {
    std::filesystem::remove(folder / file);
    shell("cradle " + command, 0);
    const std::string first = contents(folder / file);
    EXPECT_EQ(shell("cradle " + command, 0).err, "");
    EXPECT_TRUE(contents(folder / file) == first) << command;
    refused_and_forced(changed, file, found);
  }
}

TEST_F(Overwriting, AFileThatIsNoResultStays) {
  for (const std::string command :
       {"run s.toml", "certify s.toml", "trust s.toml --digits 16,31", "words 3 ab --digits 10"}) {
    write("notes.txt", "mine");
    refused_and_forced(command + " -o notes.txt", "notes.txt", "not a result");
  }
  write("s.h5", "");  // nothing in it to lose
  shell("cradle run s.toml", 0);
  shell("cp s.h5 other.h5 && cradle run s.toml -o s.toml", 2);
  EXPECT_EQ(contents(folder / "s.toml"), scene);
}

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

TEST_F(Overwriting, MergedReplicasStayAmongOthers) {
  for (const char* first : {"0", "2", "4"})
    shell(std::string("cradle ensemble s.toml --replicas 2 --first ") + first + " -o " + first + ".h5", 0);
  shell("cradle merge 0.h5 2.h5 -o all.h5", 0);
  refused_and_forced("merge 2.h5 4.h5 -o all.h5", "all.h5", "holds replicas that none of the files has");
  shell("cradle merge 0.h5 2.h5 4.h5 -o all.h5", 0);  // has all of them
  shell("cradle run s.toml -o all.h5 --force", 0);
  refused_and_forced("merge 0.h5 2.h5 -o all.h5", "all.h5", "holds no ensemble");
}

// A forced study that was interrupted continues; its journal says that it replaces what is there.
TEST_F(Overwriting, AForcedEnsembleCanBeResumed) {
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

TEST_F(Overwriting, PicturesAndPagesOfOtherFilesStay) {
  shell("cradle run s.toml && cp s.h5 t.h5", 0);
  for (const auto& [command, file] : {std::pair<std::string, std::string>("plot", "out.png"), {"report", "out.html"}}) {
    write(file, "mine");
    refused_and_forced(command + " s.h5 -o " + file, file, "not what `cradle " + command);
    shell("cradle run s.toml -o s.h5 --force --set law.restitution=0.8", 0);
    shell("cradle " + command + " s.h5 -o " + file, 0);  // of the same file, which has changed
    refused_and_forced(command + " t.h5 -o " + file, file, "t.h5` makes again");
    shell("cp t.h5 s.h5", 0);
  }
}

}  // namespace cradle::tests::overwrite_test
