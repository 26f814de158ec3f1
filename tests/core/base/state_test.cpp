// The state of a run as a value: saved anywhere and loaded into a run of the same scene, it continues with the same
// bits. Truncated or contradictory states are refused, before memory is allocated for them. Well-formed ones with
// numbers that no run has, as in a damaged file with a correct checksum, are refused, or the run ends: all of these
// were found by fuzzing (tests/fuzz/targets.cpp), and wrote or read beyond a list, made collisions without end, or
// overflowed an integer.
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::state_test {

using Dry = Inelastic<double>;
template <class Chain, class Law> using Made = Simulation<double, Law, Chain>;
using MadeOfWet = Made<ClusterChain<double>, Wet<double>>;
using MadeOfSticky = Made<ClusterChain<double>, Sticky<double>>;

template <class X> X there_and_back(const X& x) {
  X y{};
  restore(y, x);
  return y;
}

TEST(State, NumbersComeBackAsTheyWere) {
  const double never = std::numeric_limits<double>::infinity();
  for (const double x : {0., -0., 1. / 3, 5e-324, -1e308, never, -never})
    EXPECT_EQ(std::bit_cast<std::uint64_t>(there_and_back(x)), std::bit_cast<std::uint64_t>(x)) << x;
  EXPECT_TRUE(there_and_back(std::numeric_limits<double>::quiet_NaN()) != there_and_back(0.));
  const long double x = 1.L / 3;
  EXPECT_EQ(there_and_back(x), x);
  EXPECT_EQ(there_and_back(1.f / 3), 1.f / 3);
  for (const std::int64_t n : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min(), std::int64_t{1} << 62})
    EXPECT_EQ(there_and_back(n), n);
  EXPECT_EQ(there_and_back(-7), -7);
  EXPECT_TRUE(there_and_back(true));
}

TEST(State, ListsComeBackAsTheyWere) {
  const std::map<int, std::pair<double, double>> map{{-3, {1, 2}}, {4, {3, 4}}};
  EXPECT_EQ(there_and_back(map), map);
  const std::optional<std::vector<double>> there{{1, 2, 3}}, none;
  EXPECT_EQ(there_and_back(there), there);
  EXPECT_EQ(there_and_back(none), none);
  std::unordered_map<std::int64_t, double> one, other;  // the same, filled in another order
  for (std::int64_t k = 0; k < 100; ++k) one[k] = 1, other[99 - k] = 1;
  EXPECT_TRUE(SavedState::of(one) == SavedState::of(other));
}

TEST(State, ListsLongerThanTheFileAreRefusedBeforeTheyAreMade) {
  SavedState state;
  save(state, std::uint64_t{1} << 60);
  std::vector<double> values;
  EXPECT_THROW(load(state, values), std::invalid_argument);
  EXPECT_LT(values.capacity(), 1000U);
}

// A run that is made anew takes the state of one that has advanced, at any of these times.
template <class Make, class... Segments>
void expect_always_taken(const Make& make, double step, int steps, Segments&&... segments) {
  auto run = make();
  for (int k = 1; k <= steps; ++k) {
    run.advance(step * k, segments...);
    auto later = make();
    EXPECT_NO_THROW(restore(later, run)) << run.last_collision_time();
  }
}

// As do runs of all kinds, in engine/same_bits_test.cpp.
TEST(State, OfAGasWithoutEventsIsContinuedWithTheSameBits) {
  expect_same_from_anywhere([] { return StickyGas<double>(uniform_rows(60), 0.); }, 3.7, 40,
                            [](const auto& later, const auto& whole) {
                              EXPECT_EQ(later.energy_lost(), whole.energy_lost());
                              EXPECT_EQ(later.last_collision_time(), whole.last_collision_time());
                            });
}

// After a collision by which cells are laid out anew, fewer than before, nothing points beyond them.
TEST(State, OfCellsLaidOutAnewIsTaken) {
  expect_always_taken([] { return MadeOfSticky({}, ClusterChain<double>(gaussian_ring(60, 60), 0.)); }, 5, 60);
}

// Every byte of a state changed: it is refused, or a run that can continue.
TEST(State, WhatDoesNotFitTogetherIsRefused) {
  const auto make = [] { return MadeOfWet(Wet<double>(0.01), ClusterChain<double>(gaussian_ring(12, 20), 0.)); };
  auto run = make();
  run.advance(3);
  const std::string bytes = SavedState::of(run).bytes();
  int refused = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x40);
    SavedState state(changed);
    auto later = make();
    refused += test::message_of([&] { load(state, later); }) != "nothing was refused";
  }
  EXPECT_GT(refused, 200) << "lengths, links, numbers of particles";
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    SavedState state(bytes.substr(0, size));
    auto later = make();
    EXPECT_THROW(load(state, later), std::invalid_argument) << size;
  }
}

// Slots beyond the gaps that are held keep what a time slab of segments has left there.
TEST(State, OfRowsThatWereRunInSegmentsIsTaken) {
  Segments<Dry, GapChain<double>> segments(Workers{});
  expect_always_taken([] { return gap_run(uniform_rows(4000, 0.05, 1), Dry(0.999, 1e-5)); }, 37.3, 30, segments);
}

// A chain with fewer slots than before takes over none that name those it had.
TEST(State, OfRingsThatWereRunInSegmentsIsTaken) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const auto count = static_cast<ParticleIndex>(600 + 37 * seed);
    const auto ring = gaussian_ring(count, static_cast<double>(count), seed);
    Segments<Sticky<double>, ClusterChain<double>> segments(Workers{}, {60, 8, 0, true});
    expect_always_taken([&] { return MadeOfSticky({}, ClusterChain<double>(ring, 0.)); }, 0.4, 120, segments);
  }
}

// In absolute positions a collision may be due beyond the range of the type.
TEST(State, WithCollisionsThatNeverComeIsTaken) {
  expect_always_taken([] { return position_run(list<double>({0, 1, 3}, {1e-310, 0, -1}), Dry(0.9)); }, 1, 1);
}

// ---- damaged states

template <class Run> class Contradicted {
 public:
  explicit Contradicted(std::function<Run()> make) : make_(std::move(make)) {}

  void loads() const {
    EXPECT_EQ(after([](Run&) {}), "nothing was refused");
  }
  // Loading refuses the state at t = 3 after a change of it.
  void cannot_be(const std::string& what, const std::function<void(Run&)>& change) const {
    EXPECT_EQ(after(change), "a state that cannot be (" + what + "): take the file from a copy");
  }

 private:
  std::string after(const std::function<void(Run&)>& change) const {
    Run run = make_();
    run.advance(3);
    change(run);
    Run later = make_();
    return test::message_of([&] { restore(later, run); });
  }
  std::function<Run()> make_;
};
constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

template <class Chain> Contradicted<Made<Chain, Dry>> dry(const Scene<double>& particles) {
  return Contradicted<Made<Chain, Dry>>([=] { return Made<Chain, Dry>(Dry(0.9, 1e-4), Chain(particles, 0.)); });
}
template <std::size_t k, class X> auto& field(X& x) {
  return X::state(x)([](auto&... each) -> auto& { return std::get<k>(std::tie(each...)); });
}

template <class Chain> void expect_gaps_refused(const Scene<double>& particles) {
  using Run = Made<Chain, Dry>;
  const auto loading = dry<Chain>(particles);
  const auto gap = [](Run& run, std::ptrdiff_t from_first) -> Gap<double>& {
    Chain& chain = field<0>(run);
    return field<0>(chain).gaps[static_cast<Slot>(static_cast<std::ptrdiff_t>(chain.first()) + from_first)];
  };
  loading.loads();
  for (const double wrong : {infinity, -infinity, nan, 1e200})
    loading.cannot_be("gaps", [&](Run& run) { gap(run, 1).closing = wrong; });
  for (const double wrong : {infinity, nan}) {
    loading.cannot_be("gaps", [&](Run& run) { gap(run, 1).gap = wrong; });
    loading.cannot_be("gaps", [&](Run& run) { gap(run, 1).time = wrong; });
    loading.cannot_be(
        "gaps", [&](Run& run) { field<1>(field<0>(field<0>(run)).gaps)[field<0>(run).first()] = wrong; });  // its lag
  }
  loading.cannot_be("gaps", [&](Run& run) { gap(run, 1).closing = 1, gap(run, 1).due = nan; });
  loading.cannot_be(
      "gaps", [&](Run& run) { gap(run, 1).closing = -1, gap(run, 1).due = 4; });  // a collision of a gap that opens
  loading.cannot_be("gaps", [&](Run& run) { gap(run, -1).closing = infinity; });  // beyond the ends
}

TEST(DamagedStates, GapsThatNoRunHasAreRefused) {
  expect_gaps_refused<GapChain<double>>(uniform_rows(60));
  expect_gaps_refused<GapChain<double>>(gaussian_ring(20, 20));
  const auto on_ring = dry<GapChain<double>>(gaussian_ring(20, 20));
  for (const ParticleIndex wrong :
       {std::numeric_limits<ParticleIndex>::max(), std::numeric_limits<ParticleIndex>::min()})
    on_ring.cannot_be("particles", [&](auto& run) { field<2>(field<0>(field<0>(run))) = wrong; });
  using Heavy = GapChain<double, IndividualMasses<double>>;
  expect_gaps_refused<Heavy>(uniform_rows(60));
  const auto loading = dry<Heavy>(uniform_rows(60));
  loading.cannot_be("gaps", [](auto& run) { field<0>(field<0>(run)).masses.set(field<0>(run).first(), 0); });
}

TEST(DamagedStates, GapsToAFloorThatNoRunHasAreRefused) {
  const auto loading = dry<GapChain<double>>(between(-1, list<double>({1, 2}, {0, 0}), Wall<double>{0, 0, 0.9}));
  loading.loads();
  const auto of_floor = [](auto& run) -> Gap<double>& { return field<0>(field<0>(run)).gaps[field<0>(run).first()]; };
  for (const double wrong : {infinity, nan}) {
    loading.cannot_be("gaps", [&](auto& run) { of_floor(run).gap = wrong; });
    loading.cannot_be("gaps", [&](auto& run) { of_floor(run).time = wrong; });
    loading.cannot_be("gaps", [&](auto& run) { of_floor(run).closing = wrong; });
  }
}

TEST(DamagedStates, FrontsThatNoRunHasAreRefused) {
  const auto range = [](GapRun<double>& run) -> HeldRange& { return field<1>(field<0>(run)); };
  dry<GapChain<double>>(gaussian_ring(20, 20)).cannot_be("seam", [&](auto& run) { field<3>(range(run)) = 0; });
  const auto without_collisions = dry<GapChain<double>>(uniform_rows(60));
  without_collisions.cannot_be("slots", [&](auto& run) { field<0>(range(run)) = HeldRange::Extent::nowhere; });
  dry<PositionChain<double>>(uniform_rows(60)).cannot_be("fronts", [](auto& run) { field<6>(field<0>(run)) = 0; });
}

TEST(DamagedStates, PositionsThatNoRunHasAreRefused) {
  const auto loading = dry<PositionChain<double>>(uniform_rows(60));
  loading.loads();
  for (const double wrong : {infinity, nan}) {
    loading.cannot_be("numbers", [&](auto& run) { field<0>(field<0>(run))[5].x = wrong; });
    loading.cannot_be("numbers", [&](auto& run) { field<2>(field<0>(run))[5] = wrong; });
    loading.cannot_be("numbers", [&](auto& run) { field<4>(field<0>(run)) = wrong; });  // the origin
  }
  loading.cannot_be("numbers", [](auto& run) { field<1>(field<0>(run))[5] = nan; });    // a collision
  loading.cannot_be("numbers", [](auto& run) { field<2>(field<0>(run)).back() = 1; });  // a gap beyond the end closes
}

void expect_cells_refused(const Scene<double>& particles, bool on_ring) {
  using Run = MadeOfWet;
  const Contradicted<Run> loading([&] { return Run(Wet<double>(0.01), ClusterChain<double>(particles, 0.)); });
  const auto cell = [](Run& run, Slot s) -> Cell<double>& { return field<0>(field<0>(run)).gaps[s]; };
  loading.loads();
  for (const double wrong : {infinity, nan, 1e200})
    loading.cannot_be("numbers", [&](Run& run) { cell(run, field<0>(run).first()).velocity = wrong; });
  for (const double wrong : {infinity, 1e200})
    loading.cannot_be("numbers", [&](Run& run) { cell(run, field<0>(run).first()).mass = wrong; });
  loading.cannot_be("numbers", [&](Run& run) { cell(run, field<0>(run).first()).gap = nan; });
  if (on_ring) return;
  loading.cannot_be("numbers",
                    [&](Run& run) { cell(run, field<0>(run).last()).due = 4; });  // the last one meets what runs away
  for (const bool left : {true, false})
    loading.cannot_be("ends", [&](Run& run) {
      const auto& chain = field<0>(run);
      cell(run, left ? chain.first() - 1 : chain.right(chain.last())).velocity = left ? 1 : -1;
    });  // what is beyond the ends comes back
}

TEST(DamagedStates, CellsThatNoRunHasAreRefused) {
  expect_cells_refused(uniform_rows(60), false);
  expect_cells_refused(gaussian_ring(12, 20), true);
}

TEST(DamagedStates, ClustersThatNoGasHasAreRefused) {
  const Contradicted<StickyGas<double>> loading([] { return StickyGas<double>(gaussian_ring(20, 20), 0.); });
  const auto lump = [](StickyGas<double> & gas) -> auto& { return field<2>(gas).front(); };
  loading.loads();
  for (const double wrong : {infinity, nan}) {
    loading.cannot_be("clusters", [&](auto& gas) { lump(gas).mass = wrong; });
    loading.cannot_be("clusters", [&](auto& gas) { lump(gas).momentum = wrong; });
  }
  loading.cannot_be("clusters", [&](auto& gas) { lump(gas).heaviest = 20; });
  loading.cannot_be("clusters", [&](auto& gas) { --lump(gas).count; });  // or none at all
  loading.cannot_be("clusters", [&](auto& gas) { ++lump(gas).count; });
}

TEST(DamagedStates, ReviewsThatNeverComeAreRefused) {
  const auto loading = dry<GapChain<double>>(gaussian_ring(20, 20));
  constexpr std::uint64_t late = std::uint64_t{1} << 60;
  loading.cannot_be("pacing", [](auto& run) { field<3>(run).next_review = late; });
  loading.cannot_be("pacing", [](auto& run) { field<3>(run).next_poll = late; });
  loading.cannot_be("pacing", [](auto& run) { field<3>(run).most_collisions = late; });
  // Times a number of epochs they are no integer.
  loading.cannot_be("pacing", [](auto& run) { field<2>(run).collisions = 2 * late; });
}

// A run continues from what loading cannot detect: found by fuzzing, collisions by which times overflow. They have an
// end, too.
TEST(DamagedStates, TimesThatOverflowEnd) {
  const auto make = [] { return gap_run(gaussian_ring(8, 8), Dry(0.9, 1e-3)); };
  auto run = make();
  run.advance(2);
  auto& gaps = field<0>(field<0>(run)).gaps;
  const double numbers[8][4] = {{1.8670852680901024, 1.2509978903764583, 8.901762437645102e-251, 1.4380232701152638},
                                {1.0233816504478455, -0.6045255516373196, infinity, -0.09485704451799393},
                                {0.937020517885685, -0.6045255516373196, 1.4381992051309456, 0.45871109887957573},
                                {2.6101237945286715, 0.11182234534491202, -0.48024760875145933, 0.369071316167683},
                                {-1.6856164219547206e+271, 1.048784346809129, infinity, -0.36829824337880246},
                                {0, 3.051758010115644e-05, 0, 8.0752048597e-313},
                                {-5.486124068793689e+303, 3.466673899897024e-33, 3.7695368897063176e-308, 3.4e-310},
                                {0, -2.807752719446802e+154, -6.297766697450243e-53, 6.212997e-317}};
  Slot s = field<0>(run).first();
  for (const auto& [gap, time, due, closing] : numbers) {
    gaps[s].gap = gap, gaps[s].time = time, gaps[s].due = due, gaps[s].closing = closing;
    ++s;
  }
  auto later = make();
  restore(later, run);
  EXPECT_EQ(later.advance(5), Status::reached);
}

TEST(DamagedStates, PlacesBeyondAllTurnsStayWhereTheyAre) {
  for (const double place : {1e30, -1e300, nan, infinity}) {
    Configuration<double> c;
    c.x = {place, place};
    fold(c, 8.);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(c.x[0]), std::bit_cast<std::uint64_t>(place));
  }
}

}  // namespace cradle::test::state_test
