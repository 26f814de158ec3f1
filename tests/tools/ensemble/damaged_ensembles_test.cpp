// Ensembles whose parts contradict each other: merging or continuing them would give wrong numbers, so it is refused.

#include <functional>
#include <stdexcept>

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/merge.hpp"
#include "cradle/tools/ensemble/state.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tests {
namespace damaged_ensembles_test {

class DamagedEnsembles : public Ensembles {
 protected:
  DamagedEnsembles() { run("ensemble shock.toml --replicas 3 --spread energy=0:1000:5 -o a.h5"); }

  // What merging says of the file after a change in it.
  std::string merging(const std::function<void(Result&)>& how) const {
    Result changed = result("a.h5");
    how(changed);
    tools::write_result(changed, path("b.h5"));
    try {
      tools::merged({path("b.h5")});
    } catch (const tools::Error& error) {
      EXPECT_EQ(error.status, Exit::io) << error.what();
      return error.what();
    }
    return "merged";
  }
  static tools::Group& group(Result& result, const std::string& name) {
    return const_cast<tools::Group&>(*result.find(name));
  }
  template <class T> static std::vector<T>& values(Result& result, const std::string& in, const std::string& name) {
    for (Column& column : group(result, in).columns)
      if (column.name == name) return std::get<std::vector<T>>(column.values);
    throw std::out_of_range(in + "/" + name);
  }
  static void set(Result& result, const std::string& in, const std::string& name, std::uint64_t value) {
    for (auto& [key, old] : group(result, in).attributes)
      if (key == name) old = value;
  }
};

// Found by fuzzing behind the checksums of journals: each of these was an exception that names no file.
TEST(DamagedRecords, AreRefused) {
  const tools::Scene scene = tools::parse_scene(
      "law.type = 'sticky'\ninitial = { type = 'rows', particles = 8 }\nrun.until = 9\noutput.series.points = 3\n",
      "records.toml");
  const auto refused = [&](const tools::EnsembleRecord& record) -> std::string {
    tools::EnsembleState state("", scene, {});
    try {
      state.apply(tools::from_bytes<tools::EnsembleRecord>(tools::to_bytes(record)));
    } catch (const tools::Error& error) {
      EXPECT_EQ(error.status, Exit::io) << error.what();
      return error.what();
    }
    return "applied";
  };
  constexpr std::uint64_t beyond = std::uint64_t{1} << 63;
  const tools::EnsembleState state("", scene, {});
  tools::ReplicaRow row;
  const std::vector<double> values(state.layout().entries, 1.);
  EXPECT_EQ(refused({0, tools::ReplicaRecord{row, values}}), "applied");
  row.outcome = tools::RunEnd::undecided;
  EXPECT_NE(refused({0, tools::ReplicaRecord{row, values}}).find("no outcome of a replica"), std::string::npos);
  row = {};
  row.index = beyond;
  EXPECT_NE(refused({0, tools::ReplicaRecord{row, values}}).find("a replica beyond the last"), std::string::npos);
  EXPECT_NE(refused({0, tools::FailureRecord{beyond, "lost"}}).find("a replica beyond the last"), std::string::npos);
  EXPECT_NE(refused({0, tools::SpreadRecord{0, {1, 2, 3}}}).find("3 counts for the spread 0"), std::string::npos);
}

TEST_F(DamagedEnsembles, AreRefused) {
  const std::string damaged = path("b.h5") + ": a damaged ensemble (found ", node = "ensemble/nodes/0000";
  EXPECT_EQ(merging([](Result&) {}), "merged");
  for (const auto* name : {"squares", "least", "greatest"})
    EXPECT_EQ(merging([&](Result& r) {
                values<double>(r, node, name).resize(5);
              }).rfind(damaged + "statistics of different lengths)", 0),
              0U)
        << name;
  EXPECT_NE(merging([&](Result& r) { values<double>(r, node, "mean").pop_back(); }).find("other quantities"),
            std::string::npos);
  EXPECT_EQ(merging([&](Result& r) {
              set(r, node, "replicas", std::uint64_t{1} << 60);
            }).rfind(damaged + "1152921504606846976 replicas in a node of level 1)", 0),
            0U);
  EXPECT_EQ(merging([&](Result& r) {
              set(r, node, "level", std::uint64_t{1} << 60);
            }).rfind(damaged + "2 replicas in a node of level 64)", 0),
            0U);
  EXPECT_EQ(merging([&](Result& r) {
              set(r, node, "replicas", std::uint64_t{1} << 60);
              set(r, node, "level", 62);
            }).rfind(damaged, 0),
            0U);
  EXPECT_NE(merging([&](Result& r) { set(r, node, "first", 1); }).find(damaged + "no node of the tree"),
            std::string::npos);
  EXPECT_NE(merging([&](Result& r) { set(r, node, "first", 2); }).find("are there already"), std::string::npos);
  const std::string listed = path("b.h5") + ": replicas: a damaged ensemble (found 3 replicas listed, statistics of ";
  EXPECT_EQ(merging([&](Result& r) { set(r, node, "first", 4); }).rfind(listed, 0), 0U) << "others than those listed";
  EXPECT_EQ(merging([&](Result& r) { set(r, node, "replicas", 1); }).rfind(damaged + "counts that cannot be)", 0), 0U);
  EXPECT_EQ(merging([&](Result& r) { values<std::uint64_t>(r, "replicas", "outcome")[1] = 4; }).rfind(listed, 0), 0U)
      << "listed as failed";
  EXPECT_EQ(merging([&](Result& r) { values<std::uint64_t>(r, "replicas", "index")[1] = 0; }).rfind(listed, 0), 0U);
  EXPECT_NE(merging([&](Result& r) {
              values<std::uint64_t>(r, "replicas", "collisions").pop_back();
            }).find("columns of /replicas of different lengths"),
            std::string::npos);
  EXPECT_NE(merging([&](Result& r) {
              set(r, "ensemble/spread/series/energy", "bins", std::uint64_t{1} << 60);
            }).find("ensemble/spread/series/energy: no bins (found 1152921504606846976)"),
            std::string::npos);
  EXPECT_NE(merging([&](Result& r) {
              values<std::uint64_t>(r, "ensemble/spread/series/energy", "counts").resize(7);
              for (Column& c : group(r, "ensemble/spread/series/energy").columns) c.width = 1;
            }).find("7 counts"),
            std::string::npos);
}

TEST_F(DamagedEnsembles, ScenesAreNotRunBeforeTheyAreKnownToBeTheRightOnes) {
  Result changed = result("a.h5");
  for (auto& [name, value] : changed.attributes)
    if (name == "scene") {
      auto& scene = std::get<std::string>(value);
      scene.replace(scene.find("particles = 300"), 15, "particles = 9000000000000");
    }
  tools::write_result(changed, path("b.h5"));
  const Printed merge = shell("timeout 300 cradle merge b.h5 -o c.h5");
  EXPECT_EQ(merge.status, 2);
  EXPECT_NE(merge.err.find("b.h5: "), std::string::npos) << merge.err;
}

TEST_F(DamagedEnsembles, KindIsText) {
  EXPECT_NE(merging([](Result& r) {
              for (auto& [name, value] : r.attributes)
                if (name == "kind") value = 1.0;
            }).find("no attribute kind"),
            std::string::npos);
}

}  // namespace damaged_ensembles_test
}  // namespace cradle::tests
