// How often a run is sampled changes only the series: every other number in a result file, attributes included, has the
// same bits. This includes lattices, with very many simultaneous collisions, for which the order of events is hardest
// to keep.
#include <algorithm>
#include <type_traits>

#include <gtest/gtest.h>

#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::cadence_test {

std::string bits(const Numbers& values, std::size_t first = 0, std::size_t most = static_cast<std::size_t>(-1)) {
  return std::visit(
      [&](const auto& v) {
        const std::size_t from = std::min(first, v.size()), count = std::min(most, v.size() - from);
        return std::string(reinterpret_cast<const char*>(v.data() + from), count * sizeof(v[0]));
      },
      values);
}

std::string bits(const std::vector<Attribute>& attributes) {
  std::string text;
  for (const auto& [name, value] : attributes) {
    if (name == "scene") continue;  // says how often
    text += name + " = ";
    std::visit(
        [&](const auto& v) {
          if constexpr (std::is_same_v<std::remove_cvref_t<decltype(v)>, std::string>)
            text += v;
          else
            text += bits(Numbers(std::vector{v}));
        },
        value);
    text += '\n';
  }
  return text;
}

struct Lattice {
  const char* name;
  const char* law;
  const char* initial;
  const char* run;
  const char* until = "100";
};

constexpr const char* rows = "initial = { type = 'rows', particles = 400 }\n";
const Lattice lattices[] = {
    {"Elastic", "law = { type = 'inelastic', restitution = 1 }\n", rows, ""},
    {"NearlyElastic", "law = { type = 'inelastic', restitution = 0.999 }\n", rows, "collapse = 'cutoff'"},
    {"Dry", "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n", rows, ""},
    {"Positions", "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n", rows, "coordinates = 'absolute'"},
    {"Wet", "law = { type = 'wet', loss = 0.01 }\n", rows, ""},
    {"Sticky", "law.type = 'sticky'\n", rows, ""},
    {"StickyCollisionByCollision", "law.type = 'sticky'\noutput.events = true\n", rows, ""},
    {"DoubleDouble", "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n", rows,
     "precision = 'double-double'"},
    {"Shock", "law = { type = 'inelastic', restitution = 0.999, cutoff = 1e-5 }\n",
     "initial = { type = 'rows', particles = 600, perturbation = 0.05 }\n", "", "400"},
    {"Ring", "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n",
     "initial = { type = 'ring', particles = 200 }\n", ""},
};

class Cadence : public testing::TestWithParam<Lattice> {
 protected:
  static RunOutcome run(const char* points) {
    const Lattice& lattice = GetParam();
    const std::string text = std::string(lattice.law) + lattice.initial +
                             "output.snapshots = [50, 100]\noutput.profiles.times = [60]\n[run]\n" + lattice.run +
                             "\nuntil = " + lattice.until;
    const Scene scene = parse_scene(text, "lattice.toml", {std::string("output.series.points=") + points});
    return run_scene(scene, {Progress::Show::never});
  }
};

TEST_P(Cadence, ChangesNothingButTheSeries) {
  const RunOutcome seldom = run("2"), often = run("3001");
  EXPECT_EQ(bits(seldom.result.attributes), bits(often.result.attributes));
  EXPECT_EQ(seldom.warning, often.warning);
  ASSERT_EQ(seldom.result.groups.size(), often.result.groups.size());
  for (std::size_t g = 0; g < seldom.result.groups.size(); ++g) {
    const Group &a = seldom.result.groups[g], &b = often.result.groups[g];
    ASSERT_EQ(a.name, b.name);
    EXPECT_EQ(bits(a.attributes), bits(b.attributes)) << a.name;
    for (std::size_t c = 0; c < a.columns.size(); ++c) {
      const Column &of_a = a.columns[c], &of_b = b.columns[c];
      ASSERT_EQ(of_a.name, of_b.name);
      if (!a.name.starts_with("series")) {
        EXPECT_EQ(bits(of_a.values), bits(of_b.values)) << a.name << "/" << of_a.name;
        continue;
      }
      // The first and the last sample are the same.
      EXPECT_EQ(bits(of_a.values, 0, of_a.width), bits(of_b.values, 0, of_b.width)) << a.name << "/" << of_a.name;
      EXPECT_EQ(bits(of_a.values, (of_a.rows() - 1) * of_a.width), bits(of_b.values, (of_b.rows() - 1) * of_b.width))
          << a.name << "/" << of_a.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lattices, Cadence, testing::ValuesIn(lattices),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace cradle::tools::cadence_test
