#pragma once
// Where particles are between two collisions, x = place + velocity (t - origin) + a t^2/2, and when two of them meet.
// The origin is the start; but where a map of collisions is not linear, errors of velocities would act on places from
// there at every collision. Then it is the time of the particle's last collision, and where two meet, a time near that.
// Under gravity, of the acceleration a, lines hold places and velocities as seen by one who has fallen since the start:
// there particles fly straight. Walls do not fall, and their lines are what they are.

#include <memory>
#include <utility>

#include "cradle/core/certify/certain_law.hpp"
#include "cradle/core/certify/world_lines.hpp"

namespace cradle {

template <Enclosing N> struct Motion {
  using Line = WorldLine<N>;

  Motion(std::shared_ptr<const Particles<N>> particles, const CertainLaw<N>& law)
      : lines(std::move(particles), !law.bounces_only()), length(lines.particles().circumference()),
        acceleration(lines.particles().acceleration()), falls(lines.particles().fall()),
        of_collisions(!law.linear() || (falls && lines.particles().walled())) {}

  [[gnu::always_inline]] N place_at(ParticleIndex b, const N& time) const {
    const Line& line = lines[b];
    const N flown = line.place + line.velocity * (of_collisions ? time - origin(line) : time);
    if (!falls || lines.is_wall(b)) return flown;
    return flown + fallen(time);
  }
  N velocity_at(ParticleIndex b, const N& time) const {
    if (!falls || lines.is_wall(b)) return lines[b].velocity;
    return lines[b].velocity + acceleration * time;
  }
  N fallen(const N& time) const { return acceleration * (time * time) / N(2); }

  // Places of both at one time, in the image of the one on the right.
  struct Places {
    N left, right, time{0};
  };
  Places places_of(const Line& l, const Line& r, const N& closing, bool over_seam) const {
    Places at{l.place, r.place};
    if (over_seam) at.left -= length;
    if (!of_collisions) return at;
    const N &of_l = origin(l), &of_r = origin(r);
    const N then = to_double(of_l) < to_double(of_r) ? of_r : of_l;
    at.left += l.velocity * (then - of_l), at.right += r.velocity * (then - of_r);
    const N near = N((then - (at.left - at.right) / closing).middle(), 0), on = near - then;
    return {at.left + l.velocity * on, at.right + r.velocity * on, near};
  }
  // The time that a line's place is of.
  N origin(const Line& line) const { return of_collisions && line.touched ? N(line.changed.middle(), 0) : zero; }

  Order compare(const N& x, const N& y) const {
    const Order order = order_in_doubles(x, y);
    if (order != Order::open) return order;
    needed_balls = true;
    return order_in_balls(x, y);
  }

  WorldLines<N> lines;
  N length, acceleration, zero{0};
  bool falls, of_collisions;
  mutable bool needed_balls = false;  // since it was reset: plain doubles did not decide
};

}  // namespace cradle
