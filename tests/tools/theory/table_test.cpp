// Predictions of `cradle theory` for the wet and the sticky gas: curves that meet in their known points, and how far
// they apply. (Numbers of the validation table, and misprints: tests/tools/outputs.txt.)
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/theory/laws.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace cradle::tools::table_test {

std::vector<Prediction> table_of(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  return predictions(read_scene(scene, overrides));
}

// Of Fig. 6 without the times at which its own run, which is longer, writes tables.
std::vector<Prediction> table_of_fig6(std::vector<std::string> overrides) {
  for (const char* key : {"output.snapshots=", "output.profiles.times=", "output.masses="}) overrides.push_back(key);
  return table_of("fig6", overrides);
}

std::optional<double> number(const std::vector<Prediction>& table, const std::string& quantity,
                             const std::string& form) {
  for (const auto& p : table)
    if (p.quantity == quantity && p.form == form && !p.t) return p.value;
  return std::nullopt;
}

std::vector<Prediction> curve(const std::vector<Prediction>& table, const std::string& quantity,
                              const std::string& form) {
  std::vector<Prediction> points;
  for (const auto& p : table)
    if (p.quantity == quantity && p.form == form && p.t) points.push_back(p);
  return points;
}

TEST(WetPredictions, EnergyIsThatOfTheRun) {
  // NB: energies at t = 2000 and 4999, E(0) = 6250; sampled where the curve has its points
  const auto table = table_of_fig6({"run.until=4999", "output.series.points=2"});
  for (const auto* form : {"continuous", "discrete"}) {
    const auto energy = curve(table, "energy", form);
    ASSERT_FALSE(energy.empty()) << form;
    EXPECT_EQ(energy.front().value, 6250) << form;
    EXPECT_EQ(*energy.back().t, 4999) << form;
    EXPECT_NEAR(energy.back().value, 5481.7771, 4e-4 * 768.2229) << form;
  }
  const auto discrete = curve(table, "energy", "discrete");
  EXPECT_NEAR(discrete.back().value, 5481.7771, 4e-4) << "a few collisions";
  const auto sticky = curve(table, "energy_sticky", "continuous");
  EXPECT_NEAR(sticky.back().value, 6250 - 0.125 * 4999, 1e-9);
}

TEST(WetPredictions, CurvesOfTheFrontMeetItsTurnover) {
  const auto table = table_of("fig6");
  for (const auto* form : {"continuous", "discrete"}) {
    const auto place = curve(table, "front_position", form);
    const auto speed = curve(table, "front_velocity", form);
    ASSERT_EQ(place.size(), speed.size());
    EXPECT_EQ(place.front().value, -0.5);
    EXPECT_EQ(speed.front().value, 0.5);
    double highest = 0;
    for (const auto& p : place) highest = std::max(highest, p.value);
    EXPECT_LE(highest, *number(table, "maximal_front", form) - 0.5);
    EXPECT_GT(highest, *number(table, "maximal_front", form) * 0.999);
  }
}

TEST(WetPredictions, GoAsFarAsTheyApply) {
  // particles that stick at once (E > m u0^2), before they are slowed to rest (> m u0^2/4), or never (0)
  const auto with_loss = [&](const std::string& loss) { return table_of_fig6({"run.until=50", "law.loss=" + loss}); };
  const auto stuck = with_loss("0.3");
  EXPECT_FALSE(number(stuck, "zone_width", "continuous"));
  EXPECT_FALSE(number(stuck, "turnover_time", "continuous"));
  EXPECT_TRUE(curve(stuck, "front_position", "continuous").empty());
  EXPECT_EQ(*number(stuck, "first_sticking_time", "discrete"), 1);
  EXPECT_FALSE(number(with_loss("0.1"), "turnover_time", "discrete"));
  const auto free = with_loss("0");
  EXPECT_EQ(curve(free, "energy", "continuous").back().value, 6250);
  EXPECT_EQ(curve(free, "front_position", "discrete").back().value, 24.5);
  EXPECT_FALSE(number(free, "zone_width", "continuous"));
  // forms that go collision by collision are left out where that would take long
  const auto tiny = table_of_fig6({"law.loss=1e-12", "run.until=1e12", "initial.particles=1e12"});
  EXPECT_TRUE(number(tiny, "turnover_time", "continuous"));
  EXPECT_FALSE(number(tiny, "turnover_time", "discrete"));
  EXPECT_TRUE(curve(tiny, "energy", "discrete").empty());
  // the front has passed through a row of 20, one collision after the other
  for (const auto& few : {table_of("fig2", {"initial.particles=40", "run.until=300"}),
                          table_of_fig6({"initial.particles=40", "run.until=300"})}) {
    EXPECT_FALSE(number(few, "turnover_time", "continuous"));
    EXPECT_FALSE(number(few, "collapse_onset_time", "continuous"));
    for (const char* form : {"continuous", "discrete"}) {
      const auto place = curve(few, "front_position", form);
      EXPECT_GT(*place.back().t, 19);
      EXPECT_LT(*place.back().t, 21.5);
    }
    for (const auto& p : curve(few, "energy", "continuous")) EXPECT_GT(p.value, 4);
  }
  // lattices alone go by a recursion
  EXPECT_TRUE(curve(table_of_fig6({"initial.positions=poisson", "initial.perturbation=", "run.until=50"}),
                    "front_position", "discrete")
                  .empty());
  // times are those of the scene
  const auto now = table_of_fig6({"run.until=50"}), later = table_of_fig6({"run.start=100", "run.until=150"});
  ASSERT_EQ(now.size(), later.size());
  for (std::size_t k = 0; k < now.size(); ++k) {
    EXPECT_NEAR(now[k].t.value_or(0) + 100, later[k].t.value_or(100), 1e-12);
    const double apart = now[k].quantity == "turnover_time" || now[k].quantity == "first_sticking_time" ? 100 : 0;
    EXPECT_NEAR(now[k].value + apart, later[k].value, 1e-11) << now[k].quantity;
  }
  // a run of no length
  for (const auto& p : table_of_fig6({"run.until=0"})) EXPECT_TRUE(std::isfinite(p.value)) << p.quantity;
}

TEST(StickyPredictions, EqualRowsFeedOneClusterAtTheCentre) {
  // l = 1, u0 = 1/2: mass 2 u0 t/l = t, energy E(0) - u0^3 t/l, up to t = N l/(2 u0) = 8000, where all is one
  const auto rows = predictions(parse_scene("law.type = 'sticky'\ninitial.type = 'rows'\nrun.until = 16000", "s.toml"));
  EXPECT_EQ(*number(rows, "initial_energy", "continuous"), 1000);
  EXPECT_EQ(*number(rows, "central_mass_growth", "continuous"), 1);
  EXPECT_EQ(*number(rows, "central_velocity", "continuous"), 0);
  EXPECT_EQ(*number(rows, "energy_loss_rate", "continuous"), 0.125);
  const auto mass = curve(rows, "central_mass", "continuous"), energy = curve(rows, "energy_sticky", "continuous");
  ASSERT_EQ(mass.size(), energy.size());
  EXPECT_EQ(*mass.back().t, 8000);
  for (std::size_t k = 0; k < mass.size(); ++k) {
    EXPECT_NEAR(mass[k].value, *mass[k].t, 1e-12 * *mass[k].t);
    EXPECT_NEAR(energy[k].value, 1000 - 0.125 * *energy[k].t, 1e-9);
  }
}

TEST(StickyPredictions, UnequalRowsMoveIt) {
  // densities 4 and 1 at 1 and -1/2: mass sqrt(4) 3/2 per time, velocity (2 1 - 1 1/2)/3 (validation table, section 3)
  const std::string scene = "law.type = 'sticky'\nrun.until = 10\ninitial.type = 'rows'\n"
                            "initial.left = { particles = 100, speed = 1, density = 4 }\n"
                            "initial.right = { particles = 100, speed = -0.5, density = 1 }\n";
  const auto rows = predictions(parse_scene(scene, "s.toml"));
  EXPECT_NEAR(*number(rows, "central_mass_growth", "continuous"), 3, 1e-15);
  EXPECT_NEAR(*number(rows, "central_velocity", "continuous"), 0.5, 1e-15);
  EXPECT_EQ(*number(rows, "initial_energy", "continuous"), 50 + 12.5);
  EXPECT_NEAR(curve(rows, "central_position", "continuous").back().value, 5, 1e-14);
  EXPECT_EQ(*curve(rows, "central_mass", "continuous").back().t, 10);
}

TEST(StickyPredictions, SayNothingOfOtherStarts) {
  EXPECT_TRUE(predictions(parse_scene("law.type = 'sticky'\ninitial.type = 'ring'\nrun.until = 1", "s.toml")).empty());
}

}  // namespace cradle::tools::table_test
