// Every way of holding the same bodies, one against the other. Proves: gaps and absolute positions make the same
// contacts, and so does a loop without a queue; a chain that streams its rows in and one that holds them all have the
// same bits, as have runs whose output is read once, ten times or ten thousand times, with and without an observer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/slow_loop.hpp"

namespace twins_test {

using namespace cradle;
using namespace cradle::test;

// With rows of speed 1/2 collapse sets in at t = 2/(1 - (4/pi) atan sqrt eps).
const Inelastic<double> law(.98, 1e-5);    // t = 311
const Inelastic<double> softer(.9, 1e-3);  // t = 60

// Rows that differ in density and speed, with a heavy body between them.
Scene<double> unequal_rows() {
  return std::make_shared<Rows<double>>(Row<double>{160, .75, .5}, Row<double>{240, -.25, 1.5},
                                        CentralBody<double>{20, .125}, rshock_displacement);
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return INFINITY;
  double largest = 0;
  for (std::size_t j = 0; j < a.size(); ++j) largest = std::max(largest, std::abs(a[j] - b[j]));
  return largest;
}

// Runs both to each time in turn: same contacts in the same order, same state to rounding.
template <class First, class Second>
void expect_same_contacts(First first, Second second, double step, double end, double tolerance,
                          std::uint64_t least_contacts) {
  Sequence of_first, of_second;
  for (double t = step; t <= end; t += step) {
    ASSERT_EQ(first.advance(t, [&](const Contact<double>& c) { of_first.add(c.left); }), Status::reached);
    ASSERT_EQ(second.advance(t, [&](const Contact<double>& c) { of_second.add(c.left); }), Status::reached);
    ASSERT_TRUE(same_contacts(first.counts(), second.counts())) << "t = " << t;
    ASSERT_TRUE(of_first == of_second) << "t = " << t;
    const auto a = configuration_at(first, t), b = configuration_at(second, t);
    ASSERT_LE(largest_difference(a.x, b.x), tolerance) << "t = " << t;
    ASSERT_LE(largest_difference(a.v, b.v), tolerance / end) << "t = " << t;
    ASSERT_LE(largest_difference(a.gap, b.gap), tolerance) << "t = " << t;
  }
  EXPECT_GT(first.counts().contacts, least_contacts);
  EXPECT_EQ(first.chain().account().order_lost, 0U);
  EXPECT_EQ(second.chain().account().unresolved, 0U) << "positions no longer tell which contact comes first";
}

template <class First, class Second>
void expect_identical(First& first, Second& second, const std::vector<double>& times) {
  for (const double t : times) {
    ASSERT_EQ(first.advance(t), Status::reached);
    ASSERT_EQ(second.advance(t), Status::reached);
    ASSERT_TRUE(identical(first.counts(), second.counts())) << "t = " << t;
    ASSERT_EQ(first.energy_lost(), second.energy_lost()) << "t = " << t;
    ASSERT_TRUE(identical(configuration_at(first, t), configuration_at(second, t))) << "t = " << t;
    const double local = first.chain().local_time(t);
    ASSERT_EQ(local, second.chain().local_time(t));
    if (first.chain().collided_bodies() == 0) continue;
    ASSERT_EQ(first.chain().front_left(local), second.chain().front_left(local)) << "t = " << t;
    ASSERT_EQ(first.chain().front_right(local), second.chain().front_right(local)) << "t = " << t;
  }
}

std::vector<double> times(double step, double end) {
  std::vector<double> all;
  for (double t = step; t <= end; t += step) all.push_back(t);
  return all;
}

// A body makes up to 400 contacts. In positions each rounds the place (|x| < 256, so by 2^-46 at most in every one of
// two operations) and the velocity, by some 2^-53 that then acts for 250 units of time: 400 (2 * 1.4e-14 + 250 *
// 2.2e-16) < 4e-11 if all roundings had the same sign.
TEST(Twins, GapsAndPositionsMakeTheSameContacts) {
  const auto bodies = rshock<double>(400);
  expect_same_contacts(gap_run(bodies, law), position_run(bodies, law), 10, 250, 4e-11, 20000);
}

TEST(Twins, GapsAndPositionsMakeTheSameContactsWithUnequalRowsAndACentralMass) {
  const auto bodies = unequal_rows();
  expect_same_contacts(mass_run(bodies, law), position_run(bodies, law), 10, 170, 4e-11, 15000);
}

TEST(Twins, GapsAndPositionsMakeTheSameContactsInAMixedGas) {
  const auto bodies = rmix<double>(300);
  expect_same_contacts(gap_run(bodies, Inelastic<double>(.98, 1e-5)),
                       position_run(bodies, Inelastic<double>(.98, 1e-5)), 5, 100, 4e-11, 5000);
}

TEST(Twins, QueueAndPlainSearchMakeTheSameContacts) {
  const auto bodies = rshock<double>(400);
  auto run = gap_run(bodies, law);
  Sequence of_run, of_loop;
  run.advance(150, [&](const Contact<double>& c) { of_run.add(c.left); });
  SlowLoop loop(law, GapChain<double>(bodies, 0, true));
  for (std::uint64_t n = 0; n < run.counts().contacts; ++n) {
    const auto s = loop.next();
    ASSERT_TRUE(s.has_value());
    of_loop.add(loop.collide(*s).body);
  }
  EXPECT_TRUE(of_run == of_loop);
}

TEST(Twins, StreamedAndHeldRowsHaveTheSameBits) {
  const auto bodies = rshock<double>(200);
  auto streamed = gap_run(bodies, softer);
  auto held = gap_run(bodies, softer, {}, 0., {.hold_all = true});
  // Beyond the collapse, and beyond the ends of the rows.
  expect_identical(streamed, held, times(2.5, 250));
  EXPECT_EQ(streamed.chain().collided_bodies(), 200);
  EXPECT_GT(streamed.counts().below_cutoff, 0U);
}

TEST(Twins, RowsAndTheSameBodiesInAListHaveTheSameBits) {
  const auto rows = rshock<double>(200);
  auto streamed = gap_run(rows, softer);
  auto listed = gap_run(as_list(*rows), softer);
  expect_identical(streamed, listed, times(2.5, 100));
}

TEST(Twins, StreamedAndHeldUnequalRowsHaveTheSameBits) {
  const auto bodies = unequal_rows();
  auto streamed = mass_run(bodies, law);
  auto held = mass_run(bodies, law, {}, 0., {.hold_all = true});
  expect_identical(streamed, held, times(12.5, 500));
  EXPECT_GT(streamed.chain().collided_bodies(), 300);
}

TEST(Twins, OutputCadenceDoesNotChangeABit) {
  const auto bodies = rshock<double>(200);
  const double end = 100;
  auto once = gap_run(bodies, softer);
  ASSERT_EQ(once.advance(end), Status::reached);
  for (const int outputs : {10, 10000}) {
    auto often = gap_run(bodies, softer);
    for (int k = 1; k <= outputs; ++k) {
      const double t = end * k / outputs;
      ASSERT_EQ(often.advance(t), Status::reached);
      if (k % 100 == 0) configuration_at(often, t);
    }
    EXPECT_TRUE(identical(configuration_at(once, end), configuration_at(often, end))) << outputs;
    EXPECT_TRUE(same_contacts(once.counts(), often.counts())) << outputs;
    EXPECT_EQ(once.counts().origin_moves, often.counts().origin_moves) << outputs;
    EXPECT_EQ(once.energy_lost(), often.energy_lost()) << outputs;
  }
}

TEST(Twins, OutputAtTheVeryTimeOfAContactDoesNotChangeABit) {
  const auto bodies = rmix<double>(32);
  const Inelastic<double> soft(.9375, 0);
  std::vector<double> contact_times;
  auto once = gap_run(bodies, soft);
  once.advance(100, [&](const Contact<double>& c) { contact_times.push_back(c.time.value()); });
  ASSERT_GT(contact_times.size(), 100U);
  auto often = gap_run(bodies, soft);
  for (const double t : contact_times) ASSERT_EQ(often.advance(t), Status::reached);
  often.advance(100);
  EXPECT_TRUE(identical(configuration_at(once, 100.), configuration_at(often, 100.)));
}

// Rows displaced by a few 2^-28, so that contacts all along the line are nearly simultaneous, and keys too wide to tell
// which comes first: output between them must not change what the run makes of them.
TEST(Twins, OutputBetweenNearlySimultaneousContactsDoesNotChangeABit) {
  for (const BodyIndex particles : {100, 200, 300}) {
    for (BodyIndex seed = 0; seed < 20; ++seed) {
      const Scene<double> bodies = std::make_shared<Rows<double>>(symmetric_rows<double>(
          particles, .5, 1, [seed](BodyIndex body) { return bits_of(body + 1000 * seed, 0, 0xF) - 8; }));
      const double end = .75 * static_cast<double>(particles);
      std::vector<double> contact_times;
      auto once = gap_run(bodies, law, {}, 0., {.least_queue_bits = 18});
      once.advance(end, [&](const Contact<double>& c) { contact_times.push_back(c.time.value()); });
      auto often = gap_run(bodies, law, {}, 0., {.least_queue_bits = 18});
      for (const double t : contact_times) ASSERT_EQ(often.advance(t), Status::reached);
      often.advance(end);
      EXPECT_TRUE(identical(configuration_at(once, end), configuration_at(often, end)))
          << particles << " bodies, seed " << seed;
    }
  }
}

TEST(Twins, ObserverDoesNotChangeABit) {
  const auto bodies = rshock<double>(400);
  auto plain = gap_run(bodies, law);
  auto observed = gap_run(bodies, law);
  std::uint64_t seen = 0;
  observed.advance(200, [&](const Contact<double>& c) { seen += c.closing_speed > 0; });
  plain.advance(200);
  EXPECT_EQ(seen, observed.counts().contacts);
  expect_identical(plain, observed, {200});
}

TEST(Twins, StepsOfSeveralRunsSideBySideDoNotChangeABit) {
  constexpr double end = 150;
  std::vector<GapRun<double>> in_turn, side_by_side;
  for (const BodyIndex particles : {200, 300}) {
    in_turn.push_back(gap_run(rshock<double>(particles), softer));
    side_by_side.push_back(gap_run(rshock<double>(particles), softer));
    ASSERT_EQ(in_turn.back().advance(end), Status::reached);
  }
  for (auto& run : side_by_side) run.head_for(end);
  for (bool going[2] = {true, true}; going[0] || going[1];)
    for (std::size_t k : {0U, 1U}) going[k] = going[k] && side_by_side[k].step();
  for (std::size_t k : {0U, 1U}) {
    EXPECT_EQ(side_by_side[k].status(), Status::reached);
    EXPECT_TRUE(identical(configuration_at(in_turn[k], end), configuration_at(side_by_side[k], end)));
    EXPECT_TRUE(identical(in_turn[k].counts(), side_by_side[k].counts()));
  }
}

}  // namespace twins_test
