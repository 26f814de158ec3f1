// Random damage to result files: whatever is changed in one, the code behind info, export, plot and merge reads it
// rightly or refuses it with a message and a documented status; it never crashes and never takes long.
// CRADLE_MUTATIONS=2000 makes it more than the usual 100.

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/merge.hpp"
#include "cradle/tools/result/csv.hpp"
#include "cradle/tools/result/listing.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tests {
namespace mutations_test {

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string mutate(std::string file) {
    for (std::size_t faults = below(4) == 0 ? 3 : 1; faults > 0 && !file.empty(); --faults) one(file);
    return file;
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  std::size_t length(std::size_t most) { return 1 + below(below(most) + 1); }

  void one(std::string& file) {
    const std::size_t at = below(file.size()), n = std::min(length(600), file.size() - at);
    switch (below(7)) {
    case 0:
      file[at] = static_cast<char>(file[at] ^ (1 << below(8)));
      break;
    case 1:
      file.resize(at);
      break;
    case 2:
      std::fill_n(file.begin() + static_cast<std::ptrdiff_t>(at), n, '\0');
      break;
    case 3:
      for (std::size_t k = 0; k < n; ++k) file[at + k] = static_cast<char>(below(256));
      break;
    case 4:
      file.replace(at, n, file.substr(below(file.size()), n));
      break;
    case 5:
      number(file, at / 8 * 8);
      break;
    default:
      number(file, structure(file) + below(64));
      break;
    }
  }

  // Somewhere in HDF5's own bookkeeping.
  std::size_t structure(const std::string& file) {
    static constexpr std::array names{"TREE", "HEAP", "SNOD", "GCOL", "OHDR", "FRHP", "BTHD", "\x89HDF"};
    const std::size_t found = file.find(names.at(below(names.size())), below(file.size()));
    return found == file.npos ? 0 : found;
  }

  // Sizes, counts and addresses that cannot be.
  void number(std::string& file, std::size_t at) {
    static constexpr std::array<std::uint64_t, 8> wrong{0, 1, ~0ULL, 1ULL << 40, 1ULL << 63, 255, 65535, 96};
    std::uint64_t value = wrong.at(below(wrong.size()));
    const std::size_t bytes = std::size_t{1} << below(4);
    for (std::size_t k = at; k < std::min(at + bytes, file.size()); ++k, value >>= 8)
      file[k] = static_cast<char>(value & 255);
  }

  std::mt19937_64 random_;
};

double processor_seconds() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    ::getrusage(who, &used);
    for (const timeval& t : {used.ru_utime, used.ru_stime})
      sum += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  }
  return sum;
}

std::string all_of(const Result& result) {
  std::string text;
  for (const auto& group : result.groups) text += "/" + group.name + "\n" + tools::csv(group);
  return text;
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
    const char* wanted = std::getenv("CRADLE_MUTATIONS");
    const int count = wanted != nullptr ? std::atoi(wanted) / 2 : 50;
    write("mutated.h5", sealed);
    std::vector<std::string> right;
    for (const auto& command : commands()) try {
        right.push_back(command());
      } catch (const tools::Error& error) {
        right.emplace_back(error.what());
      }
    std::map<std::string, int> ends;
    for (int k = 0; k < count; ++k) {
      const auto seed = static_cast<unsigned>(k);
      write("mutated.h5", Mutator(seed).mutate(sealed));
      for (std::size_t c = 0; c < right.size(); ++c) {
        const double before = processor_seconds();
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
        EXPECT_LT(processor_seconds() - before, 2) << "seed " << seed << ", command " << c;
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

}  // namespace mutations_test
}  // namespace cradle::tests
