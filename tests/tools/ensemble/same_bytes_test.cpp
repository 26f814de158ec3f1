// An ensemble gives the same file for any history: interrupted, killed, with damaged or left-over journals. (On any
// number of threads and ranks, split and merged: tests/tools/ensemble/outputs.txt. What is refused:
// tests/tools/messages.txt.)

#include "cradle/core/ensemble/executor.hpp"
#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"

namespace cradle::tests::same_bytes_test {

TEST_F(Ensembles, KilledAndContinuedIsTheSameAsInOneGo) {
  for (int kill = 0; kill < 3; ++kill) {
    shell(until_journalled("killed.h5", "KILL"), 137);
    ASSERT_TRUE(exists("killed.h5.part"));
    EXPECT_FALSE(exists("killed.h5"));
  }
  const std::string all = enough_for("killed.h5");
  const Printed go_on = expect_continued("killed.h5");
  EXPECT_TRUE(has(go_on.err, "killed.h5.part: ")) << "says what it took from there";
  EXPECT_FALSE(has(go_on.out, all + " of them now")) << "not all of them again";
}

// The first kill leaves records of replicas, which the second call rewrites as statistics and tables of replicas.
TEST_F(Ensembles, KilledAndContinuedWithEveryReplicaToo) {
  write("shock.toml", std::string(shock) + "every_replica = true\n");
  for (int kill = 0; kill < 2; ++kill) shell(until_journalled("killed.h5", "KILL"), 137);
  expect_continued("killed.h5");
}

TEST_F(Ensembles, AJournalSaysWhatItHoldsAndIsNoOtherScenes) {
  shell(until_journalled("a.h5", "KILL"), 137);
  const Printed journal = shell("cradle info a.h5.part", 0);
  for (const auto* text : {" replicas finished", "law.restitution = 0.99"}) EXPECT_TRUE(has(journal.out, text));
  const Printed other = shell("cradle ensemble shock.toml --set law.cutoff=1e-4 --replicas 5 -o a.h5", 2);
  EXPECT_TRUE(has(other.err, "a.h5.part: holds ensembles of something else (found law.cutoff = 1e-5, here 1e-4)"));
}

TEST_F(Ensembles, InterruptedLeavesItsReplicasInTheJournal) {
  for (const auto& [signal, status] : {std::pair("INT", 130), std::pair("TERM", 143), std::pair("USR1", 143)}) {
    const Printed stopped = shell(until_journalled("stopped.h5", signal), status);
    EXPECT_TRUE(has(stopped.err, "stopped.h5.part"));
    EXPECT_FALSE(exists("stopped.h5"));
  }
  expect_continued("stopped.h5");
}

TEST_F(Ensembles, DamagedJournalLosesOnlyWhatIsDamaged) {
  run("ensemble shock.toml --replicas 200 -o whole.h5");
  shell(until_journalled("damaged.h5", "KILL"), 137);
  const std::string journal = contents(folder / "damaged.h5.part");
  for (const bool torn : {true, false}) {
    std::string damaged = journal.substr(0, 200000);
    if (!torn) damaged[100000] = static_cast<char>(damaged[100000] ^ 1);
    write("damaged.h5.part", damaged);
    const Printed go_on = shell("cradle ensemble shock.toml --replicas 200 -o damaged.h5", 0);
    EXPECT_TRUE(has(go_on.err, "its end was damaged"));
    expect_same("whole.h5", "damaged.h5");
    std::filesystem::remove(folder / "damaged.h5");
  }
}

TEST_F(Ensembles, JournalLeftBehindAFinishedFileAddsNothing) {
  shell(until_journalled("a.h5", "KILL"), 137);
  const std::string all = " --replicas " + enough_for("a.h5");
  // Killed between writing the file and removing the journal.
  run("ensemble shock.toml -o finished.h5" + all);
  std::filesystem::copy(folder / "a.h5.part", folder / "finished.h5.part");
  const std::string more = " --replicas " + std::to_string(std::stoull(enough_for("a.h5")) + 1);
  run("ensemble shock.toml -o finished.h5" + more);
  run("ensemble shock.toml -o whole.h5" + more);
  expect_same("whole.h5", "finished.h5");
  EXPECT_FALSE(exists("finished.h5.part"));
}

TEST_F(Ensembles, JournalsOfRanksThatAreGoneAreTaken) {
  // As a killed MPI job leaves them: one for each rank.
  shell(until_journalled("a.h5", "KILL"), 137);
  shell(until_journalled("b.h5", "KILL", " --first " + enough_for("a.h5")), 137);
  std::filesystem::rename(folder / "b.h5.part", folder / "a.h5.part.3");
  EXPECT_TRUE(has(expect_continued("a.h5").err, "a.h5.part.3: "));
  EXPECT_FALSE(exists("a.h5.part.3"));
}

TEST_F(Ensembles, JournalWrittenAnewGivesTheSameBytes) {
  const tools::Study study = tools::ensemble_of(scene("shock.toml"));
  run("ensemble shock.toml --replicas 100 -o whole.h5");
  {
    tools::EnsembleStore store(study, path("anew.h5"));
    store.start_journal(0, {0, 64}, 1);  // as soon as it is larger than a byte, and then when it has grown fourfold
    const auto& layout = store.states()[0]->layout();
    const auto record = [&](std::uint64_t k) {
      const tools::RunOutcome end =
          tools::run_scene(tools::replica_scene(study.scene, k), {tools::ProgressLine::Show::never});
      tools::EnsembleRecord one;
      store.states()[0]->put(one, layout.row(k, end), layout.values(end));
      return one;
    };
    for (std::uint64_t k = 0; k < 64; ++k) store.add(record(k));
    EXPECT_LT(std::filesystem::file_size(folder / "anew.h5.part"), 4 * 32 * 8 * layout.entries)
        << "64 nodes of four vectors otherwise";
    std::vector<tools::EnsembleRecord> more;
    for (std::uint64_t k = 64; k < 96; ++k) more.push_back(record(k));
    for_each(ThreadExecutor(4), more.size(), [&](std::size_t k, std::size_t) { store.add(std::move(more[k])); });
  }
  run("ensemble shock.toml --replicas 100 -o anew.h5");
  expect_same("whole.h5", "anew.h5");
}

}  // namespace cradle::tests::same_bytes_test
