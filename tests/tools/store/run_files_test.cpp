// The files beside a result during its run: damaged, of another version, or of another run that is in the way.
// (Inspected, of runs that are killed, that nobody else writes to them: tests/tools/run/outputs.txt.) What is
// overwritten of proofs whose precision was raised, and of studies that were forced and interrupted; of two ensembles
// that write to one name the second is refused before it has done anything. (All else that is replaced or not:
// tests/tools/outputs.txt.)
#include <thread>

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tests/tools/faults.hpp"
#include "cradle/tools/commands/difference.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/version.hpp"

namespace run_files_test {

using namespace cradle::tests;
using namespace cradle::tools;

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
};

JournalHeader header() {
  const Scene scene = parse_scene("law.type = 'sticky'\ninitial.type = 'rows'\nrun.until = 10\n", "s.toml");
  return {"run", 7, effective_toml(scene), "s"};
}

// What is beside FILE belongs to no run that is killed before it has written anything.
TEST_F(Files, ANewRunTakesTheJournalOfTheOneBeforeAway) {
  { JournalWriter journal(path("a.h5.part"), header()); }
  { const RunFiles files(path("a.h5"), parse_scene(header().scene, "s.toml")); }
  EXPECT_FALSE(exists("a.h5.part"));
  refused("resume a.h5", 4, "a.h5: nothing to continue from");
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
    const Printed other = shell("cradle run fig5 --quiet -o a.h5", 2);
    EXPECT_TRUE(has(other.err, "a run of other settings that is not finished (found t = 5, ")) << other.err;
    EXPECT_TRUE(has(other.err, "continue with `cradle resume a.h5`, give another -o FILE, or --force to replace it"));
    EXPECT_TRUE(contents(folder / "a.h5.part") == before);
  }
  EXPECT_TRUE(has(refusal(Exit::bad_input, [&] { RunFiles(path("a.h5"), same); }),
                  "a run that is not finished (found t = 5, 3600 s of computing)"));
  shell("cradle resume a.h5", 0);
  shell("cradle run fig5 --quiet -o a.h5 --force", 0);
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

// ---- what is overwritten

using Overwriting = ProgramTest;

constexpr const char* scene = "law = { type = 'inelastic', restitution = 0.9 }\nrun.until = 4\n"
                              "initial = { type = 'rows', particles = 6, perturbation = 0.05 }\n";

TEST_F(Overwriting, AProofWhosePrecisionWasRaisedIsMadeAgain) {
  const Scene given = parse_scene(scene, "s.toml"), raised = parse_scene(scene, "s.toml", {"run.precision=float128"});
  Result result{{{"scene", effective_toml(raised)}, {"name", "s"}, {"precision", precision_name(raised.run)}}, {}};
  result.attributes.insert(result.attributes.begin(), {"format_version", std::uint64_t{2}});
  say_how_made(result, "certify", given);
  write_result(result, path("proof.h5"));
  check_overwrite(path("proof.h5"), "certify", &given, Force::no);
  EXPECT_TRUE(has(refusal(Exit::bad_input, [&] { check_overwrite(path("proof.h5"), "certify", &raised, Force::no); }),
                  "another command (found cradle certify --set 'run.precision=double', here certify)"));
}

// A forced study that was interrupted continues; its journal says that it replaces what is there.
TEST_F(Overwriting, AForcedEnsembleCanBeResumed) {
  write("s.toml", scene);
  shell("cradle ensemble s.toml --replicas 2 -o e.h5", 0);
  const Study other = ensemble_of(parse_scene(scene, "s.toml", {"law.restitution=0.8"}));
  {
    EnsembleStore store(other, path("e.h5"));
    store.load(Force::yes);
    store.start_journal(0, {0, 3}, 1 << 20);
  }
  EXPECT_TRUE(exists("e.h5.part"));
  shell("cradle resume e.h5", 0);
  EXPECT_EQ(attribute<std::uint64_t>(read("e.h5").attributes, "replicas", "e.h5"), 3U);
  EXPECT_TRUE(has(attribute<std::string>(read("e.h5").attributes, "scene", "e.h5"), "restitution = 0.8"));
}

// The second comes when the first one is about to run its first replica.
TEST_F(Ensembles, SecondOfTwoThatBeginAfreshIsRefused) {
  struct First : OneProcess {
    using OneProcess::OneProcess;
    int share(const std::vector<JobRange>& jobs, const std::function<void(const NextJob&)>& work,
              const std::function<void(std::uint64_t)>& others_took) override {
      begun();
      return OneProcess::share(jobs, work, others_took);
    }
    std::function<void()> begun;
  };
  Printed second{-1, "", ""};
  Interrupt interrupt;
  First first(interrupt);
  first.begun = [&] {
    EXPECT_FALSE(exists("a.h5"));
    second = shell("cradle ensemble shock.toml --first 4 --replicas 4 -o a.h5");
  };
  const EnsembleOptions options{.replicas = {0, 4}, .progress = ProgressLine::Show::never};
  EXPECT_EQ(run_study(ensemble_of(scene("shock.toml")), options, path("a.h5"), first).status, Exit::done);
  EXPECT_EQ(second.status, 4);
  EXPECT_TRUE(begins(second.err, "cradle: a.h5: another program is writing this file (found process "));
  // It comes again when the first one is done: nothing is lost.
  run("ensemble shock.toml --first 4 --replicas 4 -o a.h5");
  run("ensemble shock.toml --replicas 8 -o whole.h5");
  expect_same("whole.h5", "a.h5");
}

}  // namespace run_files_test
