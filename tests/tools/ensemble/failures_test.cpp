// Replicas that cannot be trusted are reported: in the status, the messages, the file (of an ensemble, of a point of a
// sweep, in the table of points) and the report; and the printed command for one of them repeats exactly that replica.

#include "cradle/tests/tools/ensemble/ensembles.hpp"

namespace cradle::tests::failures_test {

// Absolute coordinates do not resolve a core that restitution 0 leaves.
constexpr const char* coarse = R"(
law = { type = "inelastic", restitution = 0.5, cutoff = 0.1 }
initial = { type = "rows", particles = 60, speed = 0.5, perturbation = 0.15, seed = 1 }
run = { until = 200, coordinates = "absolute" }
output.series = { points = 3 }
)";

class Failures : public Ensembles {
 protected:
  Failures() { write("coarse.toml", coarse); }

  // The file lists the replicas of a point that lost the order, and the command for the first one repeats it.
  void expect_shown(const std::string& file, const std::string& group, const Printed& made) const {
    const Result result = this->read(file);
    const auto below = [&](const char* name) { return group + name; };
    const auto outcomes = numbers(result, below("replicas"), "outcome");
    std::vector<double> lost;
    for (std::size_t k = 0; k < outcomes.size(); ++k)
      if (outcomes[k] == 2) lost.push_back(numbers(result, below("replicas"), "index")[k]);
    ASSERT_FALSE(lost.empty());
    EXPECT_EQ(attribute<std::uint64_t>(result.find(below("ensemble"))->attributes, "failed", file), lost.size());
    EXPECT_EQ(numbers(result, below("replicas/failed"), "index"), lost);
    const auto first = static_cast<std::size_t>(lost.front());
    const auto& messages = attribute<std::string>(result.find(below("replicas/failed"))->attributes, "messages", file);
    EXPECT_TRUE(begins(messages, "replica " + std::to_string(first) + ": order of collisions lost"));

    const auto commands = matches(made.err, "the first of them again, alone: ([^\n]*)");
    ASSERT_EQ(commands.size(), 1U) << made.err;
    const Printed alone = shell(*commands.begin(), 5);
    EXPECT_TRUE(has(alone.err, "order of collisions lost"));
    const Result replica = read("replica.h5");
    EXPECT_EQ(numbers(replica, "series", "collisions").back(), numbers(result, below("replicas"), "collisions")[first]);
    EXPECT_EQ(numbers(replica, "series", "energy").back(), numbers(result, below("replicas"), "energy")[first]);
  }
};

TEST_F(Failures, OfASweepShowAndCanBeMadeAgain) {
  const std::string sweep_of = "sweep coarse.toml --seed 1 --point law.restitution=0.5 --point law.restitution=0 ";
  const Printed made = shell("cradle " + sweep_of + "--replicas 8 -o s.h5", 5);
  EXPECT_TRUE(has(made.err, "points/0001: replica "));
  expect_shown("s.h5", "points/0001/", made);
  const Result sweep = read("s.h5");
  EXPECT_EQ(sweep.find("points/0000/replicas/failed"), nullptr);
  const auto failed = numbers(sweep, "sweep", "failed");
  EXPECT_EQ(failed[0], 0);
  EXPECT_EQ(failed[1], static_cast<double>(numbers(sweep, "points/0001/replicas/failed", "index").size()));

  // Taken up again, and merged, they are the same.
  run(sweep_of + "--replicas 3 -o a.h5", 5);
  run(sweep_of + "--first 3 --replicas 5 -o b.h5", 5);
  run("merge a.h5 b.h5 -o ab.h5");
  expect_same("s.h5", "ab.h5");
}

TEST_F(Failures, OfAnEnsembleShowAndCanBeMadeAgain) {
  const Printed made = shell("cradle ensemble coarse.toml --set law.restitution=0 --replicas 8 -o 'an ensemble.h5'", 5);
  expect_shown("an ensemble.h5", "", made);
}

TEST_F(Failures, ManyAreCountedAndFoundInTheFile) {
  const Printed made = shell(
      "cradle ensemble coarse.toml --set law.restitution=0 --set initial.perturbation=0.3 --replicas 40 -o e.h5", 5);
  EXPECT_TRUE(has(made.err, " more: see /replicas/failed in e.h5\n"));
}

}  // namespace cradle::tests::failures_test
