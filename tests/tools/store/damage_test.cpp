// Journals after any kind of end: for any contents of the disk a reader gives exactly the complete records before the
// damage. Random damage to scenes, journals and checkpoints, from which a run starts or resumes: what a checksum
// detects is reported; contents with a correct checksum, which an attacker can write, are refused or resumed to some
// end, without a crash and within two seconds. CRADLE_MUTATIONS=10000 makes 10000 changes instead of 200.
#include "cradle/tools/store/unfinished.hpp"

#include <unistd.h>

#include <cerrno>

#include "cradle/tests/tools/faults.hpp"
#include "cradle/tests/tools/store/stopping.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/support/bytes.hpp"

namespace cradle::tests::damage_test {

using namespace tools;

class Journal : public ProgramTest {
 protected:
  std::string path() const { return (folder / "journal").string(); }
  static JournalHeader header() { return {"ensemble", 7, "scene", "name"}; }
  // With the header: what is cut or damaged within it is no journal.
  std::size_t size_without_records() const {
    { const JournalWriter none((folder / "none").string(), header(), nullptr, tools::Sync::no); }
    return std::filesystem::file_size(folder / "none");
  }
  void write_three() const {
    JournalWriter writer(path(), header());
    for (const auto* record : {"first", "", "the third one"}) writer.append(record);
  }
  static std::vector<std::string> rest_of(JournalReader& reader) {
    std::vector<std::string> all;
    for (std::string record; reader.next(record);) all.push_back(record);
    return all;
  }
  std::vector<std::string> records() const {
    JournalReader reader(path());
    return rest_of(reader);
  }
};

const std::vector<std::string> three{"first", "", "the third one"};

TEST_F(Journal, GivesBackWhatWasAppended) {
  write_three();
  EXPECT_EQ(tools::to_bytes(JournalReader(path()).header()), tools::to_bytes(header()));
  EXPECT_EQ(records(), three);
  JournalWriter(path(), std::filesystem::file_size(path())).append("fourth");
  EXPECT_EQ(records().back(), "fourth");
}

TEST_F(Journal, CutAnywhereGivesTheWholeRecordsBeforeTheCut) {
  write_three();
  const std::string whole = contents(path());
  const std::size_t begin = size_without_records();
  std::size_t at_least = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write("journal", whole.substr(0, size));
    if (size < begin) {
      EXPECT_THROW(JournalReader{path()}, tools::Error) << size;
      continue;
    }
    JournalReader reader(path());
    std::vector<std::string> found = rest_of(reader);
    ASSERT_LE(found.size(), 2U) << size;
    EXPECT_TRUE(std::equal(found.begin(), found.end(), three.begin())) << size;
    EXPECT_GE(found.size(), at_least) << size;
    at_least = found.size();
    EXPECT_EQ(reader.whole_bytes() + reader.torn_bytes(), size);
    // Whoever continues cuts off what is torn.
    JournalWriter(path(), reader.whole_bytes()).append("more");
    found.emplace_back("more");
    EXPECT_EQ(records(), found) << size;
  }
  EXPECT_EQ(at_least, 2U);
}

TEST_F(Journal, AnyChangedByteIsDetected) {
  write_three();
  const std::string whole = contents(path());
  const std::size_t begin = size_without_records();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    write("journal", changed);
    if (at < begin) {
      EXPECT_THROW(JournalReader{path()}, tools::Error) << at;
      continue;
    }
    const auto found = records();
    EXPECT_LT(found.size(), 3U) << at;
    EXPECT_TRUE(std::equal(found.begin(), found.end(), three.begin())) << at;
  }
}

TEST_F(Journal, WrittenAnewAppearsOnlyWhole) {
  write_three();
  EXPECT_THROW(JournalWriter(path(), header(),
                             [](const JournalWriter::Put& put) {
                               put("half of it");
                               throw std::runtime_error("disk full");
                             }),
               std::runtime_error);
  EXPECT_EQ(records(), three) << "the old one stays";
  const JournalWriter anew(path(), header(), [](const JournalWriter::Put& put) { put("all"); });
  EXPECT_EQ(records(), std::vector<std::string>{"all"});
}

TEST_F(Journal, HalfARecordIsTakenBackWhereTheDiskIsFull) {
  JournalWriter writer(path(), header());
  writer.append("first");
  {
    const SmallFiles full;
    EXPECT_THROW(writer.append(std::string(20000, 'x')), tools::Error);
  }
  writer.append("second");
  EXPECT_EQ(records(), (std::vector<std::string>{"first", "second"}));
}

// ---- random damage

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

}  // namespace cradle::tests::damage_test
