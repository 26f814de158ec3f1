// Every scene of the package, at a size of a second or less, ends with the status that it is meant to end with
// (small_scenes.txt, of which test_scenes.py makes reports and pictures). A scene that is added needs a row there.
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tests::scenes_test {

struct Meant {
  int status;
  std::string command, scene, options;
};

std::vector<Meant> scenes() {
  std::istringstream file(contents(test::source_folder + "/tests/tools/run/small_scenes.txt"));
  std::vector<Meant> all;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Meant meant;
    if (!(words >> meant.status >> meant.command >> meant.scene)) continue;  // a comment
    std::getline(words, meant.options);
    all.push_back(meant);
  }
  return all;
}

class Scenes : public ProgramTest, public testing::WithParamInterface<Meant> {};

TEST_P(Scenes, EndAsTheyAreMeantTo) {
  const auto& [status, command, scene, options] = GetParam();
  shell("cradle " + command + " " + scene + options + " --quiet -o it.h5", status);
}

INSTANTIATE_TEST_SUITE_P(, Scenes, testing::ValuesIn(scenes()), [](const auto& parameter) {
  std::string name = parameter.param.scene + "_" + parameter.param.command;
  std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '_'; });
  return name;
});

TEST(ScenesMeant, AreAllThereAre) {
  std::set<std::string> tried, bundled;
  for (const Meant& meant : scenes()) tried.insert(meant.scene);
  for (const auto& scene : tools::bundled_scenes()) bundled.emplace(scene.name);
  EXPECT_EQ(tried, bundled);
}

}  // namespace cradle::tests::scenes_test
