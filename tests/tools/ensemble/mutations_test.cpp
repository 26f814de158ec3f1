// Random damage to result files: after any change the code behind info, export, plot and merge reads the file correctly
// or refuses it with a message and a documented status; it never crashes and never takes long. CRADLE_MUTATIONS=2000
// makes 2000 changes instead of 100.
#include <cstdio>
#include <ctime>

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tests/tools/faults.hpp"
#include "cradle/tests/tools/result/result_files.hpp"
#include "cradle/tools/commands/commands.hpp"

namespace cradle::tests::mutations_test {

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

}  // namespace cradle::tests::mutations_test
