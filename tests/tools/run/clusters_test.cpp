// Scenes of two clusters, equation (16), as a user runs them: the layout of a result, both scenarios of Fig. 9, Fig. 10
// with the exponents of (17), and the wet rule where they meet. (The force, the same bytes:
// tests/tools/run/outputs.txt.)
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::clusters_test {

class RunClusters : public ProgramTest {
 protected:
  tools::Result result_of(const std::string& command) const {
    shell("cradle run " + command + " --quiet --force -o out.h5", 0);
    return read("out.h5");
  }
};

// The paths of the first and of the second cluster, from the columns left and right.
std::array<std::vector<double>, 2> by_cluster(const tools::Result& result, const std::string& name) {
  const auto& values = numbers(result, "series/heaviest", name);
  const auto& index = numbers<std::uint64_t>(result, "series/heaviest", "index");
  std::array<std::vector<double>, 2> paths;
  for (std::size_t k = 0; k < values.size(); ++k) paths.at(index[k]).push_back(values[k]);
  return paths;
}

std::vector<double> extremes(const std::vector<double>& x) {
  std::vector<double> found;
  for (std::size_t k = 1; k + 1 < x.size(); ++k)
    if ((x[k] - x[k - 1]) * (x[k + 1] - x[k]) < 0) found.push_back(x[k]);
  return found;
}

TEST_F(RunClusters, ResultHasTheLayoutOfARun) {
  const auto result = result_of("fig10");
  const auto& time = numbers(result, "series", "time");
  ASSERT_EQ(time.size(), 10001U);
  for (const auto* name : {"mass", "x", "v", "index"}) {
    EXPECT_EQ(column(result, "series/heaviest", name).width, 2U) << name;
    EXPECT_EQ(column(result, "series/heaviest", name).rows(), time.size()) << name;
  }
  const auto& x = numbers(result, "series/heaviest", "x");
  for (std::size_t k = 0; k < time.size(); ++k) ASSERT_LE(x[2 * k], x[2 * k + 1]) << "left and right";
  // the caption: M1 = 1 + 0.45 t, M2 = 1 + 0.55 t
  const auto masses = by_cluster(result, "mass");
  for (std::size_t k = 0; k < time.size(); ++k) {
    ASSERT_NEAR(masses[0][k], 1 + 0.45 * time[k], 1e-15 * masses[0][k]);
    ASSERT_NEAR(masses[1][k], 1 + 0.55 * time[k], 1e-15 * masses[1][k]);
  }
  EXPECT_EQ(tools::attribute<std::string>(result.attributes, "precision", ""), "double");
  EXPECT_EQ(tools::attribute<std::string>(result.attributes, "outcome", ""), "reached the end");
  EXPECT_LE(tools::attribute<double>(result.attributes, "relative_tolerance", ""), 1e-10);
}

TEST_F(RunClusters, Fig10OscillatesOnBothSidesThenAroundTheCentreAtOneFrequency) {
  const auto result = result_of("fig10");
  const auto x = by_cluster(result, "x");
  const auto& met = numbers(result, "meetings", "time");
  const auto& place = numbers(result, "meetings", "x");
  const double edge = tools::attribute<double>(result.find("force")->attributes, "half_width", "");
  ASSERT_GE(met.size(), 10U);
  EXPECT_LT(std::abs(place[0]), edge) << "they meet near the centre";
  const auto first = static_cast<std::size_t>(met[0]);  // one sample per unit of time
  std::array<std::vector<double>, 2> early, late;
  for (std::size_t i = 0; i < 2; ++i) {
    early[i] = extremes({x[i].begin(), x[i].begin() + static_cast<std::ptrdiff_t>(first)});
    late[i] = extremes({x[i].begin() + static_cast<std::ptrdiff_t>(first), x[i].end()});
    EXPECT_GE(early[i].size(), 4U) << "two oscillations or more on its own side";
    for (const double e : early[i]) EXPECT_LT(e * x[1 - i][0], 0) << "which it does not leave";
    const auto swing = [&](std::size_t k) { return std::abs(early[i][k] - early[i][k - 1]); };
    for (std::size_t k = 2; k < early[i].size(); ++k) EXPECT_GT(swing(k), swing(k - 1)) << "they grow";
    ASSERT_GE(late[i].size(), 10U);
    // then from side to side, ever farther
    for (std::size_t k = 1; k < late[i].size(); ++k) EXPECT_LT(late[i][k] * late[i][k - 1], 0);
    for (std::size_t k = 2; k < late[i].size(); ++k) EXPECT_GT(std::abs(late[i][k]), std::abs(late[i][k - 2]));
  }
  // In between of one meeting and the next both go out and come back: one frequency.
  EXPECT_LE(std::max(late[0].size(), late[1].size()) - std::min(late[0].size(), late[1].size()), 1U);
  // Equal periods sqrt(2 M x/F) mean amplitudes as 0.55 to 0.45, up to the share that the zone has of them.
  const double ratio = std::abs(late[0].back() / late[1].back());
  EXPECT_NEAR(ratio, 0.55 / 0.45, ratio * edge / std::abs(late[1].back()));
}

TEST_F(RunClusters, LateOscillationsHaveTheExponentsOf17) {
  const auto result = result_of("fig9 --set run.until=1e9 --set output.series.points=10");
  const auto& time = numbers(result, "meetings", "time");
  const auto& speed = numbers(result, "meetings", "closing_speed");
  const auto& energy = numbers(result, "meetings", "relative_energy");
  const auto from = static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), 1e6) - time.begin());
  const std::size_t last = time.size() - 1;
  ASSERT_GT(last, from + 100);
  // Where they meet, half a period is over: u ~ t^{-1/3}, E ~ t^{1/3}, intervals ~ t^{2/3}, up to the part of t that a
  // period is (the invariant is only adiabatic) and the part of the energy that (17) leaves out, the work in the zone.
  const auto& x = numbers(result, "force", "x");
  const auto& force = numbers(result, "force", "force");
  double work = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (x[k] > 0 && force[k] > 0) work += force[k] * (x[1] - x[0]);
  const auto interval = [&](std::size_t k) { return time[k] - time[k - 1]; };
  const double span = std::log(time[last] / time[from]);
  const double error = (2 * interval(from) / time[from] + 2 * work / energy[from]) / span;
  EXPECT_LT(error, 0.03) << "better than what simulations resolve";
  const theory::OscillationExponents exponents;
  EXPECT_NEAR(std::log(speed[last] / speed[from]) / span, exponents.speed, error);
  EXPECT_NEAR(std::log(energy[last] / energy[from]) / span, exponents.energy, error);
  EXPECT_NEAR(std::log(interval(last) / interval(from)) / span, -exponents.frequency, error);
  EXPECT_EQ(exponents.amplitude, exponents.energy) << "the force outside is constant";
}

TEST_F(RunClusters, Fig9HasBothScenarios) {
  const auto passing = result_of("fig9");
  const auto& places = numbers(passing, "meetings", "x");
  EXPECT_GE(places.size(), 6U);
  for (const double x : places) EXPECT_EQ(x, 0) << "mirror images meet at the centre";
  const auto paths = by_cluster(passing, "x");
  EXPECT_GT(*std::max_element(paths[0].begin(), paths[0].end()), 1) << "the left one comes to the right";

  const auto sticking = result_of("fig9b");
  ASSERT_EQ(numbers<std::uint64_t>(sticking, "meetings", "stuck"), std::vector<std::uint64_t>{1});
  EXPECT_EQ(numbers(sticking, "meetings", "time")[0], numbers(passing, "meetings", "time")[0]);
  EXPECT_LT(numbers(sticking, "meetings", "relative_energy")[0], 0.05) << "the wet rule, not a choice";
  const auto& mass = numbers(sticking, "series/heaviest", "mass");
  const auto& x = numbers(sticking, "series/heaviest", "x");
  EXPECT_NEAR(mass[mass.size() - 2], 2 + 5000, 1e-11) << "everything that has come in";
  EXPECT_TRUE(std::isnan(mass.back())) << "there is no second one any more";
  EXPECT_EQ(x[x.size() - 2], 0);
  EXPECT_EQ(numbers<std::uint64_t>(sticking, "series", "merges").back(), 1U);
  EXPECT_EQ(numbers(sticking, "series", "energy").back(), 0);
  // what both had is what was lost
  EXPECT_EQ(numbers(sticking, "series", "energy_lost").back(), numbers(sticking, "meetings", "relative_energy")[0]);
}

TEST_F(RunClusters, WetRuleTakesItsLossFromFastClusters) {
  // From far outside they come in with some 0.06 each per unit of length: more than E_loss = 0.05.
  const auto result = result_of(
      "fig9b --set initial.x=[-30,30] --set run.start=1000 --set run.until=20000 --set output.series.points=2000");
  const auto& energy = numbers(result, "meetings", "relative_energy");
  const auto& stuck = numbers<std::uint64_t>(result, "meetings", "stuck");
  ASSERT_GE(energy.size(), 2U);
  std::uint64_t passed = 0;
  for (std::size_t k = 0; k < energy.size(); ++k) {
    EXPECT_EQ(stuck[k] == 1, energy[k] <= 0.05);
    passed += 1 - stuck[k];
  }
  EXPECT_EQ(stuck[0], 0U);
  EXPECT_NEAR(numbers(result, "series", "energy_lost").back() - (stuck.back() == 1 ? energy.back() : 0),
              0.05 * static_cast<double>(passed), 1e-14);
}

}  // namespace cradle::tests::clusters_test
