// Every scene of the package, at a size of a second or less, ends with the status that it is meant to end with
// (small_scenes.txt, of which test_scenes.py makes reports and pictures). A scene that is added needs a row there.

#include "cradle/tests/tools/cases.hpp"

namespace cradle::tests::scenes_test {

struct Meant {
  int status;
  std::string command, scene, options;
};

std::vector<Meant> scenes() {
  std::vector<Meant> all;
  for (const ListedCase& listed : cases_in("run/small_scenes.txt"))
    for (const std::string& line : listed.lines) {
      std::istringstream words(line);
      Meant& meant = all.emplace_back();
      words >> meant.status >> meant.command >> meant.scene;
      std::getline(words, meant.options);
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
