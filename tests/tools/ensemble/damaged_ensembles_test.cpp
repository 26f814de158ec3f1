// Ensembles whose parts contradict each other: merging or continuing them would give wrong numbers, so it is refused.

#include <functional>

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/merge.hpp"
#include "cradle/tools/ensemble/state.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tests::damaged_ensembles_test {

class DamagedEnsembles : public Ensembles {
 protected:
  DamagedEnsembles() { run("ensemble shock.toml --replicas 3 --spread energy=0:1000:5 -o a.h5"); }

  // The message of merging the file after a change in it.
  std::string merging(const std::function<void(Result&)>& how) const {
    Result changed = read("a.h5");
    how(changed);
    tools::write_result(changed, path("b.h5"));
    return refusal(Exit::io, [&] { tools::merged({path("b.h5")}); });
  }
  static tools::Group& group(Result& result, const std::string& name) {
    return const_cast<tools::Group&>(*result.find(name));
  }
  template <class T> static std::vector<T>& values(Result& result, const std::string& in, const std::string& name) {
    return const_cast<std::vector<T>&>(std::get<std::vector<T>>(column(result, in, name).values));
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
  const auto refused = [&](const tools::EnsembleRecord& record) {
    return refusal(Exit::io, [&] {
      tools::EnsembleState("", scene, {}).apply(tools::from_bytes<tools::EnsembleRecord>(tools::to_bytes(record)));
    });
  };
  constexpr std::uint64_t beyond = std::uint64_t{1} << 63;
  const tools::EnsembleState state("", scene, {});
  tools::ReplicaRow row;
  const std::vector<double> values(state.layout().entries, 1.);
  EXPECT_NO_THROW(tools::EnsembleState("", scene, {})
                      .apply(tools::from_bytes<tools::EnsembleRecord>(
                          tools::to_bytes(tools::EnsembleRecord{0, tools::ReplicaRecord{row, values}}))));
  row.outcome = tools::RunEnd::undecided;
  EXPECT_TRUE(has(refused({0, tools::ReplicaRecord{row, values}}), "no outcome of a replica"));
  row = {};
  row.index = beyond;
  EXPECT_TRUE(has(refused({0, tools::ReplicaRecord{row, values}}), "a replica beyond the last"));
  EXPECT_TRUE(has(refused({0, tools::FailureRecord{beyond, "lost"}}), "a replica beyond the last"));
  EXPECT_TRUE(has(refused({0, tools::SpreadRecord{0, {1, 2, 3}}}), "3 counts for the spread 0"));
}

TEST_F(DamagedEnsembles, AreRefused) {
  const std::string damaged = path("b.h5") + ": a damaged ensemble (found ", node = "ensemble/nodes/0000";
  EXPECT_EQ(merging([](Result&) {}), "nothing was refused");
  for (const auto* name : {"squares", "least", "greatest"})
    EXPECT_TRUE(begins(merging([&](Result& r) { values<double>(r, node, name).resize(5); }),
                       damaged + "statistics of different lengths)"))
        << name;
  EXPECT_TRUE(has(merging([&](Result& r) { values<double>(r, node, "mean").pop_back(); }), "other quantities"));
  EXPECT_TRUE(begins(merging([&](Result& r) { set(r, node, "replicas", std::uint64_t{1} << 60); }),
                     damaged + "1152921504606846976 replicas in a node of level 1)"));
  EXPECT_TRUE(begins(merging([&](Result& r) { set(r, node, "level", std::uint64_t{1} << 60); }),
                     damaged + "2 replicas in a node of level 64)"));
  EXPECT_TRUE(begins(merging([&](Result& r) {
                       set(r, node, "replicas", std::uint64_t{1} << 60);
                       set(r, node, "level", 62);
                     }),
                     damaged));
  EXPECT_TRUE(has(merging([&](Result& r) { set(r, node, "first", 1); }), damaged + "no node of the tree"));
  EXPECT_TRUE(has(merging([&](Result& r) { set(r, node, "first", 2); }), "are there already"));
  const std::string listed = path("b.h5") + ": replicas: a damaged ensemble (found 3 replicas listed, statistics of ";
  EXPECT_TRUE(begins(merging([&](Result& r) { set(r, node, "first", 4); }), listed)) << "others than those listed";
  EXPECT_TRUE(begins(merging([&](Result& r) { set(r, node, "replicas", 1); }), damaged + "counts that cannot be)"));
  EXPECT_TRUE(begins(merging([&](Result& r) { values<std::uint64_t>(r, "replicas", "outcome")[1] = 4; }), listed))
      << "listed as failed";
  EXPECT_TRUE(begins(merging([&](Result& r) { values<std::uint64_t>(r, "replicas", "index")[1] = 0; }), listed));
  EXPECT_TRUE(has(merging([&](Result& r) { values<std::uint64_t>(r, "replicas", "collisions").pop_back(); }),
                  "columns of /replicas of different lengths"));
  EXPECT_TRUE(has(merging([&](Result& r) { set(r, "ensemble/spread/series/energy", "bins", std::uint64_t{1} << 60); }),
                  "ensemble/spread/series/energy: no bins (found 1152921504606846976)"));
  EXPECT_TRUE(has(merging([&](Result& r) {
                    values<std::uint64_t>(r, "ensemble/spread/series/energy", "counts").resize(7);
                    for (Column& c : group(r, "ensemble/spread/series/energy").columns) c.width = 1;
                  }),
                  "7 counts"));
}

TEST_F(DamagedEnsembles, ScenesAreNotRunBeforeTheyAreKnownToBeTheRightOnes) {
  Result changed = read("a.h5");
  for (auto& [name, value] : changed.attributes)
    if (name == "scene") {
      auto& scene = std::get<std::string>(value);
      scene.replace(scene.find("particles = 300"), 15, "particles = 9000000000000");
    }
  tools::write_result(changed, path("b.h5"));
  const Printed merge = shell("timeout 300 cradle merge b.h5 -o c.h5", 2);
  EXPECT_TRUE(has(merge.err, "b.h5: "));
}

TEST_F(DamagedEnsembles, KindIsText) {
  EXPECT_TRUE(has(merging([](Result& r) {
                    for (auto& [name, value] : r.attributes)
                      if (name == "kind") value = 1.0;
                  }),
                  "no attribute kind"));
}

}  // namespace cradle::tests::damaged_ensembles_test
