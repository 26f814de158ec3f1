// Well-formed states with numbers that no run has, as in a damaged file with a correct checksum: they are refused, or
// the run ends. All were found by fuzzing (tests/fuzz/checkpoint.cpp): they wrote or read beyond a list, made
// collisions without end, or overflowed an integer.
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::damaged_states_test {

using Dry = Inelastic<double>;

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

template <class Chain, class Law> using Made = Simulation<double, Law, Chain>;
template <class Chain> Contradicted<Made<Chain, Dry>> dry(const Scene<double>& particles) {
  return Contradicted<Made<Chain, Dry>>([=] { return Made<Chain, Dry>(Dry(0.9, 1e-4), Chain(particles, 0.)); });
}
template <std::size_t k, class X> auto& field(X& x) { return std::get<k>(X::state(x)); }

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

template <class Make> void expect_cells_refused(const Make& make, bool on_ring) {
  using Chain = ClusterChain<double>;
  using Run = Made<Chain, Wet<double>>;
  const Contradicted<Run> loading(make);
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
      const Chain& chain = field<0>(run);
      cell(run, left ? chain.first() - 1 : chain.right(chain.last())).velocity = left ? 1 : -1;
    });  // what is beyond the ends comes back
}

TEST(DamagedStates, CellsThatNoRunHasAreRefused) {
  using Run = Made<ClusterChain<double>, Wet<double>>;
  expect_cells_refused([] { return Run(Wet<double>(0.01), ClusterChain<double>(uniform_rows(60), 0.)); }, false);
  expect_cells_refused([] { return Run(Wet<double>(0.01), ClusterChain<double>(gaussian_ring(12, 20), 0.)); }, true);
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

}  // namespace cradle::test::damaged_states_test
