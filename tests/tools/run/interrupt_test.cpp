// Signals: what has been computed is kept, whoever does not wait for that is not made to, and nothing else changes.
#include "cradle/tools/support/interrupt.hpp"

#include <signal.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <thread>
#include <utility>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tests {
namespace interrupt_test {

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
  const auto asked = tools::run_scene(scene, {tools::Progress::Show::never, nullptr, &interrupt});
  const auto alone = tools::run_scene(scene, {tools::Progress::Show::never});
  EXPECT_EQ(asked.result.find("series")->columns[1].values, alone.result.find("series")->columns[1].values);
  EXPECT_EQ(asked.result.attributes, alone.result.attributes);
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
  HangUpsNotIgnored(const HangUpsNotIgnored&) = delete;
  HangUpsNotIgnored& operator=(const HangUpsNotIgnored&) = delete;

 private:
  struct sigaction before_ = {};
};

class Signals : public ProgramTest {
 protected:
  // Starts a command, waits until it has worked for so many hundredths of a second, then does what is said.
  Printed signalled(const std::string& command, int work, const std::string& then) const {
    return shell(command + " & pid=$!; while [ $(cut -d' ' -f14 /proc/$pid/stat) -lt " + std::to_string(work) +
                 " ]; do sleep 0.01; done; " + then);
  }

 private:
  HangUpsNotIgnored hang_ups_not_ignored_;
};

// Contacts without end once it collapses.
const std::string long_run = "cradle run fig2 --set run.until=1e6 --set law.cutoff=0 --set run.collapse=cutoff "
                             "--set initial.particles=4000 -o long.h5";

TEST_F(Signals, KeepWhatARunHas) {
  for (const auto& [signal, status] :
       {std::pair("INT", 130), std::pair("TERM", 143), std::pair("USR1", 143), std::pair("HUP", 143)}) {
    const Printed run = signalled(long_run, 30, std::string("kill -") + signal + " $pid; wait $pid");
    EXPECT_EQ(run.status, status) << signal << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "long.h5"));
    EXPECT_NE(run.err.find("`cradle resume long.h5` goes on from there"), std::string::npos) << run.err;
    const Printed state = shell("cradle info long.h5.checkpoint");
    EXPECT_EQ(state.status, 0) << state.err;
    EXPECT_EQ(state.out.find(" 0 contacts"), std::string::npos) << state.out;
    EXPECT_EQ(shell("cradle info long.h5.part").status, 0);
    std::filesystem::remove(folder / "long.h5.part");
    std::filesystem::remove(folder / "long.h5.checkpoint");
  }
}

TEST_F(Signals, HangUpsAreIgnoredUnderNohup) {
  const Printed run =
      signalled("nohup cradle run fig2 --quiet -o a.h5 --set run.until=3000", 5, "kill -HUP $pid; wait $pid");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "a.h5"));
}

TEST_F(Signals, EndAProgramThatIsStillSettingUp) {
  // 3e7 bodies on a ring take far longer to set up than this.
  const Printed run = signalled("cradle run cooling --set initial.particles=3e7 -o ring.h5", 20,
                                "kill -INT $pid; from=$(date +%s%N); wait $pid; status=$?; "
                                "echo $((($(date +%s%N) - from) / 1000000)); (exit $status)");
  EXPECT_EQ(run.status, 130) << run.err;
  EXPECT_LT(std::stol(run.out), 2000) << "milliseconds";
  EXPECT_NE(run.err.find("before there was anything to keep"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "ring.h5.checkpoint"));
}

// In a process of its own that has asked for signals and gets some.
void get(bool heeded, std::initializer_list<std::pair<int, int>> signals_after_milliseconds) {
  static Interrupt interrupt;
  tools::note_signals(interrupt);
  if (heeded) interrupt.heed();
  for (const auto& [signal, milliseconds] : signals_after_milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    std::raise(signal);
  }
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
  EXPECT_EXIT(get(true, {{SIGINT, 0}}), testing::ExitedWithCode(SIGINT), "^$");
  EXPECT_EXIT(get(true, {{SIGINT, 0}, {SIGINT, 300}}), testing::ExitedWithCode(130), "interrupted again");
  EXPECT_EXIT(get(true, {{SIGHUP, 0}, {SIGTERM, 300}}), testing::ExitedWithCode(143), "interrupted again");
  EXPECT_EXIT(get(true, {{SIGTERM, 0}, {SIGTERM, 0}}), testing::ExitedWithCode(SIGTERM), "^$")
      << "one signal that was sent in two ways";
}

TEST_F(SignalsDeathTest, WhereNobodyAsksOneEndsTheProgram) {
  EXPECT_EXIT(get(false, {{SIGINT, 0}}), testing::ExitedWithCode(130), "before there was anything to keep");
  EXPECT_EXIT(get(false, {{SIGHUP, 0}}), testing::ExitedWithCode(143), "before there was anything to keep");
}

}  // namespace interrupt_test
}  // namespace cradle::tests
