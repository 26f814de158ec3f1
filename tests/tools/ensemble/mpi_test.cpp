// Ensembles across the ranks of an MPI job: the same bytes as one process, for any number of ranks and threads, after a
// rank was killed and the launcher ended the job, and after a signal.
#include "cradle/tests/tools/ensemble/ensembles.hpp"

namespace cradle::tests::mpi_test {

class Mpi : public Ensembles {
 protected:
  void SetUp() override {
#ifndef CRADLE_WITH_MPI
    GTEST_SKIP() << "MPI is not in this build";
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "MPI libraries are not instrumented";
#endif
    if (shell("command -v mpirun").status != 0) GTEST_SKIP() << "no mpirun";
  }

  // The command on the ranks of a job: as any user, on any machine, all ranks on all processors. Open MPI takes what is
  // set here; others do without.
  static std::string job(int ranks, const std::string& command) {
    return fmt::format("OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                       "OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none "
                       "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe mpirun -n {} cradle {}",
                       ranks, command);
  }
  void expect_no_journals() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      EXPECT_FALSE(has(entry.path().string(), ".part")) << entry.path();
  }
  // Starts a job in the background, its launcher's process being $pid, and waits until every rank has journalled some
  // replicas, in journals of this job, not of one before; or until all is over.
  static std::string start(int ranks, const std::string& command, const std::string& file) {
    std::string line = "touch stamp; sleep 0.05; " + job(ranks, command) + " & pid=$!; for f in " + file + ".part";
    for (int rank = 1; rank < ranks; ++rank) line += fmt::format(" {}.part.{}", file, rank);
    return line + "; do until [ -e " + file +
           " ] || { [ $f -nt stamp ] && [ $(stat -c %s $f) -ge 50000 ]; }; do sleep 0.01; done; done; ";
  }
  // An ensemble that is stopped in time by what `then` does: of as many replicas as that takes on this machine, and no
  // fewer than `replicas`. Returns how it ended, and those replicas.
  std::pair<Printed, std::uint64_t> stopped_job(int ranks, const std::string& file, const std::string& then,
                                                std::uint64_t replicas = 6000) const {
    for (;; replicas *= 4) {
      const std::string ensemble = fmt::format("ensemble wet.toml --replicas {} --threads 1 -o {}", replicas, file);
      const Printed stopped = shell(start(ranks, ensemble, file) + then);
      if (!exists(file)) return {stopped, replicas};
      std::filesystem::remove(folder / file);
    }
  }
};

TEST_F(Mpi, AnyNumberOfRanksGivesTheSameBytes) {
  for (const std::string ensemble : {"ensemble wet.toml --replicas 200", "ensemble falling.toml --replicas 30"}) {
    shell("rm -f *.h5", 0);
    run(ensemble + " -o one.h5");
    for (const int ranks : {1, 2, 3})
      for (const int threads : {1, 2}) {
        const std::string file = fmt::format("{}-{}.h5", ranks, threads);
        shell(job(ranks, fmt::format("{} --threads {} -o {}", ensemble, threads, file)), 0);
        expect_same("one.h5", file);
      }
    expect_no_journals();
  }
}

TEST_F(Mpi, FewerReplicasThanRanks) {
  run("ensemble wet.toml --replicas 2 -o one.h5");
  shell(job(3, "ensemble wet.toml --replicas 2 -o three.h5"), 0);
  expect_same("one.h5", "three.h5");
  const Printed nothing = shell(job(3, "ensemble wet.toml --replicas 2 -o three.h5"), 0);
  EXPECT_TRUE(has(nothing.out, "nothing to do"));
  EXPECT_EQ(std::count(nothing.out.begin(), nothing.out.end(), '\n'), 2) << "only rank 0 talks:\n" << nothing.out;
  expect_no_journals();
}

TEST_F(Mpi, KilledJobIsContinuedOnAnyNumberOfRanks) {
  // Never fewer than of the job before: what that one has finished stays.
  std::uint64_t replicas = 6000;
  for (const int rank : {0, 1, 2}) {  // among them rank 0
    const auto [killed, wanted] = stopped_job(
        3, "killed.h5", fmt::format("kill -9 $(ps -o pid= --ppid $pid | sed -n {}p); wait $pid", rank + 1), replicas);
    EXPECT_NE(killed.status, 0);
    replicas = wanted;
  }
  const std::string ensemble = fmt::format("ensemble wet.toml --replicas {} -o ", replicas);
  run(ensemble + "whole.h5");
  const Printed go_on = shell(job(2, ensemble + "killed.h5"), 0);
  EXPECT_TRUE(has(go_on.err, "killed.h5.part.2: "));
  expect_same("whole.h5", "killed.h5");
  expect_no_journals();
}

TEST_F(Mpi, SignalToOneRankStopsAllAndLosesNothing) {
  const auto [stopped, replicas] =
      stopped_job(2, "stopped.h5", "kill -TERM $(ps -o pid= --ppid $pid | sed -n 2p); wait $pid");
  EXPECT_EQ(stopped.status, 143) << stopped.err;
  EXPECT_TRUE(has(stopped.err, "stopped.h5.part"));
  const std::string ensemble = fmt::format("ensemble wet.toml --replicas {} -o ", replicas);
  run(ensemble + "whole.h5");
  run(ensemble + "stopped.h5");  // without ranks
  expect_same("whole.h5", "stopped.h5");
  expect_no_journals();
}

// A line of progress comes after ten seconds. Replicas are so slow that no thread takes several at once: all that were
// taken by then are in the journals, but the two that were running.
TEST_F(Mpi, SlowProgressCountsEveryReplicaOnce) {
  const std::string ensemble =
      "ensemble fig6 --set initial.particles=100 --set run.until=600 --set output.snapshots=[] "
      "--set output.profiles.times=[] --set output.masses=[] --replicas 1000000 --threads 1 --progress -o long.h5";
  const Printed stopped =
      shell(job(2, ensemble) + " 2> lines & pid=$!; until grep -q replicas lines || ! kill -0 $pid; do sleep 0.1; "
                               "done; kill -TERM $(ps -o pid= --ppid $pid | sed -n 2p); wait $pid");
  EXPECT_EQ(stopped.status, 143) << stopped.err;
  const auto number_in = [](const std::string& text, const std::string& behind) {
    std::smatch found;
    return std::regex_search(text, found, std::regex("([0-9]+) " + behind)) ? std::stoull(found[1]) : 0;
  };
  const auto shown = number_in(contents(folder / "lines"), "of 1000000 replicas");
  EXPECT_GT(shown, 0U) << contents(folder / "lines");
  EXPECT_LE(shown, number_in(shell("cradle info long.h5.part", 0).out, "replicas finished") +
                       number_in(shell("cradle info long.h5.part.1", 0).out, "replicas finished") + 2);
}

TEST_F(Mpi, FailedReplicasAreListedWhicheverRankRanThem) {
  for (const int ranks : {1, 2, 3}) {
    const Printed failed =
        shell(job(ranks, fmt::format("ensemble failing.toml --replicas 60 -o failed-{}.h5", ranks)), 5);
    EXPECT_TRUE(has(failed.out, "52 reached the end, 8 failed"));
  }
  expect_same("failed-1.h5", "failed-2.h5");
  expect_same("failed-1.h5", "failed-3.h5");
  expect_no_journals();
  const Printed again = shell(job(2, "ensemble failing.toml --replicas 60 -o failed-2.h5"), 5);
  EXPECT_TRUE(has(again.err, "replica 9 failed: "));
}

TEST_F(Mpi, WhatIsWrongIsReportedOnce) {
  const Printed scene_error = shell(job(3, "ensemble wet.toml --replicas 5 --set law.loss=-1"), 2);
  const auto first = scene_error.err.find("cradle: ");
  ASSERT_NE(first, std::string::npos) << scene_error.err;
  EXPECT_EQ(scene_error.err.find("cradle: ", first + 1), std::string::npos) << scene_error.err;

  run("ensemble wet.toml --replicas 2 -o other.h5");
  shell(job(2, "ensemble wet.toml --replicas 5 --seed 9 -o other.h5"), 2);
}

TEST_F(Mpi, RankThatCannotReadOrWriteItsJournalEndsTheJob) {
  shell("mkdir -p bad.h5.part.1/in.the.way; ln -s nowhere/journal other.h5.part", 0);
  for (const std::string file : {"bad.h5", "other.h5"}) {
    const Printed bad = shell("timeout 60 env " + job(2, "ensemble wet.toml --replicas 3000 -o " + file), 4);
    EXPECT_TRUE(has(bad.err, "cradle: " + file)) << bad.err;
  }
}

}  // namespace cradle::tests::mpi_test
