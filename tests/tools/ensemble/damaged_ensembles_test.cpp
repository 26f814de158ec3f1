// Ensembles whose parts contradict each other: merging or continuing them would give wrong numbers, so it is refused.
// And random damage to result files: after any change the code behind info, export, plot and merge reads the file
// correctly or refuses it with a message and a documented status; it never crashes and never takes long.
// CRADLE_MUTATIONS=2000 makes 2000 changes instead of 100.
#include <ctime>

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tests/tools/faults.hpp"
#include "cradle/tests/tools/result/result_files.hpp"
#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/state.hpp"

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

TEST_F(DamagedEnsembles, ASweepHasThePointsOfItsScene) {
  run("sweep shock.toml --vary law.restitution=0.9,0.99 --replicas 1 -o a.h5 --force");
  const std::string found = merging([](Result& sweep) {
    for (auto& [name, value] : sweep.attributes)
      if (name == "scene") {
        auto& scene = std::get<std::string>(value);
        scene.replace(scene.find("0.9,0.99"), 8, "0.9,0.99,1");
      }
  });
  EXPECT_TRUE(has(found, "a sweep with other points than its scene (found 2 points)")) << found;
}

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
  const auto replica = [&](std::uint64_t index, tools::RunEnd outcome = tools::RunEnd::reached) {
    tools::EnsembleRecord record;
    state.put(record, {.index = index, .outcome = outcome, .numbers = {}},
              std::vector<double>(state.layout().entries, 1.));
    return record;
  };
  EXPECT_EQ(refused(replica(0)), "nothing was refused");
  EXPECT_TRUE(has(refused(replica(0, tools::RunEnd::undecided)), "no outcome of a replica"));
  EXPECT_TRUE(has(refused(replica(beyond)), "a replica beyond the last"));
  tools::EnsembleRecord failed;
  state.put_failure(failed, beyond, "lost");
  EXPECT_TRUE(has(refused(failed), "a replica beyond the last"));
  EXPECT_TRUE(has(refused({.spreads = {{1, 2, 3}}}), "3 counts for the spread 0"));
  tools::EnsembleRecord of_others = replica(0);
  of_others.rows = tools::ReplicaTable(7);
  of_others.rows.add({});
  EXPECT_TRUE(has(refused(of_others), "7 numbers a row"));
  tools::EnsembleRecord spread = replica(0);
  spread.to_spread = {1};
  EXPECT_TRUE(has(refused(spread), "1 numbers for spreads"));
}

TEST_F(DamagedEnsembles, AreRefused) {
  EXPECT_EQ(merging([](Result&) {}), "nothing was refused");
  constexpr std::uint64_t many = std::uint64_t{1} << 60;
  const std::string file = path("b.h5") + ": ", damaged = file + "a damaged ensemble (found ",
                    node = "ensemble/nodes/0000",
                    listed = file + "replicas: a damaged ensemble (found 3 replicas listed, statistics of ",
                    spread = "ensemble/spread/series/energy";
  const auto node_has = [&](const std::string& name, std::uint64_t value) {
    return [=](Result& r) { set(r, node, name, value); };
  };
  const auto replica_has = [](const char* name, std::uint64_t value) {
    return [=](Result& r) { values<std::uint64_t>(r, "replicas", name)[1] = value; };
  };
  const auto shorter = [&](const char* name) { return [=](Result& r) { values<double>(r, node, name).pop_back(); }; };
  const std::pair<std::function<void(Result&)>, std::string> damages[] = {
      {shorter("squares"), damaged + "statistics of different lengths)"},
      {shorter("least"), damaged + "statistics of different lengths)"},
      {shorter("greatest"), damaged + "statistics of different lengths)"},
      {shorter("mean"), "an ensemble of other quantities"},
      {node_has("replicas", many), damaged + "1152921504606846976 replicas in a node of level 1)"},
      {node_has("level", many), damaged + "2 replicas in a node of level 64)"},
      {[&](Result& r) { node_has("replicas", many)(r), node_has("level", 62)(r); }, damaged},
      {node_has("first", 1), damaged + "no node of the tree"},
      {node_has("first", 2), damaged + "replicas 2 to 2: some of them are there already"},
      {node_has("first", 4), listed},  // others than those listed
      {node_has("replicas", 1), damaged + "counts that cannot be)"},
      {replica_has("outcome", 4), listed},  // listed as failed
      {replica_has("index", 0), listed},
      {[](Result& r) { values<std::uint64_t>(r, "replicas", "collisions").pop_back(); },
       damaged + "columns of /replicas of different lengths"},
      {[&](Result& r) { set(r, spread, "bins", many); }, file + spread + ": no bins (found 1152921504606846976)"},
      {[&](Result& r) {
         values<std::uint64_t>(r, spread, "counts").resize(7);
         for (Column& c : group(r, spread).columns) c.width = 1;
       },
       damaged + "7 counts"},
      {[](Result& r) { std::ranges::find(r.attributes, "kind", &tools::Attribute::first)->second = 1.0; },
       file + "not a result of this program (found no attribute kind"}};
  for (const auto& [how, message] : damages) EXPECT_TRUE(begins(merging(how), message));
}

TEST_F(DamagedEnsembles, ScenesAreNotRunBeforeTheyAreKnownToBeTheRightOnes) {
  Result changed = read("a.h5");
  auto& scene = const_cast<std::string&>(attribute<std::string>(changed.attributes, "scene", "a.h5"));
  scene.replace(scene.find("particles = 300"), 15, "particles = 9000000000000");
  tools::write_result(changed, path("b.h5"));
  const Printed merge = shell("timeout 300 cradle merge b.h5 -o c.h5", 2);
  EXPECT_TRUE(has(merge.err, "b.h5: "));
}

class Mutations : public Ensembles {
 protected:
  // What the commands make of the file, as text.
  std::vector<std::function<std::string()>> commands() const {
    const std::string file = path("mutated.h5");
    return {[file] { return tools::listing(read_result(file, tools::Reading::ends), file, true); },
            [file] { return all_of(read_result(file)); },
            [file] {
              const Result result = read_result(file);
              return tools::effective_toml(
                  tools::parse_scene(attribute<std::string>(result.attributes, "scene", file), file));
            },
            [file] { return all_of(tools::merged({file})->result()); }};
  }

  void try_all(const std::string& name) const {
    const std::string sealed = contents(folder / name);
    write("mutated.h5", sealed);
    std::vector<std::string> right;
    for (const auto& command : commands()) try {
        right.push_back(command());
      } catch (const tools::Error& error) {
        right.emplace_back(error.what());
      }
    std::map<std::string, int> ends;
    for (int k = 0; k < mutations(100) / 2; ++k) {
      const auto seed = static_cast<unsigned>(k);
      write("mutated.h5", Mutator(seed).mutate(sealed));
      for (std::size_t c = 0; c < right.size(); ++c) {
        const std::clock_t before = std::clock();
        try {
          const std::string text = commands()[c]();
          ++ends["read"];
          EXPECT_TRUE(text == right[c]) << "read wrongly: seed " << seed << ", command " << c;
        } catch (const tools::Error& error) {
          ++ends["refused"];
          const std::string message = error.what();
          EXPECT_TRUE(error.status == Exit::io || error.status == Exit::bad_input) << message;
          EXPECT_TRUE(message == right[c] || message.find("mutated.h5") != message.npos) << message;
        }
        EXPECT_LT(std::clock() - before, 2 * CLOCKS_PER_SEC) << "seed " << seed << ", command " << c;
      }
    }
    for (const auto& [end, times] : ends) std::printf("%s: %s %d times\n", name.c_str(), end.c_str(), times);
  }
};

TEST_F(Mutations, OfARun) {
  run("run collapse.toml --quiet -o run.h5", 3);
  try_all("run.h5");
}

TEST_F(Mutations, OfAnEnsemble) {
  run("ensemble collapse.toml --replicas 3 --set output.series.points=5 -o some.h5");
  try_all("some.h5");
}

}  // namespace cradle::tests::damaged_ensembles_test
