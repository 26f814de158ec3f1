// Energy of the wet shock as long as nothing sticks: every collision takes E_loss exactly, so only collisions have to
// be counted. "Dry and wet granular shock waves", section V, gives the front alone; the rest follows in the same way.
// Wet particles pass through each other, so particle i of the left row (counted from the front, i = 0, 1, ...) meets
// each particle j of the right row once. With u_ij the speed of a particle that has met j others and is the i-th of its
// row, the two close at w_ij = u_ij + u_ji and each loses 2e/(w + w'), e = E_loss/m, w' = sqrt(w^2 - 4e); the flights
// between collisions are straight. This recursion over i and j (`cross_rows`) is exact for unperturbed rows until the
// first pair sticks; its row i = 0 is the front. Many collisions, e << u0^2: a row decelerates at e times the number
// density of the other. In s = E_loss t/(m u0 l) the number of collisions is 2 (u0 t/l)^2 g(s), of which 2 (u0 t/l)^2
// is that of rows that pass freely, with
//     w u_j = -e, u_j = v_i;   w t_ij = -(u_i t_j + v_j t_i),   w = u + v      (subscripts i, j: derivatives)
// solved as power series in i and j and counted, area of {t(i,j) <= t}: g(s) = 1 - s/3 - s^2/48 - s^3/80 - ... .
#pragma once

#include "cradle/core/theory/wet_shock.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cradle::theory {

/// s = E_loss t/(m u0 l): the front turns at s = 1, the first particles stick at 1.13 (E_loss -> 0).
template <class T> T wet_progress(const WetShock<T>& shock, const T& t) {
  return T(shock.loss * t / (shock.mass * shock.speed * shock.spacing));
}

/// g(s): collisions over those of rows that pass freely, in the limit of small losses. The series is cut after s^16: g
/// is 7e-7 too large at s = 0.8, 4e-5 at 1, 2e-4 at 1.1. Finite losses change it by a few e/u0^2.
template <class T> T collision_share(const T& s) {
  // 1 - g = sum of 2 a_k s^k/(k+2)! with the a_k below: dyadic, so doubles are exact
  T sum(0);
  T scale(1);  // 2 s^k/(k+2)!
  int k = 0;
  for (const double a : {1., 1. / 4, 3. / 4, 41. / 16, 173. / 16, 1717. / 32, 19439. / 64, 3845. / 2, 1717057. / 128,
                         104527365. / 1024, 859920451. / 1024, 15184732971. / 2048, 71480968241. / 1024,
                         5707319311137. / 8192, 60046463838525. / 8192, 2648956684675571. / 32768}) {
    ++k;
    scale = T(scale * s / T(k + 2));
    sum = T(sum + scale * exactly<T>(a));
  }
  return T(T(1) - sum);
}

/// Collisions up to time t before anything sticks, 2 (u0 t/l)^2 g(s), for small losses and as long as both rows last.
template <class T> T wet_collisions(const WetShock<T>& shock, const T& t) {
  const T free = shock.speed * t / shock.spacing;
  return T(T(2) * free * free * collision_share(wet_progress(shock, t)));
}

/// Energy before anything sticks, E(0) - E_loss 2 (u0 t/l)^2 g(s).
template <class T> T energy(const WetShock<T>& shock, const T& t) {
  return T(initial_energy(shock) - shock.loss * wet_collisions(shock, t));
}

/// The recursion over all pairs of two rows of N/2 particles. Calls visit(time, pairs) for the collisions with time <=
/// until, in no particular order: 1 or 2 pairs, (i,j) with its mirror image (j,i). Returns when the first pair sticks,
/// if that is before `until` (or when a particle may catch up with the one before it in its row); later collisions are
/// not those of a run. Takes as many steps as there are collisions, and memory for the particles that meet.
template <class T, class Visitor>
std::optional<T> cross_rows(const WetShock<T>& shock, const T& until, Visitor&& visit) {
  struct Flight {
    T place, time, speed;  // of a left-mover; a right-mover is its mirror image
  };
  const T loss = shock.specific_loss();
  const T critical = shock.critical_speed();
  const auto start = [&](std::size_t j) {
    return Flight{T(shock.spacing * (T(static_cast<std::int64_t>(j)) + T(1) / T(2))), T(0), shock.speed};
  };
  std::optional<T> end;
  const auto ends = [&](const T& time) {
    if (!end || time < *end) end = time;
  };
  std::vector<Flight> left_movers;                                    // after meeting the right-movers before i
  std::size_t reach = static_cast<std::size_t>(shock.particles / 2);  // particles that right-mover i can meet
  for (std::size_t i = 0; i < reach; ++i) {
    if (i == left_movers.size()) left_movers.push_back(start(i));
    Flight right = left_movers[i];
    right.place = T(-right.place);
    std::size_t j = i;
    for (; j < reach; ++j) {
      if (j == left_movers.size()) left_movers.push_back(start(j));
      Flight& left = left_movers[j];
      const T w = right.speed + left.speed;
      const T time = (left.place - right.place + left.speed * left.time + right.speed * right.time) / w;
      if (time < left.time || time < right.time) {
        ends(right.time);
        break;
      }
      if (time > until) break;
      if (!(w > critical)) {
        ends(time);
        break;
      }
      visit(time, i == j ? 1 : 2);
      const T place = right.place + right.speed * (time - right.time);
      const T lost = speed_lost(loss, w, critical);
      right = {place, time, T(right.speed - lost)};
      left = {place, time, T(left.speed - lost)};
    }
    reach = j;
  }
  return end;
}

}  // namespace cradle::theory
