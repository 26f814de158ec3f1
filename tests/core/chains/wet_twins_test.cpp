// Compares every way of holding the same particles, with the wet law on a line. Proves: a chain that streams its rows
// and one that holds them completely have the same bits, and so have particles given as a list, runs with output once,
// ten times or ten thousand times, with and without an observer, and with any number of index bits in the queue's keys.
// A loop without a queue makes the same collisions, and so does one in absolute positions, without gaps or streaming.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <map>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/chains/twins.hpp"
#include "cradle/tests/core/slow_loop.hpp"
#include "cradle/tests/core/slow_ring.hpp"

namespace wet_twins_test {

using namespace cradle;
using namespace cradle::test;

template <class T> using WetRun = Simulation<T, Wet<T>, ClusterChain<T>>;

WetRun<double> wet_run(const Scene<double>& particles, double loss, Options options = {}) {
  return {Wet<double>(loss), ClusterChain<double>(particles, 0, options.hold_all), Policy<double>{},
          options.least_queue_bits};
}

// Both from the first collision on, while rows come in, and after both are used up.
struct Case {
  const char* name;
  Scene<double> particles;
  double loss, step, end;
};
std::vector<Case> cases() {
  return {{"passes first", rshock<double>(400), 0.005, 2.5, 400},
          {"merges from the start", rshock<double>(400), 0.05, 2.5, 400},
          {"unequal rows", unequal_rows(), 0.02, 12.5, 800}};
}

TEST(WetTwins, StreamedAndHeldRowsHaveTheSameBits) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    auto streamed = wet_run(c.particles, c.loss), held = wet_run(c.particles, c.loss, {.hold_all = true});
    ASSERT_LT(streamed.chain().slots(), held.chain().slots());
    for (double t = c.step; t <= c.end; t += c.step) expect_identical(streamed, held, t);
    EXPECT_GT(streamed.counts().merges, 100U);
    EXPECT_GT(streamed.counts().collisions, 2 * streamed.counts().merges);
    const Configuration<double> last = streamed.configuration(c.end);
    EXPECT_EQ(last.to - last.from + 1, c.particles->count());  // the rows are used up
  }
}

TEST(WetTwins, RowsAndTheSameParticlesInAListHaveTheSameBits) {
  const auto rows = rshock<double>(400);
  auto streamed = wet_run(rows, 0.01), listed = wet_run(as_list(*rows), 0.01);
  for (double t = 2.5; t <= 200; t += 2.5) expect_identical(streamed, listed, t);
}

TEST(WetTwins, IndexBitsChangeNoBit) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    auto narrow = wet_run(c.particles, c.loss, {.least_queue_bits = 3});
    std::vector<WetRun<double>> wider;
    for (const int bits : {8, 13, 16}) wider.push_back(wet_run(c.particles, c.loss, {.least_queue_bits = bits}));
    for (double t = c.end / 8; t <= c.end; t += c.end / 8)
      for (auto& other : wider) expect_identical(narrow, other, t);
  }
  // A queue of 8 million slots, for some hundred collisions.
  auto narrow = wet_run(rshock<double>(400), 0.05),
       widest = wet_run(rshock<double>(400), 0.05, {.least_queue_bits = 23});
  expect_identical(narrow, widest, 20);
}

// Rows that are each other's mirror image: collisions come in pairs at the same time but for rounding, so that keys
// cannot decide which is first, and at the centre three particles meet.
TEST(WetTwins, NeitherCadenceNorIndexBitsMatterAmongSimultaneousCollisions) {
  std::uint64_t close_calls = 0;
  for (ParticleIndex seed = 0; seed < 20; ++seed) {
    const auto displacement = [seed](ParticleIndex particle) {
      const auto of_left = [seed](ParticleIndex b) { return bits_of(b + 1000 * seed, 0, 0xFFFFF); };
      return particle < 50 ? of_left(particle) : -of_left(99 - particle);
    };
    const Scene<double> particles = std::make_shared<Rows<double>>(symmetric_rows<double>(100, 0.5, 1, displacement));
    SCOPED_TRACE(seed);
    auto often = wet_run(particles, 0.01, {.least_queue_bits = 16});
    expect_no_influence_of_output_at_collisions(wet_run(particles, 0.01), often, 60, 1);
    close_calls += often.counts().close_calls;
  }
  EXPECT_GT(close_calls, 0U);
}

TEST(WetTwins, OutputCadenceDoesNotChangeABit) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    expect_no_influence_of_cadence([&] { return wet_run(c.particles, c.loss); }, c.end);
  }
}

TEST(WetTwins, OutputAtTheVeryTimeOfACollisionDoesNotChangeABit) {
  const auto particles = rshock<double>(100);
  expect_no_influence_of_output_at_collisions(wet_run(particles, 0.01), wet_run(particles, 0.01), 100, 301);
}

TEST(WetTwins, ObserverDoesNotChangeABit) {
  const auto particles = rshock<double>(400);
  expect_no_influence_of_an_observer(wet_run(particles, 0.01), wet_run(particles, 0.01), 200);
}

// Whom each particle met, in order. Collisions that have no particle in common commute, and particles pass each other:
// so this is what two runs must have in common.
using Meetings = std::map<ParticleIndex, std::vector<ParticleIndex>>;
void note(Meetings& meetings, ParticleIndex left, ParticleIndex right) {
  meetings[left].push_back(right);
  meetings[right].push_back(left);
}

TEST(WetTwins, QueueAndPlainSearchMakeTheSameCollisions) {
  for (const Case& c :
       {Case{"equal", rshock<double>(200), 0.01, 0, 100}, Case{"unequal", unequal_rows(), 0.02, 0, 100}}) {
    SCOPED_TRACE(c.name);
    auto run = wet_run(c.particles, c.loss);
    Meetings of_run, of_loop;
    run.advance(c.end, [&](const Collision<double>& collision) { note(of_run, collision.left, collision.right); });
    SlowLoop loop(Wet<double>(c.loss), ClusterChain<double>(c.particles, 0, true));
    for (std::uint64_t n = 0; n < run.counts().collisions; ++n) {
      const auto s = loop.next();
      ASSERT_TRUE(s.has_value());
      note(of_loop, loop.chain().particle(*s), loop.chain().particle(loop.chain().right(*s)));
      loop.collide(*s);
    }
    EXPECT_GT(run.counts().collisions, 500U);
    EXPECT_GT(run.counts().merges, 50U);
    EXPECT_EQ(of_run, of_loop);
  }
}

// In absolute positions, all particles moved from collision to collision and the next one found by looking at every
// pair; of a line, a ring so large that nothing comes round. With 50 digits neither side's rounding, 1e-50, shows
// within some 1e20 of amplification, which 500 collisions are far from; a wrong collision would be off by orders of the
// spacing.
TEST(WetTwins, GapsAndPositionsMakeTheSameCollisionsWithUnequalMasses) {
  using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
  for (const double loss : {.01, 0.1, 1.}) {
    SCOPED_TRACE(loss);
    std::vector<Wide> x, v, m;
    for (ParticleIndex i = 0; i < 60; ++i) {
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
      ASSERT_EQ(run.counts().collisions, twin.collisions) << t;
      ASSERT_EQ(run.counts().merges, twin.merges) << t;
      const auto c = run.configuration(Wide(t));
      const auto particles = twin.unfolded();
      ASSERT_EQ(c.from, 0);
      ASSERT_EQ(c.to, 59);
      ASSERT_EQ(c.x.size(), particles.size());
      for (std::size_t j = 0; j < particles.size(); ++j) {
        ASSERT_EQ(c.index[j], particles[j].index) << t;
        ASSERT_EQ(c.m[j], particles[j].m) << t;
        ASSERT_LE(abs(c.x[j] - particles[j].x), Wide(1e-30)) << t << ", particle " << c.index[j];
        ASSERT_LE(abs(c.v[j] - particles[j].v), Wide(1e-30)) << t << ", particle " << c.index[j];
      }
    }
    EXPECT_GT(run.counts().collisions, 60U);
    EXPECT_GT(run.counts().merges, 10U);
  }
}

}  // namespace wet_twins_test
