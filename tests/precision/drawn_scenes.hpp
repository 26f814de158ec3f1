// Scenes drawn at random for the checker of proofs, in the engine's numbers, in balls, in rationals and in 100 digits;
// what the exact gas and the engine make of them.
#pragma once

#include <ostream>

#include <gtest/gtest.h>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/certify/checker.hpp"
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/initial/list.hpp"
#include "cradle/core/initial/walled.hpp"
#include "cradle/core/observe/trace.hpp"
#include "cradle/precision/ball.hpp"
#include "cradle/precision/ball_text.hpp"
#include "cradle/tests/precision/reference_gas.hpp"

namespace cradle::test::drawn {

using B = Ball<double_double>;
using Collisions = std::vector<std::pair<ParticleIndex, ParticleIndex>>;

inline Rational exact(const B& x) { return exactly(x.middle().high()) + exactly(x.middle().low()); }
inline bool holds(const B& x, const Rational& number) {
  return abs(Rational(exact(x) - number)) <= exactly(x.radius());
}
// Without what is so small that it would have too many digits.
inline Rational in_rationals(const bin_float& x) { return abs(x) < 1e-200 ? Rational(0) : Rational(x); }
// A number that is known to 80 digits.
inline bool holds(const B& x, const bin_float& number) {
  return abs(Rational(exact(x) - in_rationals(number))) <= exactly(x.radius()) + exactly(1e-80);
}

struct DrawnWall {
  int gap = 0, speed = 0;  // to the outermost particle; towards the particles
  const char* restitution = "1";
  double temperature = 0;                    // above 0: thermal
  std::optional<Shaking<int>> shaking = {};  // in units of 1/64
  int rest_speed = 0;
};

// Multiples of 1/64, so that all types have the same particles; coefficients as decimals.
struct Drawn {
  std::vector<int> gaps, velocities, masses;
  GasLaw law = GasLaw::inelastic;
  const char* restitution = "1";
  int cutoff = 0, length = 0, loss = 0;  // the cut-off also says how long a contact is, or what speeds merge
  const char* exponent = nullptr;        // of an inelastic law whose restitution depends on the speed
  std::array<std::optional<DrawnWall>, 2> walls = {};  // left, right
  int acceleration = 0;

  bool bounces() const { return law == GasLaw::inelastic || law == GasLaw::contact_time; }
  bool has_roots() const {
    const auto shaken = [](const auto& wall) { return wall && wall->shaking; };
    return acceleration != 0 || loss > 0 || exponent != nullptr || shaken(walls[0]) || shaken(walls[1]);
  }
};

// A number by chance, from 0 on.
inline int random_below(int bound, std::uint64_t seed, std::uint64_t number, std::uint64_t index) {
  return static_cast<int>(random_bits(seed, number, index) % static_cast<std::uint64_t>(bound));
}

inline Drawn draw(std::uint64_t number) {
  std::uint64_t index = 0;
  const auto below = [&](int bound) { return random_below(bound, 11, number, index++); };
  Drawn d;
  const int particles = 3 + below(5);
  const bool equal = below(2) == 0, small = below(8) == 0;  // few numbers to choose from: ties, cut-offs hit exactly
  for (int b = 0; b < particles; ++b) {
    d.gaps.push_back(small ? 64 : 1 + below(200));
    d.velocities.push_back(small ? 64 * (below(5) - 2) : below(512) - 256);
    d.masses.push_back(equal ? 64 : 16 + below(200));
  }
  constexpr const char* coefficients[] = {"1", "0.999", "0.999999", "0.5", "0.9", "0.1", "0.95"};
  d.restitution = coefficients[below(7)];
  d.cutoff = below(3) == 0 ? 0 : small ? 64 : 1 + below(40);
  if (below(3) == 0) d.length = std::accumulate(d.gaps.begin(), d.gaps.end(), 50);
  return d;
}

// The scenes of another law.
template <GasLaw law, Drawn (*draw_scene)(std::uint64_t) = draw> Drawn draw_by(std::uint64_t number) {
  Drawn d = draw_scene(number);
  d.law = law;
  return d;
}
inline Drawn draw_wet(std::uint64_t number) {
  Drawn d = draw_by<GasLaw::wet>(number);
  d.loss = 8 * (1 + static_cast<int>(number % 7));
  d.restitution = "0.5", d.cutoff = 0;  // not used
  return d;
}

// The same with one wall or two.
inline Drawn draw_with_walls(std::uint64_t number) {
  Drawn d = draw(number);
  d.length = 0;
  std::uint64_t index = 0;
  const auto below = [&](int bound) { return random_below(bound, 12, number, index++); };
  const int which = below(3);
  for (std::size_t side = 0; side < 2; ++side) {
    if (which == static_cast<int>(side)) continue;
    DrawnWall wall;
    wall.gap = 1 + below(200);
    wall.speed = below(3) == 0 ? 0 : below(40) - 20;
    constexpr const char* coefficients[] = {"1", "1", "0.9", "0.3", "0.999"};
    wall.restitution = coefficients[below(5)];
    wall.temperature = below(3) == 0 ? (1 + below(8)) / 8. : 0;
    d.walls[side] = wall;
  }
  return d;
}

// With a restitution that depends on the speed, a third of them between walls at a temperature of 0.
inline Drawn draw_speed_dependent(std::uint64_t number) {
  Drawn d = number % 3 == 0 ? draw_with_walls(number) : draw(number);
  for (auto& wall : d.walls)
    if (wall) wall->temperature = 0;
  d.length = 0;
  if (d.cutoff == 0) d.cutoff = 32;
  constexpr const char* exponents[] = {"1", "4", "0.5", "2.5", "1.0", "1.5"};
  d.exponent = exponents[number % 6];
  return d;
}

// The same under gravity, to the left or to the right; of half of them one or two particles.
inline Drawn draw_falling(std::uint64_t number) {
  Drawn d = draw_with_walls(number);
  if (random_bits(13, number, 2) % 2 == 0) {
    const auto few = static_cast<std::size_t>(1 + random_bits(13, number, 3) % 2);
    d.gaps.resize(few), d.velocities.resize(few), d.masses.resize(few);
  }
  const auto pull = static_cast<int>(1 + random_bits(13, number, 0) % 256);
  d.acceleration = random_bits(13, number, 1) % 2 == 0 ? pull : -pull;
  return d;
}

// So that the wall is nowhere beyond the outermost particle at the start.
inline void shake(DrawnWall& wall, std::uint64_t number, std::uint64_t side) {
  const auto below = [&](std::uint64_t index, int bound) { return random_below(bound, 14, number, 8 * side + index); };
  wall.shaking = {static_cast<Shape>(below(0, 3)), 1 + below(1, 32), 32 + below(2, 256), below(3, 256)};
  wall.gap += wall.shaking->amplitude;
  wall.temperature = 0;
}
// The same between walls of which one or both are shaken, a quarter of them without gravity.
inline Drawn draw_shaken(std::uint64_t number) {
  Drawn d = draw_falling(number);
  if (number % 4 == 0) d.acceleration = 0;
  for (std::size_t side = 0; side < 2; ++side)
    if (d.walls[side] && (number % 2 == side || !d.walls[1 - side])) shake(*d.walls[side], number, side);
  return d;
}
// Particles that fall on a floor that holds them, shaken in three of four scenes; below a ceiling in a third of them.
inline Drawn draw_resting(std::uint64_t number) {
  Drawn d = draw(number);
  const auto below = [&](std::uint64_t index, int bound) { return random_below(bound, 15, number, index); };
  constexpr const char *soft[] = {"0.75", "0.5", "0.9", "0.6"}, *floors[] = {"0.25", "0.5", "0.125"};
  d.restitution = soft[below(0, 4)], d.length = 0;
  const auto few = static_cast<std::size_t>(1 + below(8, 3));
  if (number / 2 % 2 == 0) d.gaps.resize(few), d.velocities.resize(few), d.masses.resize(few);
  for (int& gap : d.gaps) gap = 1 + gap / 4;
  for (int& velocity : d.velocities) velocity /= 4;
  const std::size_t side = number % 2;
  d.acceleration = (side == 0 ? -1 : 1) * (64 + below(1, 128));
  DrawnWall floor{1 + below(2, 64), below(3, 3) == 0 ? below(4, 16) - 8 : 0, floors[below(5, 3)]};
  floor.rest_speed = 16 + below(6, 64);
  if (number % 4 > 0) shake(floor, number, 2), floor.shaking->frequency += 128;
  d.walls[side] = floor;
  if (number % 3 == 0) d.walls[1 - side] = DrawnWall{64 + below(7, 64), -floor.speed, "0.75"};
  return d;
}

// How often something happens in all scenes of a family.
using Totals = std::map<std::string, std::uint64_t>;
inline void expect_at_least(Totals found, const Totals& least) {
  for (const auto& [what, times] : least) EXPECT_GE(found[what], times) << what;
}
// Scenes of one kind: how many are drawn, and what happens in them at least.
struct Family {
  const char* name;
  Drawn (*draw)(std::uint64_t number);
  std::uint64_t scenes;
  Totals least;
  friend std::ostream& operator<<(std::ostream& out, const Family& family) { return out << family.name; }
};

// Where a wall stands, in 64ths, and its velocity.
inline int place_of(const Drawn& d, std::size_t side) {
  if (side == 0) return -d.walls[0]->gap;
  return std::accumulate(d.gaps.begin(), d.gaps.end() - 1, d.walls[1]->gap);
}
inline int velocity_of(const Drawn& d, std::size_t side) { return (side == 0 ? 1 : -1) * d.walls[side]->speed; }
constexpr std::uint64_t wall_seed = 21;
// As the type rounds it; rationals have no text.
template <class T> T coefficient(const char* decimals) {
  if constexpr (std::same_as<T, Rational>)
    return decimal<T>(decimals);
  else
    return from_text<T>(decimals);
}

// That of the law: a closing speed, or a time. (No interval between two collisions is as long to the last digit.)
template <class T> T threshold(const Drawn& d) {
  return d.law == GasLaw::contact_time ? T(T(d.cutoff + 1) / T(97))
                                       : T(T(d.cutoff) / T(d.law == GasLaw::merging ? 16 : 64));
}

template <class T> Gas<T> gas_of(const Drawn& d) {
  const auto unit = [](int n) { return T(n) / 64; };
  Gas<T> gas;
  int place = 0;
  for (std::size_t b = 0; b < d.gaps.size(); place += d.gaps[b++])
    gas.cells.push_back({unit(place), unit(d.velocities[b]), unit(d.masses[b]), {static_cast<ParticleIndex>(b)}});
  gas.law = d.law;
  gas.restitution = decimal<T>(d.restitution);
  (d.law == GasLaw::contact_time ? gas.contact_time
   : d.law == GasLaw::merging    ? gas.merge_speed
                                 : gas.cutoff) = threshold<T>(d);
  gas.length = unit(d.length), gas.loss = unit(d.loss);
  if (d.exponent) gas.cutoff_exponent = decimal<T>(d.exponent);
  for (std::size_t side = 0; side < 2; ++side) {
    if (!d.walls[side]) continue;
    const double temperature = d.walls[side]->temperature;
    gas.walls[side] = {unit(place_of(d, side)), unit(velocity_of(d, side)), decimal<T>(d.walls[side]->restitution)};
    gas.walls[side]->rest_speed = unit(d.walls[side]->rest_speed);
    if (const auto& s = d.walls[side]->shaking)
      gas.walls[side]->shaking = {s->shape, unit(s->amplitude), unit(s->frequency), unit(s->phase)};
    if (temperature > 0)
      gas.walls[side]->random_speed = [=](std::uint64_t collision, const T& mass) {
        return T(thermal_speed(wall_seed, 0, static_cast<End>(side), collision) *
                 std::sqrt(temperature / static_cast<double>(mass)));
      };
  }
  gas.acceleration = unit(d.acceleration);
  return gas;
}
// f(gas): in rationals or, where there are roots, in 100 digits.
template <class F> void with_gas(const Drawn& d, F f) {
  d.has_roots() ? f(gas_of<bin_float>(d)) : f(gas_of<Rational>(d));
}

template <class T> std::shared_ptr<const Particles<T>> particles_of(const Drawn& d) {
  std::vector<T> x, v, m;
  const auto unit = [](int n) { return n % 64 == 0 ? T(n / 64) : T(T(n) / T(64)); };  // exact masses may be identical
  int place = 0;
  for (std::size_t b = 0; b < d.gaps.size(); ++b) {
    x.push_back(unit(place)), v.push_back(unit(d.velocities[b])), m.push_back(unit(d.masses[b]));
    place += d.gaps[b];
  }
  auto particles = std::make_shared<List<T>>(x, v, m, unit(d.length));
  if (!d.walls[0] && !d.walls[1] && d.acceleration == 0) return particles;
  std::array<std::optional<Wall<T>>, 2> walls;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!d.walls[side]) continue;
    const DrawnWall& drawn = *d.walls[side];
    walls[side] = Wall<T>{.position = unit(place_of(d, side)),
                          .speed = unit(velocity_of(d, side)),
                          .restitution = coefficient<T>(drawn.restitution),
                          .temperature = drawn.temperature,
                          .seed = wall_seed,
                          .rest_speed = unit(drawn.rest_speed)};
    if constexpr (!std::same_as<T, Rational> && !std::same_as<T, B>)
      if (const auto& s = drawn.shaking)
        walls[side]->motion =
            std::make_shared<WallMotion<T>>(s->shape, unit(s->amplitude), unit(s->frequency), unit(s->phase));
  }
  return std::make_shared<Walled<T>>(particles, walls[0], walls[1], unit(d.acceleration));
}

// f(law) with the engine's law. (Not in types that are not meant for the law, which takes too long to compile.)
template <class T, class F> auto with_law(const Drawn& d, F f) {
  const T restitution = coefficient<T>(d.restitution), limit = threshold<T>(d);
  if constexpr (!std::same_as<T, Rational>) {
    if (d.exponent) return f(SpeedDependent<T>(restitution, limit, coefficient<T>(d.exponent)));
    if (d.law == GasLaw::wet) return f(Wet<T>(T(d.loss) / T(64)));
  }
  if constexpr (!std::same_as<T, bin_float>) {
    if (d.law == GasLaw::sticky) return f(Sticky<T>());
    if (d.law == GasLaw::merging) return f(InelasticMerging<T>(Inelastic<T>(restitution), limit));
  }
  if (d.law == GasLaw::contact_time) return f(ContactTime<T>(Inelastic<T>(restitution), limit));
  return f(Inelastic<T>(restitution, limit));
}
inline CertainLaw<B> law_of(const Drawn& d) {
  CertainLaw<B> law;
  if (d.law == GasLaw::sticky) law.kind = CertainLaw<B>::Kind::sticky;
  if (d.loss > 0) law.kind = CertainLaw<B>::Kind::wet, law.loss = B(d.loss) / B(64);
  law.restitution = from_text<B>(d.restitution);
  law.elastic = std::string(d.restitution) == "1";
  if (d.cutoff > 0) law.cutoff = B(d.cutoff) / B(64);
  if (d.exponent) law.cutoff_exponent = from_text<B>(d.exponent);
  return law;
}

// Balls of the start that are wide: every state in them has its own motion, which stays within the balls.
// Those of neighbours differ.
inline double spread(ParticleIndex particle) { return particle % 2 == 0 ? 0x1p-28 : 0x1p-22; }
inline std::shared_ptr<const Particles<B>> wide_particles(const Drawn& d) {
  const auto narrow = particles_of<B>(d);
  std::vector<B> x, v, m;
  for (ParticleIndex b = 0; b < narrow->count(); ++b) {
    x.push_back(B::widened(narrow->position(b), spread(b)));
    v.push_back(B::widened(narrow->velocity(b), spread(b)));
    m.push_back(narrow->mass(b));
  }
  const auto wall = [&](End end) {
    return narrow->wall(end) == nullptr ? std::optional<Wall<B>>() : std::optional(*narrow->wall(end));
  };
  return std::make_shared<Walled<B>>(std::make_shared<List<B>>(x, v, m), wall(End::left), wall(End::right),
                                     narrow->acceleration());
}
// At an end of each ball, or in its middle.
template <class T> Gas<T> off_the_middle(Gas<T> gas, std::uint64_t number) {
  std::uint64_t index = 0;
  const auto off = [&](const auto& cell) {
    return T(static_cast<int>(random_bits(17, number, index++) % 3) - 1) * T(spread(cell.particles.front()));
  };
  for (auto& cell : gas.cells) cell.origin += off(cell), cell.v += off(cell);
  return gas;
}

constexpr int until = 4;
constexpr std::size_t most_collisions = 60;

inline testing::AssertionResult is_doubt(const std::optional<Doubt<B>>& doubt, Check check, bool refuted) {
  if (!doubt) return testing::AssertionFailure() << "no doubt";
  return (doubt->check == check && doubt->refuted == refuted ? testing::AssertionSuccess()
                                                             : testing::AssertionFailure())
         << "check " << static_cast<int>(doubt->check) << (doubt->refuted ? ", refuted" : ", open");
}

inline bool proved_in_order(Checker<B>& checker, const Collisions& collisions) {
  return std::none_of(collisions.begin(), collisions.end(),
                      [&](const auto& pair) { return checker.collision(pair.first, pair.second).has_value(); });
}
// Whether these are proved to be the collisions of the scene; `checker` is left where they end.
inline bool proved(Checker<B>& checker, const Collisions& collisions) {
  return !checker.begin() && proved_in_order(checker, collisions) && !checker.state_at(B(until)).doubt;
}

// All collisions of a gas, if there are not too many; `wrong`: that one on the wrong side of the cut-off.
template <class T> struct GasRun {
  Gas<T> gas;
  Collisions collisions;
  bool ended = false;
};
template <class T> GasRun<T> run_of(Gas<T> gas, std::size_t wrong = most_collisions) {
  GasRun<T> run{std::move(gas), {}};
  while (run.collisions.size() < most_collisions) {
    const auto collision = run.gas.next(until, run.collisions.size() == wrong);
    if (!collision) break;
    run.collisions.push_back(*collision);
  }
  run.ended = run.collisions.size() < most_collisions;
  if (run.ended) run.gas.time = until;
  return run;
}

// The collisions that the engine makes in doubles.
template <class Run> Collisions made_by(Run&& run, double to = until) {
  Collisions collisions;
  run.advance(to, [&](const Collision<double>& c) { collisions.emplace_back(c.left, c.right); });
  return collisions;
}
inline Collisions made(const Drawn& d) {
  return with_law<double>(d, [&]<class Law>(const Law& law) {
    using Chain =
        std::conditional_t<Law::bounces_only, GapChain<double, IndividualMasses<double>>, ClusterChain<double>>;
    return made_by(Simulation(law, Chain(particles_of<double>(d), 0.)));
  });
}

inline std::uint64_t digest_of(const Collisions& collisions) {
  Trace trace;
  for (const auto& [left, right] : collisions) trace.collision(left, right);
  return trace.digest();
}

// Exchanges a collision with the next other one that shares a particle with it, if there is one.
inline bool exchange_with_next(Collisions& collisions, std::size_t number) {
  const auto at = collisions.begin() + static_cast<std::ptrdiff_t>(number);
  const auto next = std::find_if(at + 1, collisions.end(), [&](const auto& other) {
    return other != *at && (other.first == at->first || other.first == at->second || other.second == at->first ||
                            other.second == at->second);
  });
  if (next == collisions.end()) return false;
  std::iter_swap(at, next);
  return true;
}

}  // namespace cradle::test::drawn
