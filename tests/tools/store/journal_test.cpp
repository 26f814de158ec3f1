// Journals after any kind of end: for any contents of the disk a reader gives exactly the complete records before the
// damage.
#include "cradle/tools/store/unfinished.hpp"

#include "cradle/tests/tools/faults.hpp"
#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::journal_test {

using tools::JournalHeader;
using tools::JournalReader;
using tools::JournalWriter;

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

}  // namespace cradle::tests::journal_test
