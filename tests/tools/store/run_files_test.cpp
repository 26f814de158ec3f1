// The files beside a result during its run, as users meet them: inspected, damaged, of another version, or of another
// run that is in the way.
#include <thread>

#include "cradle/tests/tools/faults.hpp"
#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/result/difference.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/version.hpp"

namespace run_files_test {

using namespace cradle::tests;
using namespace cradle::tools;

const std::string run = "cradle run fig2 --quiet --set initial.particles=1000 --set run.until=1300 --set "
                        "output.checkpoint.every_seconds=0.05 ";

class Files : public ProgramTest {
 protected:
  // The command is refused with this status and a message that begins so, after "cradle: ".
  void refused(const std::string& command, int status, const std::string& message) const {
    EXPECT_TRUE(begins(shell("cradle " + command, status).err, "cradle: " + message)) << command;
  }
  // The contents with another checksum at their end, that of the bytes from `first` on.
  static std::string sealed(std::string bytes, std::size_t first = 0) {
    bytes.resize(bytes.size() - sizeof(std::uint64_t));
    return bytes + to_bytes(crc64(std::string_view(bytes).substr(first)));
  }

  // Leaves a run that was killed, with its state, and what it would have come to: whole.h5. One that was over before is
  // made again, twice as long, of twice as many particles: else they would have flown apart by then.
  void kill_a_run() const {
    for (int until = 1300;; until *= 2) {
      const std::string size = std::to_string(until);
      const std::string long_run = run + "--set run.until=" + size + " --set initial.particles=" + size + " -o ";
      shell("rm -f a.h5*; " + long_run +
            "a.h5 & pid=$!; until [ -e a.h5.checkpoint ] || [ -e a.h5 ]; do :; done; kill -9 $pid; wait $pid");
      if (exists("a.h5") || !exists("a.h5.part")) continue;
      shell(long_run + "whole.h5", 0);
      return;
    }
  }
};

JournalHeader header() {
  const Scene scene = parse_scene("law.type = 'sticky'\ninitial.type = 'rows'\nrun.until = 10\n", "s.toml");
  return {"run", 7, effective_toml(scene), "s"};
}

TEST_F(Files, ARunInProgressCanBeInspected) {
  const Printed inspected =
      shell(endless_run("a.h5") + until_collisions("a.h5") +
                "until cradle info a.h5.part >info && grep -q '^time.* of 1e+15' info; do sleep 0.1; done; cat info; "
                "echo ---; cradle info a.h5.checkpoint; kill -9 $pid",
            0);
  for (const char* said : {"journal of a run", "\ntime  ", " of 1e+15", "\ncollisions  ", " so far\n", "\ncomputing  ",
                           "\ncheckpoint  ", "/series", "energy_lost", "---\ncheckpoint of a run"})
    EXPECT_TRUE(has(inspected.out, said)) << inspected.out;
  EXPECT_FALSE(has(inspected.out, "not whole")) << "a journal that is being written has no torn end";
}

TEST_F(Files, FollowingARunEndsWithIt) {
  // A run that ends takes its journal away. This one never does, so that following it begins in time on any machine.
  const Printed followed =
      shell(endless_run("a.h5") + until_collisions("a.h5") +
                "cradle info --follow a.h5.part >printed & "
                "follower=$!; while ! grep -q 'journal of a run' printed; do sleep 0.02; done; kill -9 $pid; "
                "rm a.h5.part; wait $follower; status=$?; cat printed; (exit $status)",
            0);
  EXPECT_TRUE(has(followed.out, "a.h5.part is gone: the run is over")) << followed.out;
}

// What is beside FILE belongs to no run that is killed before it has written anything.
TEST_F(Files, ANewRunTakesTheJournalOfTheOneBeforeAway) {
  { JournalWriter journal(path("a.h5.part"), header()); }
  { const RunFiles files(path("a.h5"), parse_scene(header().scene, "s.toml")); }
  EXPECT_FALSE(exists("a.h5.part"));
  refused("resume a.h5", 4, "a.h5: nothing to continue from");
}

TEST_F(Files, AKilledRunIsGoneOnWithAndThenThereIsNothingToDo) {
  kill_a_run();
  shell("cradle resume a.h5.part", 0);  // any of the names
  expect_same("a.h5", "whole.h5");
  EXPECT_FALSE(exists("a.h5.part"));
  EXPECT_TRUE(has(shell("cradle resume a.h5", 0).out, "nothing to do"));
  refused("resume b.h5", 4, "b.h5: nothing to continue from");
  for (const auto& [until, said] :
       {std::pair("100", "before the end"), std::pair("soon", "not a number"),
        std::pair("1e99", "too late for this run"), std::pair("1e400", "too late for this run")})
    refused(std::string("resume a.h5 --until ") + until, 2, std::string("--until: ") + said);
}

TEST_F(Files, WithoutItsCheckpointARunStartsAnewAndWithADamagedOneItSaysSo) {
  kill_a_run();
  std::string state = contents(folder / "a.h5.checkpoint");
  state[state.size() / 2] = static_cast<char>(state[state.size() / 2] ^ 4);
  write("a.h5.checkpoint", state);
  refused("resume a.h5", 4,
          "a.h5.checkpoint: not a checkpoint, or damaged (found its checksum is wrong): remove it: the run then starts "
          "anew");
  std::filesystem::remove(folder / "a.h5.checkpoint");
  shell("cradle resume a.h5", 0);
  expect_same("a.h5", "whole.h5");
}

TEST_F(Files, OtherVersionsAreRefusedByName) {
  { JournalWriter journal(path("a.h5.part"), header()); }
  std::string bytes = contents(folder / "a.h5.part");
  const std::string here = version, other(here.size(), '9');
  const std::size_t begin = begin_of(Stored::journal).size() + sizeof(std::uint64_t);  // and the record's length
  ASSERT_EQ(bytes.substr(begin + sizeof(std::uint64_t), here.size()), here);
  bytes.replace(begin + sizeof(std::uint64_t), here.size(), other);
  write("a.h5.part", sealed(bytes, begin_of(Stored::journal).size()));
  for (const char* command : {"resume a.h5", "info a.h5.part", "ensemble fig2 --replicas 2 -o a.h5"})
    refused(command, 4,
            "a.h5.part: of another version of the program (found " + other + ", here " + here +
                "): continue with that one");
}

TEST_F(Files, ARunThatIsNotFinishedIsNotThrownAwayByAnother) {
  Scene same = parse_scene(header().scene, "s.toml");
  same.output.checkpoint.every_seconds = Decimal("1");  // changes no result, and is not in the journal
  for (const double seconds : {3.0, 3600.0}) {
    JournalWriter(path("a.h5.part"), header()).append(to_bytes(RunRecord(RunStatus{.seconds = seconds, .time = 5})));
    const std::string before = contents(folder / "a.h5.part");
    const Printed other = shell(run + "-o a.h5", 2);
    EXPECT_TRUE(has(other.err, "a run of other settings that is not finished (found t = 5, ")) << other.err;
    EXPECT_TRUE(has(other.err, "continue with `cradle resume a.h5`, give another -o FILE, or --force to replace it"));
    EXPECT_TRUE(contents(folder / "a.h5.part") == before);
  }
  EXPECT_TRUE(has(refusal(Exit::bad_input, [&] { RunFiles(path("a.h5"), same); }),
                  "a run that is not finished (found t = 5, 3600 s of computing)"));
  shell("cradle resume a.h5", 0);
  shell(run + "-o a.h5 --force", 0);
  EXPECT_FALSE(exists("a.h5.part"));
}

// However often checkpoints are wanted, the next one begins after ten times the time that the last one took.
TEST_F(Files, CheckpointsTakeATenthOfTheTimeAtMost) {
  RunFiles files(path("a.h5"), parse_scene(header().scene, "s.toml", {"output.checkpoint.every_seconds=1e-9"}));
  constexpr std::chrono::milliseconds taken(20);
  int saved = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < 50; ++k)
    files.keep(
        {}, [&](cradle::StateSink&) { ++saved, std::this_thread::sleep_for(taken); }, RunIs::in_progress);
  EXPECT_GE(saved, 1);
  EXPECT_LE(10 * (saved - 1) * taken, std::chrono::steady_clock::now() - begin);
}

// A number of the state that has changed, as memory without error correction does it: nothing of the file is damaged,
// but the run that continues from it cannot be.
TEST_F(Files, AGuardStopsARunWhoseStateIsWrong) {
  shell("cradle run cooling --quiet --set law.type=inelastic --set law.restitution=0.99 --set law.cutoff=0.01 --set "
        "initial.particles=100 --set run.until=50 --set output.checkpoint.every_seconds=1e-9 -o a.h5",
        0);
  std::string state = contents(folder / "a.h5.checkpoint");
  // The middle of the file is in the list of gaps: of four numbers each, the closing speed is the last.
  StateReader reader(path("a.h5.checkpoint"));
  std::pair<std::string, std::string> shape_and_precision;
  std::uint64_t slots = 0;
  cradle::load(reader, shape_and_precision), cradle::load(reader, slots);
  const std::size_t cells = state.size() - sizeof(std::uint64_t) - reader.left();
  const std::size_t at = cells + 32 * (slots / 2) + 24;
  double closing = 0;
  std::memcpy(&closing, state.data() + at, sizeof closing);
  closing += 1e-3;
  std::memcpy(state.data() + at, &closing, sizeof closing);
  state = sealed(state);
  write("a.h5.checkpoint", state);

  EXPECT_TRUE(has(shell("cradle resume a.h5 --until 1000", 5).err, "stopped by the guard of"));
  EXPECT_TRUE(contents(folder / "a.h5.checkpoint") == state) << "the one from before stays";
  EXPECT_TRUE(exists("a.h5"));
}

// More numbers than are held in memory go to the file piece by piece.
TEST_F(Files, PiecesMakeTheFileThatAllAtOnceMakes) {
  Result whole;
  whole.attributes = {{"format_version", format_version}, {"scene", std::string("none")}};
  std::vector<Group> pieces;
  for (std::uint64_t k = 0; k < 50; ++k) {
    std::vector<double> time, place;
    std::vector<std::uint64_t> collisions;
    std::vector<std::string> digits;  // longest in the middle
    for (std::uint64_t j = 0; j <= k; ++j) {
      time.push_back(static_cast<double>(100 * k + j));
      collisions.push_back(j);
      digits.emplace_back(k == 20 ? 40 - j : j % 7, '3');
      place.insert(place.end(), {1. / static_cast<double>(j + 1), static_cast<double>(k)});
    }
    pieces.push_back({"series", {}, {{"time", "t", "a time", time}, {"collisions", "1", "so many", collisions}}});
    pieces.push_back({"series/heaviest", {}, {{"x", "l", "two", place, 2}}});
    pieces.push_back({"exact/series", {}, {{"time", "t", "a time", digits}}});
  }
  pieces.push_back({"snapshots/0000", {{"time", 3.}}, {{"x", "l", "none", std::vector<double>()}}});
  GrowingTables all, ends(Reading::ends);
  for (const Group& piece : pieces) all.add(Group(piece)), ends.add(Group(piece));
  const Result outline{whole.attributes, in_order(std::move(ends))};
  whole.groups = in_order(std::move(all));
  EXPECT_EQ(std::get<std::vector<double>>(outline.find("series")->columns[0].values), (std::vector<double>{0, 4949}));
  const auto write = [&](const char* name) {
    write_in_pieces(
        outline, [&](const auto& put) { std::ranges::for_each(pieces, put); }, path(name));
  };
  write("pieces.h5");
  std::ranges::stable_sort(pieces, std::greater(), &Group::name);
  write("otherwise.h5");
  {
    const SmallFiles full;
    EXPECT_THROW(write("full.h5"), Error);
  }
  EXPECT_FALSE(exists("full.h5"));
  EXPECT_TRUE(contents(folder / "pieces.h5") == contents(folder / "otherwise.h5")) << "bytes follow the clock";
  write_result(whole, path("whole.h5"));
  const Result one = read_result(path("pieces.h5")), other = read_result(path("whole.h5"));
  ASSERT_EQ(one.groups.size(), 4U);
  EXPECT_TRUE(differences(one, other, "pieces", "whole").found.empty());
  for (std::size_t k = 0; k < one.groups.size(); ++k) EXPECT_EQ(one.groups[k].name, other.groups[k].name);
}

}  // namespace run_files_test
