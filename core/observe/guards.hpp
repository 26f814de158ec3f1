#pragma once
// What holds in every run, whatever its physics: where it does not, the machine or the program is at fault, and what
// follows means nothing. Looked at on a configuration, that is, now and then:
//
//   order      no two bodies have changed places (unless the run's account tells of it)
//   past       the last contact is not later than the time looked at, nor earlier than the one before it
//   energy     the sum over all bodies is what the ledger of losses leaves, and no body has more than there was
//   momentum   is what it was at the start, between walls excepted
//   closure    gaps and closing speeds add up to what the bodies at the ends of the line tell, or to the ring
//
// Bounds follow from the type and the contacts made. A contact rounds three closing speeds by eps u/2 at most, u the
// largest speed that there is; a velocity told from an end of the line adds all of these up. So after C contacts of N
// bodies, with a factor of 5 to spare,
//
//   delta = 8 eps (C + N + 64),   |dv| <= delta u,   |dp| <= M delta u,   |dE| <= M delta u^2,
//   |dx| <= delta (extent + u t),
//
// since errors of speeds have acted for the time t at most.

#include <cstdint>
#include <limits>
#include <optional>

#include "cradle/core/configuration.hpp"

namespace cradle {

enum class Guard { order, past, energy, momentum, closure };

template <Real T> struct GuardReport {
  Guard guard = Guard::order;
  T found{0}, bound{0};
  BodyIndex body = -1;  // order: the body on the left
};

// What a look tells, beside whether all is well.
template <Real T> struct GuardLook {
  std::optional<GuardReport<T>> broken;
  T gap_min{0};
  T closure_gap{0}, closure_speed{0};  // 0 where the configuration has none
};

// `energy`: what the ledger leaves; `elapsed`: since the start; `ordered`: no account of lost order.
template <Real T>
GuardLook<T> guarded(const Configuration<T>& c, const Bodies<T>& bodies, std::uint64_t contacts, const T& energy,
                     const T& elapsed, const T& last_contact, const T& contact_before, bool ordered) {
  GuardLook<T> look;
  if (c.x.size() < 2) return look;
  const auto report = [&](Guard guard, const T& found, const T& bound, BodyIndex body = -1) {
    if (!look.broken) look.broken = GuardReport<T>{guard, found, bound, body};
  };
  // A time is stamped from an origin that moves, and rounded anew.
  const T of_time = T(8) * T(std::numeric_limits<T>::epsilon()) * (magnitude(c.time) + magnitude(contact_before));
  if (!(last_contact <= c.time + of_time) || last_contact < contact_before - of_time)
    report(Guard::past, last_contact, last_contact < contact_before ? contact_before : c.time);

  CompensatedSum<T> twice, momentum;
  T fastest(0);
  for (std::size_t j = 0; j < c.x.size(); ++j) {
    const T& v = c.v[j];
    const T p = c.m[j] * v;
    twice.add(p * v);
    momentum.add(p);
    if (fastest < magnitude(v)) fastest = magnitude(v);
  }
  // What the other bodies have, and these had at the start.
  CompensatedSum<T> twice_before, momentum_before;
  const bool all = c.from == 0 && c.to + 1 == bodies.count();
  for (BodyIndex b = c.from; !all && b <= c.to; ++b) {
    const T v = bodies.velocity(b), p = bodies.mass(b) * v;
    twice_before.add(p * v);
    momentum_before.add(p);
    if (fastest < magnitude(v)) fastest = magnitude(v);
  }
  const T start_energy = bodies.kinetic_energy(), mass = bodies.total_mass();
  const T rest = all ? T(0) : T(start_energy - twice_before.value() / T(2));
  const T delta = T(8) * T(std::numeric_limits<T>::epsilon()) *
                  (T(static_cast<std::int64_t>(contacts)) + T(bodies.count()) + T(64));
  // No body has more than there was.
  const T most = T(2) * start_energy * (T(1) + delta) / bodies.least_mass();
  if (!bodies.walled() && !(fastest * fastest <= most)) report(Guard::energy, T(fastest * fastest), most);

  // Bodies all at rest by now were not.
  if (fastest * fastest * mass < start_energy) fastest = fastest + T(1) + start_energy / mass;
  // Where walls take and give, errors are of the energy that has passed through, not of what there is now.
  if (bodies.walled()) fastest = fastest + T(1) + bodies.energy_to_lose() / mass;
  const T of_speed = delta * fastest;
  const T off_energy = magnitude(T(rest + twice.value() / T(2) - energy)), of_energy = mass * of_speed * fastest;
  if (!(off_energy <= of_energy)) report(Guard::energy, off_energy, of_energy);
  const T off_momentum = magnitude(T(momentum.value() - (all ? bodies.momentum() : momentum_before.value())));
  if (!bodies.walled() && !(off_momentum <= mass * of_speed)) report(Guard::momentum, off_momentum, T(mass * of_speed));

  const T extent = magnitude(c.x.front()) + magnitude(c.x.back()) + bodies.circumference();
  const T of_place = delta * (extent + fastest * magnitude(elapsed));
  look.gap_min = c.gap.front();
  for (std::size_t j = 0; j < c.gap.size(); ++j) {
    if (c.gap[j] < look.gap_min) look.gap_min = c.gap[j];
    if (ordered && !(-of_place <= c.gap[j])) report(Guard::order, c.gap[j], T(-of_place), c.index[j]);
  }
  if (c.closure_gap) {
    look.closure_gap = *c.closure_gap;
    if (!(magnitude(*c.closure_gap) <= of_place)) report(Guard::closure, *c.closure_gap, of_place);
  }
  if (c.closure_speed) {
    look.closure_speed = *c.closure_speed;
    if (!(magnitude(*c.closure_speed) <= of_speed)) report(Guard::closure, *c.closure_speed, of_speed);
  }
  return look;
}

}  // namespace cradle
