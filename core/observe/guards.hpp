#pragma once
// Conditions that hold in every run, for any physics. If one fails, the machine or the program is at fault, or absolute
// positions do not resolve what happens, and later results mean nothing. They are checked from time to time:
//
//   order     no two particles have changed places, unless the run's account records it
//   wall      no particle is beyond a wall: no collision with it was missed
//   past      the last collision is not later than the time of the check, nor earlier than that of the check before
//   energy    the sum over all particles is what the ledger of losses leaves; no particle has more than there was
//   momentum  is what it was at the start, with what gravity has added, except between walls
//   closure   gaps and closing speeds add up to what the particles at the ends of the line give, or to the ring
//
// Bounds follow from the type, the number of collisions and the initial state, not from the present speeds: a light
// particle may have been faster by the square root of any ratio of masses. With E the energy at the start, M the mass
// of all particles and m the least one,
//
//   delta = 8 epsilon (C + N + 64),   C collisions of N particles, a factor of 5 to spare,
//   U     = sqrt(2 E/m), which no speed can exceed; where masses are identical the largest one at the start, since
//           velocities after a collision lie between those before.
//
// A collision rounds the velocities of its two particles in their own units, and so their exchange: |m dv| <= epsilon
// J, J = (1 + eps) mu w <= 2 sqrt(2 E mu), for any masses. A velocity that is a sum of closing speeds has the rounding
// of each of these instead, epsilon U, which shifts all particles on one side of the gap. So
//
//                                    |dE| <=                     |dp| <=                 closing speeds add up to
//   velocities of particles' own        delta 2 E                   delta sqrt(2 E M)       delta epsilon U
//   sums of closing speeds           delta U sqrt(2 E M)         delta U M               delta U
//
// and a reading rounds each velocity by epsilon U at most. (Sums that keep what rounding leaves, gap_line.hpp, count as
// the particles' own; their rounding is that of the last row with delta epsilon for delta.) Gaps and places are rounded
// in units of the line, and by the way in a unit of time:
//
//   |dx| <= delta (extent + U t),   extent that at the start or now, whichever is more: the particles at the ends are
//                                   pushed outwards only,
//
// since errors of speeds have acted at most for the time t.
//
// If closing speeds between two walls, or around a ring, do not add up to that of its ends but to S, the particles move
// as if one end had the speed S too, and it does work on them. By then it has moved by d = integral of S dt, which is
// what gaps fail to add up by. The mean force on the ends is 2 K/L, K the kinetic energy and L the room: the virial G =
// sum m x v has dG/dt = 2 K - F L. So the work is (2 K/L) d, and the integral of G dS/L, which is in the table above. S
// is a sum of roundings that walks at random, so d and the energy grow as C^(3/2): faster than delta. Therefore
// 2 (2 E/L) |d| is added, d as it is found. (Twice that: while E falls, d may have been larger before.)
//
// Moving and thermal walls add energy: with them E is the energy for which the ledger of losses is made
// (Walled::energy_to_lose). Under gravity energies are sums of kinetic and potential ones, E is the largest kinetic one
// (Particles::most_kinetic_energy), and an error dx of all places adds |a| M dx to that of the energy.
//
// An error of 1e-6 of E, or of sqrt(2 E M), is found as long as delta is smaller: for 5e8 collisions if velocities are
// the particles' own, for 5e8 sqrt(E/(M U^2/2)) if they are sums. An error in a position is found if it exceeds delta U
// t; masses of 1e-8 beside 1 can make this 1e4 times larger than equal masses do.

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "cradle/core/chains/configuration.hpp"

namespace cradle {

enum class Guard { order, wall, past, energy, momentum, closure };

template <Real T> struct GuardReport {
  Guard guard = Guard::order;
  T found{0}, bound{0};
  ParticleIndex particle = -1;  // order: the particle on the left; wall: that beyond it
};

// The result of a check.
template <Real T> struct GuardCheck {
  std::optional<GuardReport<T>> broken;
  T gap_min{0};
  T closure_gap{0}, closure_speed{0};  // 0 if the configuration has none
};

// A number from the root of x >= 0 to 1.06 times the root.
template <Real T> T root_above(const T& x) { return is_positive(x) ? T(square_root(x) * T(33) / T(32)) : T(0); }

namespace detail {

// 2 (2 E/L) |d| as above; 0 where nothing encloses the particles.
template <Real T>
T work_at_ends(const Configuration<T>& c, const Particles<T>& particles, const T& twice_energy, const T& elapsed) {
  const bool between = particles.wall(End::left) != nullptr && particles.wall(End::right) != nullptr;
  if (!c.closure_gap || !(between || particles.on_ring())) return T(0);
  const ParticleIndex last = particles.count();
  const T room = between ? T(particles.position(last) - particles.position(-1) +
                             (particles.velocity(last) - particles.velocity(-1)) * elapsed)
                         : particles.circumference();
  return is_positive(room) ? T(T(2) * twice_energy * magnitude(*c.closure_gap) / room) : T(0);
}

template <Real T> T guard_unit(const Particles<T>& particles, std::uint64_t collisions) {
  return T(8) * T(std::numeric_limits<T>::epsilon()) *
         (T(static_cast<std::int64_t>(collisions)) + T(particles.count()) + T(64));
}

}  // namespace detail

// The guard of walls, with |dx| above as the bound. It costs little, so it need not wait for many collisions.
// Run::gap_to_wall as of a Simulation.
template <class Run, Real T = typename Run::Scalar>
std::optional<GuardReport<T>> beyond_a_wall(const Run& run, const Particles<T>& particles, const T& time,
                                            const T& elapsed) {
  for (const End end : {End::left, End::right}) {
    const std::optional<T> gap = run.gap_to_wall(end, time);
    if (!gap || !is_negative(*gap)) continue;
    const Wall<T>& wall = *particles.wall(end);
    const ParticleIndex last = particles.count() - 1;
    const T top_speed = root_above(T(T(2) * particles.most_kinetic_energy(elapsed) / particles.least_mass()));
    const T extent = magnitude(particles.position(0)) + magnitude(particles.position(last)) + magnitude(wall.position) +
                     wall.fastest() * elapsed;
    const T bound = -detail::guard_unit(particles, run.counts().collisions) * (extent + top_speed * elapsed);
    if (*gap < bound) return GuardReport<T>{Guard::wall, *gap, bound, end == End::left ? 0 : last};
  }
  return {};
}

// `energy`: what the ledger leaves, potential energy included; `elapsed`: since the start; `ordered`: the account has
// no lost order.
template <Real T>
GuardCheck<T> guarded(const Configuration<T>& c, const Particles<T>& particles, std::uint64_t collisions,
                      const T& energy, const T& elapsed, const T& last_collision, const T& collision_before,
                      bool ordered) {
  GuardCheck<T> check;
  if (c.x.size() < 2) return check;
  const auto report = [&](Guard guard, const T& found, const T& bound, ParticleIndex particle = -1) {
    if (!check.broken) check.broken = GuardReport<T>{guard, found, bound, particle};
  };
  // A time is the sum of an offset and a moving origin, and is rounded.
  const T of_time = T(8) * T(std::numeric_limits<T>::epsilon()) * (magnitude(c.time) + magnitude(collision_before));
  if (!(last_collision <= c.time + of_time) || last_collision < collision_before - of_time)
    report(Guard::past, last_collision, last_collision < collision_before ? collision_before : c.time);

  const bool fall = particles.fall();
  const T acceleration = particles.acceleration(), twice_weight = T(-2) * acceleration;  // of the mass 1
  struct Sums {
    CompensatedSum<T> twice, momentum;  // twice the energy
    T fastest{0}, most_energy{0};
  };
  const auto add = [&](Sums& to, const T& m, const T& v, const T& x) {
    const T p = m * v, own = p * v;
    to.twice.add(own);
    if (fall) to.twice.add(twice_weight * m * x);
    to.momentum.add(p);
    if (to.fastest < magnitude(v)) to.fastest = magnitude(v);
    if (to.most_energy < own) to.most_energy = own;
  };
  // Over the particles of the configuration, now and at the start.
  Sums now, before;
  for (std::size_t j = 0; j < c.x.size(); ++j) add(now, c.m[j], c.v[j], c.x[j]);
  for (ParticleIndex b = c.from; b <= c.to; ++b)
    add(before, particles.mass(b), particles.velocity(b), fall ? particles.position(b) : T(0));
  const bool all = c.from == 0 && c.to + 1 == particles.count();
  const T start_energy = particles.mechanical_energy(), mass = particles.total_mass();
  const T rest = all ? T(0) : T(start_energy - before.twice.value() / T(2));
  const T epsilon = std::numeric_limits<T>::epsilon();
  const T delta = detail::guard_unit(particles, collisions);
  const bool walls_give_energy = particles.walls_give_energy();
  const T twice_energy = T(2) * particles.most_kinetic_energy(elapsed);
  const bool bounded_by_start = particles.identical_masses() && !walls_give_energy && !fall;
  const T top_speed = bounded_by_start ? before.fastest : root_above(T(twice_energy / particles.least_mass()));
  const T all_as_one = root_above(T(twice_energy * mass));  // no momentum is larger

  const T of_sums = c.speeds_are_sums ? delta : T(delta * epsilon);
  const T extent_before = magnitude(particles.position(c.from)) + magnitude(particles.position(c.to));
  const T extent = magnitude(c.x.front()) + magnitude(c.x.back()) + extent_before + particles.circumference();
  const T of_place = delta * (extent + top_speed * magnitude(elapsed));
  const T of_fall = fall ? T(magnitude(acceleration) * mass * of_place) : T(0);
  const T of_energy = delta * twice_energy + of_sums * top_speed * all_as_one + of_fall +
                      detail::work_at_ends(c, particles, twice_energy, elapsed);
  // No particle has more than the total energy.
  if (!(now.most_energy <= twice_energy + T(2) * of_energy)) report(Guard::energy, now.most_energy, twice_energy);
  const T off_energy = magnitude(T(rest + now.twice.value() / T(2) - energy));
  if (!(off_energy <= of_energy)) report(Guard::energy, off_energy, of_energy);
  const T from_gravity = fall ? T(acceleration * elapsed * particles.mass_between(c.from, c.to + 1)) : T(0);
  const T off_momentum =
      magnitude(T(now.momentum.value() - ((all ? particles.momentum() : before.momentum.value()) + from_gravity)));
  const T of_momentum = delta * all_as_one + of_sums * top_speed * mass;
  if (!particles.walled() && !(off_momentum <= of_momentum)) report(Guard::momentum, off_momentum, of_momentum);

  check.gap_min = c.gap.front();
  for (std::size_t j = 0; j < c.gap.size(); ++j) {
    if (c.gap[j] < check.gap_min) check.gap_min = c.gap[j];
    if (ordered && !(-of_place <= c.gap[j])) report(Guard::order, c.gap[j], T(-of_place), c.index[j]);
  }
  if (c.closure_gap) {
    check.closure_gap = *c.closure_gap;
    if (!(magnitude(*c.closure_gap) <= of_place)) report(Guard::closure, *c.closure_gap, of_place);
  }
  if (c.closure_speed) {
    check.closure_speed = *c.closure_speed;
    const T of_speed = of_sums * top_speed + T(4) * epsilon * (now.fastest + before.fastest);
    if (!(magnitude(*c.closure_speed) <= of_speed)) report(Guard::closure, *c.closure_speed, of_speed);
  }
  return check;
}

}  // namespace cradle
