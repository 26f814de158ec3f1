#pragma once
// The particles that a chain of clusters holds (cluster_chain.hpp), each with the gap behind it: slots, and their state
// in positions. The configuration has the particles that have collided and the next one on each side; before the first
// collision all held particles; on a ring all, from the first one right of x = 0. Positions are computed from a
// particle that has not collided, the one at the left end if there is one, else from the centre of mass. If there is
// one at either end, or on a ring, the sum of the gaps can be checked; closing speeds are differences of velocities and
// always add up.

#include <algorithm>
#include <limits>
#include <optional>

#include "cradle/core/chains/anchor.hpp"
#include "cradle/core/chains/cluster_line.hpp"
#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/chains/gravity.hpp"
#include "cradle/core/chains/held_range.hpp"
#include "cradle/core/queue/relative_motion.hpp"

namespace cradle {

template <Real T> class ClusterPlaces : public HeldLine<T, ClusterLine<T>> {
  using Held = HeldLine<T, ClusterLine<T>>;

 public:
  static constexpr bool may_collapse = false;
  using Held::clock, Held::count, Held::first, Held::last, Held::on_ring;

  // ---- slots: held cells are first() to last(), with vacant ones among them; the last cell has no gap
  Slot left(Slot s) const { return line_.left(s); }
  Slot right(Slot s) const { return line_.right(s); }
  ParticleIndex particle(Slot s) const { return line_.gaps[s].particle; }
  ParticleIndex collided_particles() const { return active_; }

  T due(Slot s) const { return line_.due(s); }
  double queue_due(Slot s) const { return line_.queue_due(s); }
  T closing(Slot s) const { return line_.closing(s); }

  static constexpr bool falls() { return false; }
  std::optional<Rebound<T>> rebound(Slot) const { return {}; }

  // ---- reading, at a local time not before the last collision
  T gap_at(Slot s, const T& time) const { return line_.gaps.gap_at(s, closing(s), time); }
  T front_left(const T& time) const {
    if (first() == range_.front_left()) return configuration(time).x.front();
    const Slot beside = left(range_.front_left());
    return (undisturbed_place(beside, time) + gap_at(beside, time)).value();
  }
  T front_right(const T& time) const {
    const Slot front = range_.front_right();
    if (last() == front) return configuration(time).x.back();
    return (undisturbed_place(right(front), time) - gap_at(front, time)).value();
  }
  // Of all particles of the scene, now; reads all held cells. Particles that are not held move like the outermost
  // held one.
  T kinetic_energy(const T&) const {
    const T total = particles_->total_mass();
    const auto moving = relative_motion(total, T(0), [&](const T& c, const auto& add) {
      for (Slot s = first();; s = right(s)) {
        const Cell<T>& cell = line_.gaps[s];
        T mass = cell.mass;
        if (s == first()) mass += particles_->mass_between(0, range_.unheld_left());
        if (s == last()) mass += particles_->mass_between(count() - range_.unheld_right(), count());
        add(mass, T(cell.velocity - c));
        if (s == last()) break;
      }
    });
    const T momentum = particles_->conserved_momentum();
    return momentum * momentum / (total + total) + moving.energy;
  }

  // A particle at a gap for which rounding may decide whether it closes up to a local time, which must not be before
  // the last collision, or which has just changed by a collision (right of the last particle of a line is none, but the
  // time of its last collision). Deviations are not watched: those of this flight
  // are counted, by its speeds, and the rounding of the first and of this time.
  std::optional<ParticleIndex> uncertain_at(const T& time) const {
    const T roundings = T(64) * T(std::numeric_limits<T>::epsilon());  // as in Deviation
    const T off_by = roundings * (magnitude(clock().start()) + magnitude(clock().time(time)));
    for (Slot s = first();; s = right(s)) {
      const Cell<T>&l = line_.gaps[s], &r = line_.gaps[right(s)];
      const T flown = magnitude(line_.gaps.flown(s, time)), speed = on_ring() || s != last() ? closing(s) : T(0);
      const T fastest = std::max(magnitude(l.velocity), magnitude(r.velocity));
      const bool met_now = !(off_by < flown) && off_by < clock().elapsed(time);
      const auto near = [&] { return gap_at(s, time) < magnitude(speed) * off_by + fastest * flown * roundings; };
      if (met_now || (speed != T(0) && near())) return l.particle;
      if (s == last()) break;
    }
    return {};
  }

  Configuration<T> configuration(const T& time) const {
    const bool collided = range_.has_fronts();
    const Slot from = collided && range_.front_left() > first() ? left(range_.front_left()) : first();
    const Slot to = collided && range_.front_right() < last() ? right(range_.front_right()) : last();
    Configuration<T> c;
    c.time = clock().time(time);
    // A particle that has not collided has its initial number. If all particles at an end have collided, they are
    // numbered from the end of the line.
    const bool free_left = !on_ring() && (!collided || from != range_.front_left());
    const bool free_right = !on_ring() && (!collided || to != range_.front_right());
    c.from = free_left ? particle(from) : 0;
    c.to = free_right ? particle(to) : particles_->count() - 1;
    CompensatedSum<T> way, moment, mass;
    std::vector<T> ways;
    for (Slot s = from;; s = right(s)) {
      const Cell<T>& cell = line_.gaps[s];
      c.index.push_back(cell.particle);
      c.m.push_back(cell.mass);
      c.v.push_back(cell.velocity + frame_);
      ways.push_back(way.value());
      moment.add(cell.mass * ways.back());
      mass.add(cell.mass);
      if (s == to && !on_ring()) break;
      c.gap.push_back(gap_at(s, time));
      c.closing_speed.push_back(closing(s));
      way.add(c.gap.back());
      if (s == to) break;
    }
    Pair<T> leftmost;
    if (free_left) {
      leftmost = undisturbed_place(from, time);
      if (free_right) c.closure_gap = difference(undisturbed_place(to, time), leftmost + way.sum + way.errors);
    } else if (free_right) {
      leftmost = undisturbed_place(to, time) - way.value();
    } else {
      leftmost = two_sum(centre_ ? *centre_ : particles_->centre_of_mass(), T(frame_ * clock().elapsed(time)));
      leftmost = leftmost - T((moment.value() - carried_.value() * particles_->circumference()) / mass.value());
    }
    for (const T& w : ways) c.x.push_back((leftmost + w).value());
    if (collided || on_ring()) c.collided_from = free_left ? 1 : 0, c.collided_to = c.x.size() - (free_right ? 1 : 0);
    if (on_ring()) {
      c.closure_gap = particles_->circumference() - way.value();
      fold(c, particles_->circumference());
    }
    return c;
  }

  ParticleIndex place(Slot s) const { return static_cast<ParticleIndex>(s); }  // in the order of the line

 protected:
  using Held::line_, Held::particles_, Held::range_;

  ClusterPlaces(const std::shared_ptr<const Particles<T>>& particles, const T& start, GapRange held)
      // No speed exceeds 1 + 2E/m >= sqrt(2E/m).
      : Held(particles, start,
             {start, particles->energy_to_lose(), T(T(2) + T(4) * particles->energy_over_least_mass())},
             {particles->on_ring(), held.first, particles->count() - 2 - held.last, 3}),
        frame_(particles->momentum() / particles->total_mass()) {
    require_no_gravity(*particles_, "particles that merge have none");
  }

  // Position of a particle that has not collided.
  Pair<T> undisturbed_place(Slot s, const T& time) const {
    return undisturbed(*particles_, particle(s), clock().elapsed(time)).x;
  }

  std::size_t vacated_ = 0;   // since the last layout
  ParticleIndex active_ = 0;  // particles from one front to the other, both included
  Slot beyond_ = 0;          // the cell with the gap right of the last collision: of both particles if they have merged
  T frame_;                  // velocity of the centre of mass
  std::optional<T> centre_;  // of mass at the start, on a line without other known positions
  CompensatedSum<T> carried_;  // mass across the seam of a ring, see cross_seam
};

}  // namespace cradle
