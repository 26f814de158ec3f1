// Pictures: every kind is made from a small run, without a display, as PNG and as SVG, and twice with the same bytes:
// as SVG, which has every number that is drawn, and the first kind as PNG too. The contents of a file decide which
// pictures it has: the names that the program prints are those of pictures.txt.

#include "cradle/tests/tools/cases.hpp"

namespace cradle::tests::plots_test {

struct Kind {
  int status = 0;
  std::string name;
  std::vector<std::string> others;  // pictures beside the main one
  std::string command;              // makes `it.h5`
};

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const ListedCase& listed : cases_in("plot/pictures.txt")) {
    std::istringstream head(listed.name());
    Kind& kind = all.emplace_back();
    head >> kind.status >> kind.name;
    kind.others.assign(std::istream_iterator<std::string>(head), {});
    kind.command = listed.below_name();
  }
  return all;
}

void PrintTo(const Kind& kind, std::ostream* stream) { *stream << kind.command; }

class Pictures : public ProgramTest, public testing::WithParamInterface<Kind> {
 protected:
  // Names of the pictures of it.h5, the main one `name` with this extension.
  std::vector<std::string> plot(const std::string& name, const std::string& extension) const {
    std::vector<std::string> names{name + extension};
    for (const auto& other : GetParam().others) names.push_back(name + "-" + other + extension);
    std::string printed;
    for (const auto& file : names) printed += file + "\n";
    const Printed plot = shell("env -u DISPLAY -u WAYLAND_DISPLAY cradle plot it.h5 -o " + names.front(), 0);
    EXPECT_EQ(plot.out, printed);
    EXPECT_EQ(plot.err, "");
    return names;
  }
};

TEST_P(Pictures, AreMadeWithoutDisplayAndTwiceTheSame) {
  shell(GetParam().command + " --quiet -o it.h5", GetParam().status);
  for (const std::string extension : {".png", ".svg"}) {
    const bool twice = extension == ".svg" || GetParam().name == kinds().front().name;
    const auto once = plot("once", extension), again = twice ? plot("again", extension) : once;
    for (std::size_t k = 0; k < once.size(); ++k) {
      const std::string picture = contents(folder / once[k]);
      EXPECT_EQ(picture.substr(0, 5), extension == ".png" ? "\x89PNG\r" : "<?xml") << once[k];
      EXPECT_GT(picture.size(), 10000U) << once[k];
      EXPECT_EQ(picture, contents(folder / again[k])) << once[k];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Pictures, testing::ValuesIn(kinds()),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace cradle::tests::plots_test
