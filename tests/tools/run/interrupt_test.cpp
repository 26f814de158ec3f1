// Signals: the first one ends a run, which keeps its results; a second one ends the program at once; nothing else
// changes. (Of the program: tests/tools/run/outputs.txt.)
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/support/interrupt.hpp"

#include <signal.h>

#include <csignal>
#include <thread>

#include <gtest/gtest.h>

#include "cradle/tools/run/run.hpp"

namespace cradle::tests::interrupt_test {

using tools::Interrupt;
using tools::RunEnd;

constexpr const char* shock = "law = { type = 'inelastic', restitution = 0.99, cutoff = 1e-5 }\nrun.until = 400\n"
                              "initial = { type = 'rows', particles = 600, perturbation = 0.05 }\n";

TEST(Interrupts, EndARunWithItsLastState) {
  Interrupt interrupt;
  interrupt.note(SIGHUP);
  for (const char* law : {"", "law = { type = 'wet', loss = 0.01 }\n", "law.type = 'sticky'\n"}) {
    std::string text = shock;
    if (*law) text.replace(0, text.find('\n') + 1, law);
    const auto scene = tools::parse_scene(text, "s.toml");
    const auto run = tools::run_scene(scene, {tools::Progress::Show::never, nullptr, &interrupt});
    EXPECT_EQ(run.end, RunEnd::interrupted) << law;
    EXPECT_TRUE(interrupt.heeded());
    EXPECT_LE(run.time, 400);
    ASSERT_NE(run.result.find("snapshots/0000"), nullptr) << "the state where it ended";
  }
  EXPECT_EQ(tools::status_of_signal(SIGHUP), tools::Exit::terminated);
  EXPECT_EQ(tools::status_of_signal(SIGINT), tools::Exit::interrupted);
}

TEST(Interrupts, OnesThatDoNotComeChangeNothing) {
  Interrupt interrupt;
  const auto scene = tools::parse_scene(shock, "s.toml");
  const auto polled = tools::run_scene(scene, {tools::Progress::Show::never, nullptr, &interrupt});
  const auto alone = tools::run_scene(scene, {tools::Progress::Show::never});
  EXPECT_EQ(polled.result.find("series")->columns[1].values, alone.result.find("series")->columns[1].values);
  EXPECT_EQ(polled.result.attributes, alone.result.attributes);
}

// Walks over rows that would take too long to wait for: a profile, an average over a zone, a sticky gas.
TEST(Interrupts, EndWalksOverRows) {
  const std::string rows = "initial = { type = 'rows', particles = 1e12 }\noutput.series.points = 2\n";
  for (const std::string& scene :
       {"law = { type = 'inelastic', restitution = 0.5 }\nrun.until = 1\noutput.profiles = { times = [0], range = "
        "[-4e11, 4e11], bins = 8 }\n" +
            rows,
        "law = { type = 'wet', loss = 0.01 }\nrun.until = 1\noutput.zone = { from = 0, reach = 4e11, samples = 16 }\n" +
            rows,
        "law.type = 'sticky'\nrun.until = 4e11\n" + rows}) {
    Interrupt interrupt;
    std::thread sender([&] {
      while (!interrupt.heeded()) std::this_thread::yield();
      interrupt.note(SIGTERM);
    });
    const auto run =
        tools::run_scene(tools::parse_scene(scene, "s.toml"), {tools::Progress::Show::never, nullptr, &interrupt});
    sender.join();
    EXPECT_EQ(run.end, RunEnd::interrupted) << scene;
    EXPECT_EQ(run.result.find("profiles/0000"), nullptr) << "of a part of the particles";
  }
}

// Programs started meanwhile end when they are hung up on, also where the tests themselves run under nohup: a program
// inherits that a signal is ignored, but takes the default for one that is handled.
class HangUpsNotIgnored {
 public:
  HangUpsNotIgnored() {
    ::sigaction(SIGHUP, nullptr, &before_);
    if (before_.sa_handler == SIG_IGN) std::signal(SIGHUP, [](int) {});
  }
  ~HangUpsNotIgnored() { ::sigaction(SIGHUP, &before_, nullptr); }

 private:
  struct sigaction before_ = {};
};

// In a process of its own that has polled for signals and gets some: how soon after the first one another counts as the
// same decides, not how soon they come here.
constexpr long at_once = -1, within_a_day = 86400000;
void get(bool heeded, long same, std::initializer_list<int> signals) {
  static Interrupt interrupt;
  tools::note_signals(interrupt, same);
  if (heeded) interrupt.heed();
  for (const int signal : signals) std::raise(signal);
  std::_Exit(interrupt.signal());
}

// How the program was started is read once, before main(): it is started anew for each of them.
class SignalsDeathTest : public testing::Test {
 protected:
  SignalsDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }  // until the case ends

 private:
  HangUpsNotIgnored hang_ups_not_ignored_;
};

TEST_F(SignalsDeathTest, TheFirstIsNotedTheSecondEndsTheProgram) {
  EXPECT_EXIT(get(true, at_once, {SIGINT}), testing::ExitedWithCode(SIGINT), "^$");
  EXPECT_EXIT(get(true, at_once, {SIGINT, SIGINT}), testing::ExitedWithCode(130), "interrupted again");
  EXPECT_EXIT(get(true, at_once, {SIGHUP, SIGTERM}), testing::ExitedWithCode(143), "interrupted again");
  EXPECT_EXIT(get(true, within_a_day, {SIGTERM, SIGTERM}), testing::ExitedWithCode(SIGTERM), "^$")
      << "one signal that was sent in two ways";
}

TEST_F(SignalsDeathTest, WhereNobodyAsksOneEndsTheProgram) {
  EXPECT_EXIT(get(false, at_once, {SIGINT}), testing::ExitedWithCode(130), "before there was anything to keep");
  EXPECT_EXIT(get(false, at_once, {SIGHUP}), testing::ExitedWithCode(143), "before there was anything to keep");
}

}  // namespace cradle::tests::interrupt_test
