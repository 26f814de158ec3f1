// Random damage to scenes, journals and checkpoints, from which a run starts or resumes. Damage that a checksum detects
// is reported. Contents with a correct checksum, which an attacker can write, are refused or resumed to some end,
// without a crash and within two seconds. CRADLE_MUTATIONS=10000 makes 10000 changes instead of 200.
#include <unistd.h>

#include <cerrno>

#include "cradle/tests/tools/faults.hpp"
#include "cradle/tests/tools/store/stopping.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/support/bytes.hpp"

namespace malformed_test {

using namespace cradle::tests;
using namespace cradle::tools;

TEST(Malformed, Scenes) {
  Mutator mutator(1);
  int refused = 0;
  for (int k = 0; k < mutations(200); ++k) {
    const auto scenes = bundled_scenes();
    const std::string text = mutator.mutate(std::string(scenes[mutator.below(scenes.size())].text));
    try {
      const Scene scene = parse_scene(text, "malformed.toml");
      EXPECT_EQ(parse_scene(effective_toml(scene), "effective.toml"), parse_scene(effective_toml(scene), "again.toml"));
    } catch (const Error& error) {
      ++refused;
      EXPECT_NE(error.status, Exit::done);
      EXPECT_STRNE(error.what(), "");
    }
  }
  EXPECT_GT(refused, mutations(200) / 4);
}

class MalformedFiles : public ProgramTest {
 protected:
  MalformedFiles() {
    for (const char* law : {"law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n",
                            "law = { type = 'wet', loss = 0.01 }\n", "law.type = 'sticky'\n"})
      for (const char* initial : {"initial = { type = 'rows', particles = 12, perturbation = 0.05 }\n",
                                  "initial = { type = 'ring', particles = 8 }\n"})
        begin(parse_scene(std::string(law) + initial +
                              "output = { series.points = 9, snapshots = [5] }\nrun.until = 30\n",
                          "malformed.toml"));
  }
  // Leaves the files of a run that was stopped.
  void begin(const Scene& scene) {
    const std::string name = "run" + std::to_string(runs_++) + ".h5";
    Interrupt interrupt;
    Stopping files(interrupt, {.checks = 5}, path(name), scene);
    ASSERT_EQ(run_scene(scene, {Progress::Show::never, nullptr, &interrupt}, files).end, RunEnd::interrupted);
  }
  static constexpr int resumed = 0, refusal = 1;
  // How `work` ends there, within two seconds of processor time; another number where it crashes.
  static int in_another_process(const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
      const rlimit no_core{0, 0}, time{2, 3};
      ::setrlimit(RLIMIT_CORE, &no_core);
      ::setrlimit(RLIMIT_CPU, &time);
      try {
        work();
      } catch (const Error&) {
        ::_exit(refusal);
      }
      ::_exit(resumed);
    }
    int status = -1;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static void resume(const std::string& file) {
    RunFiles files(file, std::nullopt);
    Interrupt interrupt;
    run_scene(files.scene(), {Progress::Show::never, nullptr, &interrupt}, files);
  }

  std::size_t runs_ = 0;
};

TEST_F(MalformedFiles, CheckpointsAndJournals) {
  Mutator mutator(2);
  std::vector<std::pair<std::string, std::string>> whole;  // journal and checkpoint
  for (std::size_t k = 0; k < runs_; ++k) {
    const std::string name = "run" + std::to_string(k) + ".h5";
    whole.emplace_back(contents(folder / (name + ".part")), contents(folder / (name + ".checkpoint")));
  }
  int refused = 0;
  for (int k = 0; k < mutations(200); ++k) {
    SCOPED_TRACE(k);
    auto [journal, state] = whole[mutator.below(whole.size())];
    const bool of_state = mutator.below(2) == 0, sealed = mutator.below(4) > 0;
    if (of_state && sealed) {  // behind a checksum that is right
      state = mutator.mutate(state.substr(0, state.size() - 8), 8);
      state += to_bytes(crc64(state));
    } else if (of_state) {
      state = mutator.mutate(state);
    } else if (sealed) {  // a record of the journal
      write("whole.part", journal);
      JournalReader records(path("whole.part"));
      std::vector<std::string> all;
      for (std::string record; records.next(record);) all.push_back(record);
      std::string& one = all[mutator.below(all.size())];
      one = mutator.mutate(one);
      JournalWriter anew(path("a.h5.part"), records.header(), [&](const JournalWriter::Put& put) {
        for (const std::string& record : all) put(record);
      });
      journal = contents(folder / "a.h5.part");
    } else {
      journal = mutator.mutate(journal);
    }
    write("a.h5.part", journal);
    write("a.h5.checkpoint", state);
    std::filesystem::remove(folder / "a.h5");
    const int status = in_another_process([&] { resume(path("a.h5")); });
    EXPECT_TRUE(status == resumed || status == refusal) << "a crash, or more than two seconds";
    refused += status == refusal;
    EXPECT_EQ(exists("a.h5"), status == resumed);
    for (const char* file : {"a.h5.part", "a.h5.checkpoint"}) std::filesystem::remove(folder / file);
  }
  EXPECT_GT(refused, mutations(200) / 4);
}

}  // namespace malformed_test
