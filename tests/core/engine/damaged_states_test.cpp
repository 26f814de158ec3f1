// States that are well formed and whose numbers no run has, as a file can have them behind a checksum that is right:
// they are refused, or the run ends. All were found by fuzzing (tests/fuzz/checkpoint.cpp): they wrote or read beyond a
// list, made collisions without end, or overflowed an integer.
#include <bit>
#include <functional>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/engine/state.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace damaged_states_test {

using namespace cradle;
using cradle::test::gaussian_ring;
using cradle::test::uniform_rows;
using Dry = Inelastic<double>;

template <class Run> class Contradicted {
 public:
  explicit Contradicted(std::function<Run()> make) : make_(std::move(make)) {}

  // What loading says of the state at t = 3 after a change of it.
  std::string by(const std::function<void(Run&)>& change) const {
    Run run = make_();
    run.advance(3);
    change(run);
    SavedState state = SavedState::of(run);
    Run later = make_();
    try {
      load(state, later);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "loaded";
  }

 private:
  std::function<Run()> make_;
};
std::string cannot_be(const std::string& what) {
  return "a state that cannot be (" + what + "): take the file from a copy";
}
constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

template <class Chain, class Law> using Made = Simulation<double, Law, Chain>;
template <std::size_t k, class X> auto& field(X& x) { return std::get<k>(X::state(x)); }

template <class Chain> void expect_gaps_refused(const std::shared_ptr<const Particles<double>>& particles) {
  using Run = Made<Chain, Dry>;
  const Contradicted<Run> loading([=] { return Run(Dry(0.9, 1e-4), Chain(particles, 0.)); });
  const auto gap = [](Run& run, std::ptrdiff_t from_first) -> Gap<double>& {
    Chain& chain = field<0>(run);
    return field<0>(chain).gaps[static_cast<Slot>(static_cast<std::ptrdiff_t>(chain.first()) + from_first)];
  };
  EXPECT_EQ(loading.by([](Run&) {}), "loaded");
  for (const double wrong : {infinity, -infinity, nan, 1e200})
    EXPECT_EQ(loading.by([&](Run& run) { gap(run, 1).closing = wrong; }), cannot_be("gaps")) << wrong;
  for (const double wrong : {infinity, nan}) {
    EXPECT_EQ(loading.by([&](Run& run) { gap(run, 1).gap = wrong; }), cannot_be("gaps"));
    EXPECT_EQ(loading.by([&](Run& run) { gap(run, 1).time = wrong; }), cannot_be("gaps"));
    EXPECT_EQ(loading.by([&](Run& run) { field<1>(field<0>(field<0>(run)).gaps)[field<0>(run).first()] = wrong; }),
              cannot_be("gaps"))
        << "its lag";
  }
  EXPECT_EQ(loading.by([&](Run& run) { gap(run, 1).closing = 1, gap(run, 1).due = nan; }), cannot_be("gaps"));
  EXPECT_EQ(loading.by([&](Run& run) { gap(run, 1).closing = -1, gap(run, 1).due = 4; }), cannot_be("gaps"))
      << "a collision of a gap that opens";
  EXPECT_EQ(loading.by([&](Run& run) { gap(run, -1).closing = infinity; }), cannot_be("gaps")) << "beyond the ends";
}

TEST(DamagedStates, GapsThatNoRunHasAreRefused) {
  expect_gaps_refused<GapChain<double>>(uniform_rows(60));
  expect_gaps_refused<GapChain<double>>(gaussian_ring(20, 20));
  const Contradicted<Made<GapChain<double>, Dry>> on_ring(
      [] { return Made<GapChain<double>, Dry>(Dry(0.9, 1e-4), GapChain<double>(gaussian_ring(20, 20), 0.)); });
  for (const ParticleIndex wrong :
       {std::numeric_limits<ParticleIndex>::max(), std::numeric_limits<ParticleIndex>::min()})
    EXPECT_EQ(on_ring.by([&](auto& run) { field<2>(field<0>(field<0>(run))) = wrong; }), cannot_be("particles"));
  using Heavy = GapChain<double, IndividualMasses<double>>;
  expect_gaps_refused<Heavy>(uniform_rows(60));
  const Contradicted<Made<Heavy, Dry>> loading(
      [] { return Made<Heavy, Dry>(Dry(0.9, 1e-4), Heavy(uniform_rows(60), 0.)); });
  EXPECT_EQ(loading.by([](auto& run) { field<0>(field<0>(run)).masses.set(field<0>(run).first(), 0); }),
            cannot_be("gaps"));
}

TEST(DamagedStates, FrontsThatNoRunHasAreRefused) {
  using Run = Made<GapChain<double>, Dry>;
  const auto range = [](Run& run) -> HeldRange& { return field<1>(field<0>(run)); };
  const Contradicted<Run> on_ring([] { return Run(Dry(0.9, 1e-4), GapChain<double>(gaussian_ring(20, 20), 0.)); });
  EXPECT_EQ(on_ring.by([&](Run& run) { field<3>(range(run)) = 0; }), cannot_be("seam"));
  const Contradicted<Run> on_line([] { return Run(Dry(0.9, 1e-4), GapChain<double>(uniform_rows(60), 0.)); });
  EXPECT_EQ(on_line.by([&](Run& run) { field<0>(range(run)) = HeldRange::Extent::nowhere; }), cannot_be("slots"))
      << "fronts without collisions";
  using Positions = Made<PositionChain<double>, Dry>;
  const Contradicted<Positions> positions(
      [] { return Positions(Dry(0.9, 1e-4), PositionChain<double>(uniform_rows(60), 0.)); });
  EXPECT_EQ(positions.by([](Positions& run) { field<6>(field<0>(run)) = 0; }), cannot_be("fronts"));
}

TEST(DamagedStates, PositionsThatNoRunHasAreRefused) {
  using Run = Made<PositionChain<double>, Dry>;
  const Contradicted<Run> loading([] { return Run(Dry(0.9, 1e-4), PositionChain<double>(uniform_rows(60), 0.)); });
  EXPECT_EQ(loading.by([](Run&) {}), "loaded");
  for (const double wrong : {infinity, nan}) {
    EXPECT_EQ(loading.by([&](Run& run) { field<0>(field<0>(run))[5].x = wrong; }), cannot_be("numbers"));
    EXPECT_EQ(loading.by([&](Run& run) { field<2>(field<0>(run))[5] = wrong; }), cannot_be("numbers"));
    EXPECT_EQ(loading.by([&](Run& run) { field<4>(field<0>(run)) = wrong; }), cannot_be("numbers")) << "the origin";
  }
  EXPECT_EQ(loading.by([](Run& run) { field<1>(field<0>(run))[5] = nan; }), cannot_be("numbers")) << "a collision";
  EXPECT_EQ(loading.by([](Run& run) { field<2>(field<0>(run)).back() = 1; }), cannot_be("numbers"))
      << "a gap beyond the end closes";
}

template <class Make> void expect_cells_refused(const Make& make, bool on_ring) {
  using Chain = ClusterChain<double>;
  using Run = Made<Chain, Wet<double>>;
  const Contradicted<Run> loading(make);
  const auto cell = [](Run& run, Slot s) -> Cell<double>& { return field<0>(field<0>(run)).gaps[s]; };
  EXPECT_EQ(loading.by([](Run&) {}), "loaded");
  for (const double wrong : {infinity, nan, 1e200})
    EXPECT_EQ(loading.by([&](Run& run) { cell(run, field<0>(run).first()).velocity = wrong; }), cannot_be("numbers"));
  for (const double wrong : {infinity, 1e200})
    EXPECT_EQ(loading.by([&](Run& run) { cell(run, field<0>(run).first()).mass = wrong; }), cannot_be("numbers"));
  EXPECT_EQ(loading.by([&](Run& run) { cell(run, field<0>(run).first()).gap = nan; }), cannot_be("numbers"));
  if (on_ring) return;
  EXPECT_EQ(loading.by([&](Run& run) { cell(run, field<0>(run).last()).due = 4; }), cannot_be("numbers"))
      << "the last one meets what runs away";
  for (const bool left : {true, false})
    EXPECT_EQ(loading.by([&](Run& run) {
      const Chain& chain = field<0>(run);
      cell(run, left ? chain.first() - 1 : chain.right(chain.last())).velocity = left ? 1 : -1;
    }),
              cannot_be("ends"))
        << "what is beyond the ends comes back";
}

TEST(DamagedStates, CellsThatNoRunHasAreRefused) {
  using Run = Made<ClusterChain<double>, Wet<double>>;
  expect_cells_refused([] { return Run(Wet<double>(0.01), ClusterChain<double>(uniform_rows(60), 0.)); }, false);
  expect_cells_refused([] { return Run(Wet<double>(0.01), ClusterChain<double>(gaussian_ring(12, 20), 0.)); }, true);
}

TEST(DamagedStates, ClustersThatNoGasHasAreRefused) {
  const Contradicted<StickyGas<double>> loading([] { return StickyGas<double>(gaussian_ring(20, 20), 0.); });
  const auto lump = [](StickyGas<double> & gas) -> auto& { return field<2>(gas).front(); };
  EXPECT_EQ(loading.by([](StickyGas<double>&) {}), "loaded");
  for (const double wrong : {infinity, nan}) {
    EXPECT_EQ(loading.by([&](auto& gas) { lump(gas).mass = wrong; }), cannot_be("clusters"));
    EXPECT_EQ(loading.by([&](auto& gas) { lump(gas).momentum = wrong; }), cannot_be("clusters"));
  }
  EXPECT_EQ(loading.by([&](auto& gas) { lump(gas).heaviest = 20; }), cannot_be("clusters"));
  EXPECT_EQ(loading.by([&](auto& gas) { --lump(gas).count; }), cannot_be("clusters")) << "or none at all";
  EXPECT_EQ(loading.by([&](auto& gas) { ++lump(gas).count; }), cannot_be("clusters"));
}

TEST(DamagedStates, ReviewsThatNeverComeAreRefused) {
  using Run = Made<GapChain<double>, Dry>;
  const Contradicted<Run> loading([] { return Run(Dry(0.9, 1e-4), GapChain<double>(gaussian_ring(20, 20), 0.)); });
  EXPECT_EQ(loading.by([](Run& run) { field<3>(run).next_review = std::uint64_t{1} << 60; }), cannot_be("pacing"));
  EXPECT_EQ(loading.by([](Run& run) { field<3>(run).next_poll = std::uint64_t{1} << 60; }), cannot_be("pacing"));
  EXPECT_EQ(loading.by([](Run& run) { field<3>(run).most_collisions = std::uint64_t{1} << 60; }), cannot_be("pacing"));
  EXPECT_EQ(loading.by([](Run& run) { field<2>(run).collisions = std::uint64_t{1} << 61; }), cannot_be("pacing"))
      << "times a number of epochs they are no integer";
}

// A run continues from what loading cannot detect: found by fuzzing, collisions by which times overflow. They have an
// end, too.
TEST(DamagedStates, TimesThatOverflowEnd) {
  using Run = Made<GapChain<double>, Dry>;
  const auto make = [] {
    const auto particles =
        std::make_shared<Ring<double>>(8, 8., 1., gaussian_velocity(3, 0), uniform_displacement(0.05, 3, 0));
    return Run(Dry(0.9, 1e-3), GapChain<double>(particles, 0.));
  };
  Run run = make();
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
  SavedState state = SavedState::of(run);
  Run later = make();
  load(state, later);
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

}  // namespace damaged_states_test
