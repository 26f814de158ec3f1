// The engine against a gas that shares no code with it (reference_gas.hpp), in scenes drawn at random: every law, in
// every chain that follows it, on lines, on rings, between walls that may be shaken, under gravity and at rest on
// floors. Proves: collisions, their times, mergers, places, velocities, masses, gaps, energies, accounts of walls and
// fronts are those of the gas, nothing is missing where gaps are added up, and no order is lost: exactly in rationals,
// ties included; with laws and falls that take roots to 1e-80 in 100 digits. In double and in long double the engine
// makes the same collisions, and its errors are those that the gas itself has in these types, up to a factor of 3.
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/precision/drawn_scenes.hpp"

namespace cradle::test::exact_gas_test {

using namespace cradle::test::drawn;

// Every fourth scene has one particle or two: on a ring they meet themselves, or each other on both sides.
template <Drawn (*draw_many)(std::uint64_t)> Drawn draw_few_too(std::uint64_t number) {
  Drawn d = draw_many(number);
  if (number % 4 > 0) return d;
  const std::size_t few = 1 + number / 4 % 2;
  d.gaps.resize(few), d.velocities.resize(few), d.masses.resize(few);
  return d;
}

// Every tenth scene has all particles meet in one point, at t = 1.
Drawn draw_sticky_too(std::uint64_t number) {
  Drawn d = draw_few_too<draw_by<GasLaw::sticky>>(number);
  int place = 0;
  for (std::size_t b = 0; b < d.gaps.size() && number % 10 == 0; place += d.gaps[b++]) d.velocities[b] = 192 - place;
  return d;
}

const Family families[] = {
    {"Inelastic", draw_few_too<draw>, 200, {{"runs", 300}, {"collisions", 1000}, {"below cut-off", 50}}},
    {"WithAContactTime",
     draw_few_too<draw_by<GasLaw::contact_time>>,
     200,
     {{"runs", 300}, {"collisions", 1000}, {"below cut-off", 100}}},
    {"WithWalls", draw_few_too<draw_with_walls>, 200, {{"runs", 300}, {"collisions", 1500}, {"walls", 800}}},
    {"Sticky", draw_sticky_too, 300, {{"runs", 250}, {"collisions", 500}, {"merges", 500}}},
    {"Merging", draw_few_too<draw_by<GasLaw::merging>>, 300, {{"runs", 250}, {"collisions", 500}, {"merges", 120}}},
    {"Wet", draw_few_too<draw_wet>, 300, {{"runs", 250}, {"collisions", 500}, {"merges", 100}}},
    {"SpeedDependent", draw_few_too<draw_speed_dependent>, 100, {{"runs", 100}, {"collisions", 500}}},
    {"Falling", draw_falling, 200, {{"runs", 300}, {"collisions", 1000}, {"below cut-off", 10}, {"walls", 500}}},
    {"FallingWithAContactTime",
     draw_by<GasLaw::contact_time, draw_falling>,
     100,
     {{"runs", 150}, {"collisions", 500}, {"below cut-off", 50}, {"walls", 250}}},
    {"BetweenShakenWalls",
     draw_shaken,
     200,
     {{"runs", 300}, {"collisions", 1000}, {"below cut-off", 10}, {"walls", 500}}},
    {"Resting",
     draw_resting,
     200,
     {{"runs", 150}, {"collisions", 1000}, {"walls", 500}, {"rested", 300}, {"let go", 40}}},
};

// f(run) with a run in each chain that holds all of the scene, and in the gas without events.
template <class T, class F> void for_each_run(const Drawn& d, F f) {
  const auto particles = particles_of<T>(d);
  with_law<T>(d, [&]<class Law>(const Law& law) {
    if constexpr (Law::bounces_only) {
      f(Simulation(law, GapChain<T, IndividualMasses<T>>(particles, T(0), true)));
      if (particles->identical_masses() && !particles->fall()) f(Simulation(law, GapChain<T>(particles, T(0), true)));
      if (!particles->on_ring() && !particles->holding()) f(Simulation(law, PositionChain<T>(particles, T(0))));
    } else {
      f(Simulation(law, ClusterChain<T>(particles, T(0), true)));
      if constexpr (std::same_as<Law, Sticky<T>>) f(StickyGas<T>(particles, T(0)));
    }
  });
}

// Who is where, on a ring from the first particle right of 0.
template <class T> struct State {
  std::vector<ParticleIndex> index;
  std::vector<T> numbers;  // places, velocities, masses
};
// Of these particles: configurations leave out those that no front has reached.
template <class T> State<T> state_of(const Gas<T>& gas, ParticleIndex from, ParticleIndex to) {
  std::vector<std::pair<T, const typename Gas<T>::Cell*>> cells;
  for (const auto& cell : gas.cells) {
    if (cell.particles.front() < from || cell.particles.front() > to) continue;
    T x = gas.place(cell);
    while (gas.length > 0 && x < 0) x += gas.length;
    while (gas.length > 0 && x >= gas.length) x -= gas.length;
    cells.emplace_back(x, &cell);
  }
  if (gas.length > 0) std::ranges::sort(cells, {}, [](const auto& cell) { return cell.first; });
  State<T> state;
  for (const auto& [x, cell] : cells) {
    state.index.push_back(cell->particles.front());
    state.numbers.insert(state.numbers.end(), {x, gas.velocity(*cell), cell->m});
  }
  return state;
}
template <class T> State<T> state_of(const Configuration<T>& c) {
  State<T> state{c.index, {}};
  for (std::size_t j = 0; j < c.x.size(); ++j) state.numbers.insert(state.numbers.end(), {c.x[j], c.v[j], c.m[j]});
  return state;
}
template <class Wide, class T> Wide difference(const State<T>& state, const State<Wide>& exact) {
  EXPECT_EQ(state.index, exact.index);
  return largest_difference(std::vector<Wide>(state.numbers.begin(), state.numbers.end()), exact.numbers);
}

template <class T> void expect_same(const T& found, const T& wanted) {
  if constexpr (std::same_as<T, Rational>)
    EXPECT_EQ(found, wanted);
  else
    EXPECT_LE(magnitude(T(found - wanted)), T(1e-80));
}

template <class Run> constexpr bool has_events = !std::same_as<Run, StickyGas<typename Run::Scalar>>;

// The largest difference of a place, a velocity or a mass.
template <class Run, class T, class Exact> Exact off(const Run& run, const T& time, const Gas<Exact>& gas) {
  const auto c = run.configuration(time);
  auto found = state_of(c);
  const auto wanted = state_of(gas, c.from, c.to);
  if (!has_events<Run>) found.index = wanted.index;  // where more than two have merged it names another one
  return difference(found, wanted);
}

template <class T, class Run> void expect_as_gas(Run& run, const Gas<T>& gas, const Particles<T>& particles) {
  EXPECT_EQ(run.counts().collisions, gas.collisions);
  EXPECT_EQ(run.counts().merges, gas.merges);
  const auto c = run.configuration(gas.time);
  expect_same(off(run, gas.time, gas), T(0));
  ASSERT_EQ(c.gap.size(), c.x.size() - (run.on_ring() ? 0 : 1));
  for (std::size_t k = 0; k < c.gap.size(); ++k) {
    EXPECT_GE(c.gap[k], T(0));
    expect_same(c.gap[k], T((k + 1 < c.x.size() ? c.x[k + 1] : T(c.x[0] + gas.length)) - c.x[k]));
  }
  expect_same(T(c.closure_gap.value_or(T(0))), T(0));
  expect_same(T(c.closure_speed.value_or(T(0))), T(0));
  const auto now = sample(run, particles.kinetic_energy(), gas.time);
  expect_same(now.energy, gas.energy());
  expect_same(T(particles.mechanical_energy() - now.energy_lost + now.given),
              T(now.energy + potential_energy(c, particles, gas.time)));
  for (const std::size_t side : {0U, 1U}) {
    if (!gas.walls[side]) continue;
    EXPECT_EQ(now.walls[side].collisions, gas.walls[side]->collisions);
    expect_same(now.walls[side].given.value(), gas.walls[side]->given);
    expect_same(now.walls[side].momentum.value(), gas.walls[side]->momentum);
    expect_same(now.walls[side].dissipated.value(), gas.walls[side]->lost);
  }
  ASSERT_EQ(now.front_left.has_value(), gas.outermost(true) != nullptr);
  if (!now.front_left) return;
  EXPECT_EQ(now.particles, gas.outermost(false) - gas.outermost(true) + 1);
  expect_same(*now.front_left, gas.place(*gas.outermost(true)));
  expect_same(*now.front_right, gas.place(*gas.outermost(false)));
}

class ExactGas : public testing::TestWithParam<Family> {};
INSTANTIATE_TEST_SUITE_P(, ExactGas, testing::ValuesIn(families), [](const auto& row) { return row.param.name; });

// Up to so many collisions: in rationals every inelastic one makes the numbers longer.
constexpr std::uint64_t some = 8, most = 16;

template <class T> void expect_scene(const Drawn& d, Totals& all) {
  const auto particles = particles_of<T>(d);
  auto at_start = gas_of<T>(d);
  at_start.ties_from_left = !d.walls[0] && !d.walls[1] && !d.has_roots();
  const T later = T(1) / T(std::int64_t{1} << 60);  // than a collision: whose particles are at one place, or not yet
  auto half = at_start;
  half.advance(T(until) / 2, some);
  auto end = half;
  end.advance(T(until), most);
  if (end.tied) return;
  half.advance(half.time + later), end.advance(end.time + later);
  for_each_run<T>(d, [&](auto run) {
    Sequence seen, wanted;
    std::vector<T> times, wanted_times;
    for (auto gas = at_start; gas.next(end.time);) wanted.add(*gas.latest), wanted_times.push_back(gas.time);
    const auto see = [&](const Collision<T>& c) { seen.add(c.left), times.push_back(c.time.value()); };
    for (const auto* gas : {&half, &end}) {
      if constexpr (has_events<decltype(run)>)
        ASSERT_EQ(run.advance(gas->time, see), Status::reached);
      else
        ASSERT_EQ(run.advance(gas->time), Status::reached);
      expect_as_gas(run, *gas, *particles);
    }
    EXPECT_EQ(run.account().order_lost, 0U);
    if (has_events<decltype(run)>) expect_same(largest_difference(times, wanted_times), T(0));
    if (d.bounces()) {  // clusters go by other names there
      EXPECT_EQ(seen, wanted);
    }
    ++all["runs"], all["collisions"] += end.collisions, all["merges"] += end.merges;
    all["below cut-off"] += end.below_cutoff, all["rested"] += end.rested, all["let go"] += end.let_go;
    for (const auto& wall : end.walls) all["walls"] += wall ? wall->collisions : 0;
  });
}

TEST_P(ExactGas, HasTheMotionOfTheEngine) {
  Totals all;
  for (std::uint64_t number = 0; number < GetParam().scenes && !HasFailure(); ++number) {
    SCOPED_TRACE(number);
    const Drawn d = GetParam().draw(number);
    d.has_roots() ? expect_scene<bin_float>(d, all) : expect_scene<Rational>(d, all);
  }
  expect_at_least(all, GetParam().least);
}

template <class T, class Exact> double in_units(const Exact& error) {  // of the type's rounding
  return to_double(Exact(error / Exact(std::numeric_limits<T>::epsilon() / 2)));
}
// By how much the gas is off in this type; infinity if rounding decides what it does.
template <class T, class Exact> double error_of_gas(const Drawn& d, const Gas<Exact>& exact) {
  auto gas = gas_of<T>(d);
  gas.advance(T(to_double(exact.time)));
  if (gas.collisions != exact.collisions || gas.merges != exact.merges || gas.below_cutoff != exact.below_cutoff)
    return std::numeric_limits<double>::infinity();
  const auto last = static_cast<ParticleIndex>(d.gaps.size()) - 1;
  return in_units<T>(difference(state_of(gas, 0, last), state_of(exact, 0, last)));
}
template <class T, class Exact> void expect_errors(const Drawn& d, const Gas<Exact>& exact, double most_off) {
  const T time(to_double(exact.time));
  for_each_run<T>(d, [&](auto run) {
    EXPECT_EQ(run.advance(time), Status::reached);
    EXPECT_EQ(run.counts().collisions, exact.collisions);
    EXPECT_EQ(run.counts().merges, exact.merges);
    EXPECT_LE(in_units<T>(off(run, time, exact)), most_off);
  });
}
// The gas itself is off by as much in both types, to a factor of two or so; the engine rounds as often, other numbers.
// Returns whether they were compared: where the gas is off by far more it would prove nothing.
template <class Exact> bool expect_errors(const Drawn& d) {
  auto first = gas_of<Exact>(d), exact = first;
  first.advance(Exact(until), most);
  exact.advance(Exact(to_double(first.time) + 0x1p-40), most + 1);
  if (exact.tied || exact.collisions > most) return false;
  // A place of up to 64 is rounded by 32 units, twice.
  const double units = std::max({64., error_of_gas<double>(d, exact), error_of_gas<long double>(d, exact)});
  if (units > 1000) return false;
  expect_errors<double>(d, exact, 3 * units);
  expect_errors<long double>(d, exact, 3 * units);
  return true;
}
TEST_P(ExactGas, IsOffByAsMuchAsTheEngine) {
  std::uint64_t compared = 0;
  for (std::uint64_t number = 0; number < GetParam().scenes && !HasFailure(); ++number) {
    SCOPED_TRACE(number);
    const Drawn d = GetParam().draw(number);
    compared += d.has_roots() ? expect_errors<bin_float>(d) : expect_errors<Rational>(d);
  }
  EXPECT_GT(compared, GetParam().scenes / 2);
}

}  // namespace cradle::test::exact_gas_test
