#pragma once
// Runs the program as a user does: a shell command in a separate folder, with its exit status and its output.

#include <fmt/format.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cradle/tests/places.hpp"
#include "cradle/tests/texts.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tests {

using test::begins;
using test::has;
using test::matches;

// The message of the error that `work` throws, with this status.
template <class Work> std::string refusal(tools::Exit status, const Work& work) {
  try {
    work();
  } catch (const tools::Error& error) {
    EXPECT_EQ(error.status, status) << error.what();
    return error.what();
  }
  return "nothing was refused";
}

struct Printed {
  int status;
  std::string out, err;
};

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class ProgramTest : public testing::Test {
 protected:
  ProgramTest() {
    std::string name = (std::filesystem::temp_directory_path() / "cradle-test-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) folder = name;
  }
  ~ProgramTest() override {
    std::error_code ignored;
    if (!folder.empty()) std::filesystem::remove_all(folder, ignored);
  }

  // `command` is typed in the test's folder; `cradle` is the built program. The test fails if the exit status is not
  // the expected one.
  Printed shell(const std::string& command, std::optional<int> expected = {}, const char* file = __builtin_FILE(),
                int line = __builtin_LINE()) const {
    const std::string whole = "cd '" + folder.string() + "' && PATH=\"" + test::build_folder + "/tools:$PATH\" && { " +
                              command + "\n} >.out 2>.err </dev/null";
    const int status = std::system(whole.c_str());
    Printed printed{WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder / ".out"), contents(folder / ".err")};
    if (expected && printed.status != *expected)
      ADD_FAILURE_AT(file, line) << "status " << printed.status << ", not " << *expected << ": " << command << "\n"
                                 << printed.out << printed.err;
    return printed;
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream stream(folder / name, std::ios::binary);
    stream << text;
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }
  tools::Result read(const std::string& name) const { return tools::read_result(path(name)); }
  void expect_same(const std::string& a, const std::string& b) const {
    ASSERT_FALSE(contents(folder / a).empty()) << a;
    EXPECT_TRUE(contents(folder / a) == contents(folder / b)) << a << " and " << b << " differ";
  }

  // The result of a run of this scene, written as scene.toml, that ends with this status.
  tools::Result result_of(const std::string& scene, const std::string& options = "", int status = 0) const {
    write("scene.toml", scene);
    shell("cradle run scene.toml --quiet --force -o result.h5 " + options, status);
    return read("result.h5");
  }
  // Its results in all types of this build that are wider than double, mpfr with 100 digits.
  template <class Use> void in_wide_types(const std::string& scene, const Use& use, int status = 0) const {
    write("scene.toml", scene);
    for (const std::string precision :
         {"'long double'", "double-double", "float128", "cpp_bin_float", "mpfr --set run.digits=100"}) {
      SCOPED_TRACE(precision);
      const Printed run = shell("cradle run scene.toml --quiet --force -o wide.h5 --set run.precision=" + precision);
      if (has(run.err, "not in this build")) continue;
      ASSERT_EQ(run.status, status) << run.err;
      use(read("wide.h5"));
    }
  }

  std::filesystem::path folder;
};

inline const tools::Column& column(const tools::Group& group, std::string_view name) {
  for (const tools::Column& c : group.columns)
    if (c.name == name) return c;
  throw std::out_of_range(group.name + "/" + std::string(name));
}
inline const tools::Column& column(const tools::Result& result, std::string_view group, std::string_view name) {
  const tools::Group* found = result.find(group);
  if (found == nullptr) throw std::out_of_range(std::string(group));
  return column(*found, name);
}
template <class T = double>
std::vector<T> numbers(const tools::Result& result, std::string_view group, std::string_view name) {
  return std::get<std::vector<T>>(column(result, group, name).values);
}

}  // namespace cradle::tests
