// Proofs of replicas. (Bounds in files: references_test.cpp and agreement_test.cpp. Single runs, every law that can be
// proved, threads, and where proofs end: tests/tools/outputs.txt. What is refused: tests/tools/messages.txt.)
#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::certify_program_test {

using namespace cradle::tools;

using Certified = ProgramTest;

// Runs end at their own collapses: each replica counts at the times that it has reached, as in an ensemble.
TEST_F(Certified, ReplicasHaveTheStatisticsOfTheirEnsemble) {
  const std::string scene = "collapse_times --set law.restitution=0.6 --set initial.particles=40 "
                            "--set run.until=30 --set output.series.points=31 --replicas 4";
  const Printed printed = shell("cradle certify " + scene + " -o a.h5", 0);
  EXPECT_TRUE(has(printed.out, "proved: 4 of 4 replicas"));
  EXPECT_FALSE(has(printed.out, "nan"));
  shell("cradle ensemble " + scene + " -o ensemble.h5 --quiet", 0);
  const Result proved = read("a.h5"), ensemble = read("ensemble.h5");
  const char* const energy = "ensemble/series/energy";
  EXPECT_EQ(numbers<std::uint64_t>(proved, energy, "count"), numbers<std::uint64_t>(ensemble, energy, "count"));
  const auto mean = numbers(proved, energy, "mean"), expected = numbers(ensemble, energy, "mean");
  const auto sem = numbers(proved, energy, "sem"), expected_sem = numbers(ensemble, energy, "sem");
  ASSERT_EQ(mean.size(), expected.size());
  std::size_t reached = 0;
  for (std::size_t k = 0; k < mean.size(); ++k) {
    if (std::isnan(expected[k])) {
      EXPECT_TRUE(std::isnan(mean[k]));
      continue;
    }
    ++reached;
    EXPECT_NEAR(mean[k], expected[k], 1e-12);
    if (!std::isnan(expected_sem[k])) {
      EXPECT_NEAR(sem[k], expected_sem[k], 1e-12);
    }
  }
  EXPECT_GT(reached, 5U);
  EXPECT_LT(reached, mean.size());
}

}  // namespace cradle::tests::certify_program_test
