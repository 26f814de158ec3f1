// The wet law on a line, every way of holding the same bodies one against the other. Proves: a chain that streams its
// rows in and one that holds them all have the same bits, as have the same bodies without any knowledge of rows, runs
// whose output is read once, ten times or ten thousand times, with and without an observer, and with any number of
// index bits in the queue's keys; a loop without a queue makes the same contacts, and so does one in absolute positions
// that knows neither gaps nor streaming.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <map>

#include "cradle/core/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/slow_loop.hpp"
#include "cradle/tests/core/slow_ring.hpp"

namespace wet_twins_test {

using namespace cradle;
using namespace cradle::test;

template <class T> using WetRun = Simulation<T, Wet<T>, ClusterChain<T>>;

WetRun<double> wet_run(const Scene<double>& bodies, double loss, Options options = {}) {
  return {Wet<double>(loss), ClusterChain<double>(bodies, 0, options.hold_all), Policy<double>{},
          options.least_queue_bits};
}

// Rows that differ in density and speed, with a heavy body between them.
Scene<double> unequal_rows() {
  return std::make_shared<Rows<double>>(Row<double>{160, .75, .5}, Row<double>{240, -.25, 1.5},
                                        CentralBody<double>{20, .125}, rshock_displacement);
}

// Both from the first contact on, while rows come in, and after both are used up.
struct Case {
  const char* name;
  Scene<double> bodies;
  double loss, step, end;
};
std::vector<Case> cases() {
  return {{"passes first", rshock<double>(400), .005, 2.5, 400},
          {"merges from the start", rshock<double>(400), .05, 2.5, 400},
          {"unequal rows", unequal_rows(), .02, 12.5, 800}};
}

void expect_identical(WetRun<double>& first, WetRun<double>& second, double t) {
  ASSERT_EQ(first.advance(t), Status::reached);
  ASSERT_EQ(second.advance(t), Status::reached);
  ASSERT_TRUE(same_contacts(first.counts(), second.counts())) << "t = " << t;
  ASSERT_EQ(first.counts().origin_moves, second.counts().origin_moves) << "t = " << t;
  ASSERT_EQ(first.energy_lost(), second.energy_lost()) << "t = " << t;
  ASSERT_EQ(first.collided_bodies(), second.collided_bodies()) << "t = " << t;
  ASSERT_TRUE(identical(first.configuration(t), second.configuration(t))) << "t = " << t;
  if (first.collided_bodies() == 0) return;
  ASSERT_EQ(first.front_left(t), second.front_left(t)) << "t = " << t;
  ASSERT_EQ(first.front_right(t), second.front_right(t)) << "t = " << t;
}

TEST(WetTwins, StreamedAndHeldRowsHaveTheSameBits) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    auto streamed = wet_run(c.bodies, c.loss), held = wet_run(c.bodies, c.loss, {.hold_all = true});
    ASSERT_LT(streamed.chain().slots(), held.chain().slots());
    for (double t = c.step; t <= c.end; t += c.step) expect_identical(streamed, held, t);
    EXPECT_GT(streamed.counts().merges, 100U);
    EXPECT_GT(streamed.counts().contacts, 2 * streamed.counts().merges);
    const Configuration<double> last = streamed.configuration(c.end);
    EXPECT_EQ(last.to - last.from + 1, c.bodies->count());  // the rows are used up
  }
}

TEST(WetTwins, RowsAndTheSameBodiesInAListHaveTheSameBits) {
  const auto rows = rshock<double>(400);
  auto streamed = wet_run(rows, .01), listed = wet_run(as_list(*rows), .01);
  for (double t = 2.5; t <= 200; t += 2.5) expect_identical(streamed, listed, t);
}

TEST(WetTwins, IndexBitsChangeNoBit) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    auto narrow = wet_run(c.bodies, c.loss, {.least_queue_bits = 3});
    std::vector<WetRun<double>> wider;
    for (const int bits : {8, 13, 16}) wider.push_back(wet_run(c.bodies, c.loss, {.least_queue_bits = bits}));
    for (double t = c.end / 8; t <= c.end; t += c.end / 8)
      for (auto& other : wider) expect_identical(narrow, other, t);
  }
  // A queue of 8 million slots, for some hundred contacts.
  auto narrow = wet_run(rshock<double>(400), .05), widest = wet_run(rshock<double>(400), .05, {.least_queue_bits = 23});
  expect_identical(narrow, widest, 20);
}

// Rows that are each other's mirror image: contacts come in pairs at the same time but for rounding, so that keys
// cannot tell which is first, and at the centre three bodies meet.
TEST(WetTwins, NeitherCadenceNorIndexBitsMatterAmongSimultaneousContacts) {
  std::uint64_t close_calls = 0;
  for (BodyIndex seed = 0; seed < 20; ++seed) {
    const auto displacement = [seed](BodyIndex body) {
      const auto of_left = [seed](BodyIndex b) { return bits_of(b + 1000 * seed, 0, 0xFFFFF); };
      return body < 50 ? of_left(body) : -of_left(99 - body);
    };
    const Scene<double> bodies = std::make_shared<Rows<double>>(symmetric_rows<double>(100, .5, 1, displacement));
    std::vector<double> contact_times;
    auto once = wet_run(bodies, .01);
    once.advance(60, [&](const Contact<double>& c) { contact_times.push_back(c.time.value()); });
    auto often = wet_run(bodies, .01, {.least_queue_bits = 16});
    for (const double t : contact_times) ASSERT_EQ(often.advance(t), Status::reached);
    often.advance(60);
    EXPECT_TRUE(identical(once.configuration(60), often.configuration(60))) << "seed " << seed;
    EXPECT_EQ(once.energy_lost(), often.energy_lost()) << "seed " << seed;
    close_calls += often.counts().close_calls;
  }
  EXPECT_GT(close_calls, 0U);
}

TEST(WetTwins, OutputCadenceDoesNotChangeABit) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    auto once = wet_run(c.bodies, c.loss);
    ASSERT_EQ(once.advance(c.end), Status::reached);
    for (const int outputs : {10, 10000}) {
      auto often = wet_run(c.bodies, c.loss);
      for (int k = 1; k <= outputs; ++k) {
        const double t = c.end * k / outputs;
        ASSERT_EQ(often.advance(t), Status::reached);
        if (k % 100 == 0) often.configuration(t);
      }
      expect_identical(once, often, c.end);
    }
  }
}

TEST(WetTwins, OutputAtTheVeryTimeOfAContactDoesNotChangeABit) {
  const auto bodies = rshock<double>(100);
  std::vector<double> contact_times;
  auto once = wet_run(bodies, .01), often = wet_run(bodies, .01);
  once.advance(100, [&](const Contact<double>& c) { contact_times.push_back(c.time.value()); });
  ASSERT_GT(contact_times.size(), 300U);
  for (const double t : contact_times) ASSERT_EQ(often.advance(t), Status::reached);
  expect_identical(once, often, 100);
}

TEST(WetTwins, ObserverDoesNotChangeABit) {
  const auto bodies = rshock<double>(400);
  auto plain = wet_run(bodies, .01), observed = wet_run(bodies, .01);
  std::uint64_t seen = 0;
  observed.advance(200, [&](const Contact<double>& c) { seen += c.closing_speed > 0; });
  expect_identical(plain, observed, 200);
  EXPECT_EQ(seen, observed.counts().contacts);
}

// Whom each body met, in order. Contacts that have no body in common commute, and bodies pass each other: so this is
// what two runs must have in common.
using Meetings = std::map<BodyIndex, std::vector<BodyIndex>>;
void note(Meetings& meetings, BodyIndex left, BodyIndex right) {
  meetings[left].push_back(right);
  meetings[right].push_back(left);
}

TEST(WetTwins, QueueAndPlainSearchMakeTheSameContacts) {
  for (const Case& c :
       {Case{"equal", rshock<double>(200), .01, 0, 100}, Case{"unequal", unequal_rows(), .02, 0, 100}}) {
    SCOPED_TRACE(c.name);
    auto run = wet_run(c.bodies, c.loss);
    Meetings of_run, of_loop;
    run.advance(c.end, [&](const Contact<double>& contact) { note(of_run, contact.left, contact.right); });
    SlowLoop loop(Wet<double>(c.loss), ClusterChain<double>(c.bodies, 0, true));
    for (std::uint64_t n = 0; n < run.counts().contacts; ++n) {
      const auto s = loop.next();
      ASSERT_TRUE(s.has_value());
      note(of_loop, loop.chain().body(*s), loop.chain().body(loop.chain().right(*s)));
      loop.collide(*s);
    }
    EXPECT_GT(run.counts().contacts, 500U);
    EXPECT_GT(run.counts().merges, 50U);
    EXPECT_EQ(of_run, of_loop);
  }
}

// In absolute positions, all bodies moved from contact to contact and the next one found by looking at every pair; of a
// line, a ring so large that nothing comes round. With 50 digits neither side's rounding, 1e-50, shows within some 1e20
// of amplification, which 500 contacts are far from; a wrong contact would be off by orders of the spacing.
TEST(WetTwins, GapsAndPositionsMakeTheSameContactsWithUnequalMasses) {
  using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
  for (const double loss : {.01, .1, 1.}) {
    SCOPED_TRACE(loss);
    std::vector<Wide> x, v, m;
    for (BodyIndex i = 0; i < 60; ++i) {
      x.push_back(Wide(i) + Wide(bits_of(i, 0, 0x3FF)) / Wide(2048));
      v.push_back(Wide(bits_of(i, 20, 0x3FFF) - 8192) / Wide(4096));
      m.push_back(Wide(1 + bits_of(i, 40, 7)) / Wide(4));
    }
    const List<Wide> large_ring(x, v, m, Wide(1 << 20));
    WetRun<Wide> run(Wet<Wide>{Wide(loss)}, ClusterChain<Wide>(list(x, v, m), Wide(0)));
    SlowRing<Wide> twin(large_ring);
    for (int t = 5; t <= 60; t += 5) {
      ASSERT_EQ(run.advance(Wide(t)), Status::reached);
      twin.advance(Wet<Wide>{Wide(loss)}, Wide(t));
      ASSERT_EQ(run.counts().contacts, twin.contacts) << t;
      ASSERT_EQ(run.counts().merges, twin.merges) << t;
      const auto c = run.configuration(Wide(t));
      const auto bodies = twin.unfolded();
      ASSERT_EQ(c.from, 0);
      ASSERT_EQ(c.to, 59);
      ASSERT_EQ(c.x.size(), bodies.size());
      for (std::size_t j = 0; j < bodies.size(); ++j) {
        ASSERT_EQ(c.index[j], bodies[j].index) << t;
        ASSERT_EQ(c.m[j], bodies[j].m) << t;
        ASSERT_LE(abs(c.x[j] - bodies[j].x), Wide(1e-30)) << t << ", body " << c.index[j];
        ASSERT_LE(abs(c.v[j] - bodies[j].v), Wide(1e-30)) << t << ", body " << c.index[j];
      }
    }
    EXPECT_GT(run.counts().contacts, 60U);
    EXPECT_GT(run.counts().merges, 10U);
  }
}

}  // namespace wet_twins_test
