// Scenes drawn at random for the checker of proofs, in the engine's numbers, in balls and in rationals; what the exact
// gas and the engine make of them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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
  const Rational off = exact(x) - number;
  return (off < 0 ? -off : off) <= exactly(x.radius());
}

struct DrawnWall {
  int gap = 0, speed = 0;  // to the outermost particle; towards the particles
  const char* restitution = "1";
  double temperature = 0;  // above 0: thermal
};

// Multiples of 1/64, so that all types have the same particles; coefficients as decimals.
struct Drawn {
  std::vector<int> gaps, velocities, masses;
  const char* restitution = "1";
  int cutoff = 0, length = 0;
  bool sticky = false;
  std::array<std::optional<DrawnWall>, 2> walls = {};  // left, right
  int acceleration = 0;
};

inline Drawn draw(std::uint64_t number, bool sticky) {
  std::uint64_t index = 0;
  const auto below = [&](int bound) {
    return static_cast<int>(random_bits(11, number, index++) % static_cast<std::uint64_t>(bound));
  };
  Drawn d;
  d.sticky = sticky;
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
  if (below(3) == 0) {
    d.length = 50;
    for (const int gap : d.gaps) d.length += gap;
  }
  return d;
}

// The same with one wall or two.
inline Drawn draw_with_walls(std::uint64_t number) {
  Drawn d = draw(number, false);
  d.length = 0;
  std::uint64_t index = 0;
  const auto below = [&](int bound) {
    return static_cast<int>(random_bits(12, number, index++) % static_cast<std::uint64_t>(bound));
  };
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

// Where a wall stands, in 64ths, and its velocity.
inline int place_of(const Drawn& d, std::size_t side) {
  if (side == 0) return -d.walls[0]->gap;
  int last = 0;
  for (std::size_t b = 0; b + 1 < d.gaps.size(); ++b) last += d.gaps[b];
  return last + d.walls[1]->gap;
}
inline int velocity_of(const Drawn& d, std::size_t side) { return (side == 0 ? 1 : -1) * d.walls[side]->speed; }
constexpr std::uint64_t wall_seed = 21;

inline Gas<Rational> gas_of(const Drawn& d) {
  Gas<Rational> gas;
  Rational place(0);
  for (std::size_t b = 0; b < d.gaps.size(); place += Rational(d.gaps[b++]) / 64)
    gas.cells.push_back(
        {place, Rational(d.velocities[b]) / 64, Rational(d.masses[b]) / 64, {static_cast<ParticleIndex>(b)}});
  gas.restitution = decimal<Rational>(d.restitution);
  gas.cutoff = Rational(d.cutoff) / 64;
  gas.length = Rational(d.length) / 64;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!d.walls[side]) continue;
    const double temperature = d.walls[side]->temperature;
    gas.walls[side] = {Rational(place_of(d, side)) / 64, Rational(velocity_of(d, side)) / 64,
                       decimal<Rational>(d.walls[side]->restitution)};
    if (temperature > 0)
      gas.walls[side]->random_speed = [=](std::uint64_t collision, const Rational& mass) {
        return exactly(thermal_speed(wall_seed, 0, static_cast<End>(side), collision) *
                       std::sqrt(temperature / static_cast<double>(mass)));
      };
  }
  gas.acceleration = Rational(d.acceleration) / 64;
  gas.law = d.sticky ? GasLaw::sticky : GasLaw::inelastic;
  return gas;
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
  for (std::size_t side = 0; side < 2; ++side)
    if (d.walls[side])
      walls[side] = Wall<T>{unit(place_of(d, side)),
                            unit(velocity_of(d, side)),
                            from_text<T>(d.walls[side]->restitution),
                            d.walls[side]->temperature,
                            wall_seed,
                            0};
  return std::make_shared<Walled<T>>(particles, walls[0], walls[1], unit(d.acceleration));
}

inline CertainLaw<B> law_of(const Drawn& d) {
  CertainLaw<B> law;
  if (d.sticky) law.kind = CertainLaw<B>::Kind::sticky;
  law.restitution = from_text<B>(d.restitution);
  law.elastic = std::string(d.restitution) == "1";
  if (d.cutoff > 0) law.cutoff = B(d.cutoff) / B(64);
  return law;
}

inline Rational of_decimals(const bin_float& x) {
  if (abs(x) < bin_float(1e-200)) return Rational(0);
  return decimal<Rational>(x.str(90, std::ios_base::scientific));
}
// Known to 80 digits.
inline bool holds_wide(const B& x, const bin_float& number) {
  const Rational off = exact(x) - of_decimals(number);
  return (off < 0 ? -off : off) <= exactly(x.radius()) + exactly(1e-80);
}

template <class To, class From> Gas<To> converted(const Gas<From>& gas) {
  const auto number = [](const From& x) { return To(numerator(x)) / To(denominator(x)); };
  Gas<To> to;
  for (const auto& cell : gas.cells)
    to.cells.push_back({number(cell.origin), number(cell.v), number(cell.m), cell.particles});
  to.restitution = number(gas.restitution), to.cutoff = number(gas.cutoff);
  to.acceleration = number(gas.acceleration);
  for (std::size_t side = 0; side < 2; ++side) {
    if (!gas.walls[side]) continue;
    const GasWall<From>& wall = *gas.walls[side];
    to.walls[side] = {number(wall.origin), number(wall.v), number(wall.restitution)};
    if (wall.random_speed)
      to.walls[side]->random_speed = [=](std::uint64_t collision, const To& mass) {
        return number(wall.random_speed(collision, From(of_decimals(mass))));
      };
  }
  return to;
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

// What a run reports beside its collisions. A collision on the wrong side of the cut-off may leave their sequence
// unchanged.
struct Said {
  std::uint64_t below;
  Rational energy;
};

// Whether these are proved to be the collisions of the scene; `checker` is left where they end.
inline bool proved(Checker<B>& checker, const Collisions& collisions, const std::optional<Said>& said = {}) {
  if (checker.begin()) return false;
  for (const auto& [left, right] : collisions)
    if (checker.collision(left, right)) return false;
  const auto end = checker.state_at(B(until));
  return !end.doubt && (!said || (checker.proved().below_cutoff == said->below && holds(end.energy, said->energy)));
}

// All of them, in the exact gas; `wrong`: that one on the wrong side of the cut-off.
struct ExactRun {
  Collisions collisions;
  std::uint64_t digest = 0, below = 0;
  bool tied = false, ended = false;
  Gas<Rational> gas;
};
inline ExactRun exact_run(const Drawn& d, std::size_t wrong = most_collisions) {
  ExactRun run;
  run.gas = gas_of(d);
  Trace trace;
  while (run.collisions.size() < most_collisions) {
    const auto collision = run.gas.next(until, run.collisions.size() == wrong);
    if (!collision) break;
    run.collisions.push_back(*collision);
    trace.collision(collision->first, collision->second);
  }
  run.ended = run.collisions.size() < most_collisions;
  if (run.ended) run.gas.time = until;
  run.digest = trace.digest();
  run.tied = run.gas.tied;
  run.below = run.gas.below_cutoff;
  return run;
}

// Of the scenes from number `from` on whose run, by `run_of`, is short and without ties: how many there are, and of how
// many the collisions are proved.
struct ProvedRuns {
  std::uint64_t all = 0, proved = 0;
};
template <class Draw, class RunOf>
ProvedRuns proved_of_exact_runs(std::uint64_t from, std::uint64_t to, const Draw& draw, const RunOf& run_of) {
  ProvedRuns count;
  for (std::uint64_t number = from; number < to; ++number) {
    const Drawn d = draw(number);
    const auto run = run_of(d);
    if (!run.ended || run.gas.tied) continue;
    ++count.all;
    Checker<B> checker(particles_of<B>(d), law_of(d));
    if (proved(checker, run.collisions)) ++count.proved;
  }
  return count;
}

// The collisions that the engine makes in doubles.
template <class Run> Collisions made_by(Run&& run) {
  Collisions collisions;
  run.advance(until, [&](const Collision<double>& c) { collisions.emplace_back(c.left, c.right); });
  return collisions;
}
inline Collisions made(const Drawn& d) {
  const auto particles = particles_of<double>(d);
  const Inelastic<double> law(std::stod(d.restitution), d.cutoff / 64.);
  if (d.sticky) {
    const InelasticMerging<double> merging(Inelastic<double>(0.), std::numeric_limits<double>::max());
    return made_by(Simulation(merging, ClusterChain<double>(particles, 0.)));
  }
  if (d.acceleration != 0)
    return made_by(Simulation(law, GapChain<double, IndividualMasses<double>, Gravity<double>>(particles, 0.)));
  return made_by(Simulation(law, GapChain<double, IndividualMasses<double>>(particles, 0.)));
}

inline std::uint64_t digest_of(const Collisions& collisions) {
  Trace trace;
  for (const auto& [left, right] : collisions) trace.collision(left, right);
  return trace.digest();
}

inline bool shares_a_particle(const std::pair<ParticleIndex, ParticleIndex>& a,
                              const std::pair<ParticleIndex, ParticleIndex>& b) {
  return a.first == b.first || a.first == b.second || a.second == b.first || a.second == b.second;
}

}  // namespace cradle::test::drawn
