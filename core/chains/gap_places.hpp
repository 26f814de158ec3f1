#pragma once
// The state of the gaps of a chain (held_gaps.hpp) in positions and velocities, with its energy and what rounding
// leaves open. On a line, sums from the left anchor give both, and must lead to the right one; the difference, the
// closure error, is distributed over the particles between. On a ring positions follow from the centre of mass and
// velocities from the total momentum; the closure error is the difference between the circumference and the sum of the
// gaps.

#include <limits>

#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/chains/held_gaps.hpp"
#include "cradle/core/queue/relative_motion.hpp"

namespace cradle {

template <Real T, class Masses> class GapPlaces : public HeldGaps<T, Masses> {
  using Held = HeldGaps<T, Masses>;

 public:
  using Held::closing, Held::closing_at, Held::gap_at;
  using Held::falls, Held::clock, Held::first, Held::last, Held::on_ring, Held::particle;
  using typename Held::Line;

  // The left particle of a gap for which rounding may decide whether it closes up to a local time, which must not be
  // before the last collision. Where deviations are not watched, they are taken for a few roundings of the largest
  // speed at the start.
  std::optional<ParticleIndex> uncertain_at(const T& time) const {
    for (Slot s = first(); s <= last(); ++s)
      if (open(s, time)) return particle(s);
    return {};
  }
  // About how far rounding has moved the kinetic energy by this time, from the larger sample.
  T energy_deviation(const T& time) const requires(Line::watched) {
    const T energy = kinetic_energy(time);
    T largest = magnitude(T(kinetic_energy(T(time + off_by(time))) - energy));
    for (std::size_t sample = 0; sample < 2; ++sample) {
      const T off = kinetic_energy(time, [&](Slot s) {
        return wall_gaps_.with_motion(line_, [&](const auto& motion) {
          return T(closing_at(s, time) + line_.certainty.closing_off(line_.gaps, motion, s, time, sample));
        });
      });
      largest = std::max(largest, magnitude(T(off - energy)));
    }
    return largest;
  }

  // ---- reading, at a local time not before the last collision
  T front_left(const T& time) const {
    const Pair<T> x = flight(left_, time).x;
    const ParticleIndex outermost = front_particle(End::left);  // next to the anchor, if not the anchor
    return (outermost > left_.particle() ? x + gap_at(slot(outermost) - 1, time) : x).value();
  }
  T front_right(const T& time) const {
    const Pair<T> x = flight(right_, time).x;
    const ParticleIndex outermost = front_particle(End::right);
    return (outermost < right_.particle() ? x - gap_at(slot(outermost), time) : x).value();
  }
  // Of all particles of the scene; reads all held gaps.
  T kinetic_energy(const T& time) const {
    return kinetic_energy(time, [&](Slot s) { return closing_at(s, time); });
  }

  // The particles that have collided and the next one on each side; before the first collision all held ones. On a ring
  // all particles, from the first one right of x = 0.
  Configuration<T> configuration(const T& time) const {
    const bool collided = range_.has_fronts();
    const Slot from = collided && range_.front_left() > first() ? range_.front_left() - 1 : first();
    const Slot to = collided && range_.front_right() < last() ? range_.front_right() + 1 : last();
    const Slot end = on_ring() ? to : to + 1;  // of the last particle
    const auto n = static_cast<std::size_t>(end + 1 - from);

    Configuration<T> c;
    c.reserve(n);
    c.time = clock().time(time);
    c.speeds_are_sums = !line_.exact_sums();
    for (Slot s = from; s <= end; ++s) {
      c.index.push_back(particle(s));
      c.m.push_back(line_.masses[s]);
    }
    c.from = particle(from), c.to = particle(end);
    if (on_ring()) c.collided_to = n;
    if (collided) c.collided_from = range_.front_left() - from, c.collided_to = range_.front_right() - from + 2;
    Sums sums;
    sums.ways.reserve(n + 1), sums.slowings.reserve(n + 1);
    for (Slot s = from; s <= to; ++s) {
      c.gap.push_back(gap_at(s, time));
      c.closing_speed.push_back(closing_at(s, time));
      sums.way.add(c.gap.back());
      if (falls())
        sums.slowing.add(c.closing_speed.back());
      else
        line_.add_closing(s, sums.slowing);
      sums.ways.push_back(sums.way.value());
      sums.slowings.push_back(line_.exact_sums() ? sums.slowing.pair() : Pair<T>{sums.slowing.value(), T(0)});
    }
    if (on_ring())
      place_on_ring(c, sums, time);
    else
      place_on_line(c, sums, time);
    return c;
  }

 protected:
  using Held::Held, Held::line_, Held::range_, Held::particles_, Held::walls_, Held::wall_gaps_, Held::left_,
      Held::right_;
  using Held::slot, Held::front_particle, Held::centre_, Held::fastest_;

  Flight<T> flight(const Anchor<T>& anchor, const T& time) const {
    if (falls() && wall_gaps_.holds_all() && particles_->wall_at(anchor.particle()) == nullptr) return from_wall(time);
    return anchor.flight(*particles_, clock(), time);
  }
  // Enters it in the account if closing speeds have lost their digits (see `closed`).
  void find_lost_digits(const T& time) {
    if (!closed() || line_.exact_sums() || line_.gaps.account().uncertain > 0) return;
    const Wall<T>*left = particles_->wall(End::left), *right = particles_->wall(End::right);
    EnergySum<T> missing;
    if (left != nullptr) missing.add(right->speed), missing.add(T(-left->speed));
    T fastest(0);
    for (Slot s = first(); s <= last(); ++s) {
      missing.add(closing(s));
      fastest = std::max(fastest, magnitude(closing(s)));
    }
    const T off =
        T(certain_by) * std::max(magnitude(missing.value()), T(T(std::numeric_limits<T>::epsilon()) * fastest_));
    if (fastest < off) line_.gaps.doubt({clock().time(time), particle(first()), T(off * clock().elapsed(time))});
  }

 private:
  // The flight of a particle that rests on a wall, alone or on a pile of all others, or of a single one that may rest
  // there.
  Flight<T> from_wall(const T& time) const {
    const bool left = particles_->holding() == particles_->wall(End::left);
    const Slot s = left ? first() : last();
    const T gap = gap_at(s, time), speed = closing_at(s, time);
    const Flight<T> wall = at_wall(*particles_, left ? -1 : particles_->count(), clock().since_start(time));
    return left ? Flight<T>{wall.x + gap, wall.v - speed} : Flight<T>{wall.x - gap, wall.v + speed};
  }

  template <class Closing> T kinetic_energy(const T& time, const Closing& speed_of) const {
    const T total = particles_->total_mass();
    T drift = particles_->conserved_momentum() / total;
    if (falls()) drift += wall_gaps_.acceleration() * clock().elapsed(time);
    const ParticleIndex count = particles_->count();
    const bool from_wall = particle(first()) < 0, to_wall = !on_ring() && particle(last()) + 1 == count;
    const T left = from_wall ? T(0) : particles_->mass_between(0, particle(first()) + 1);
    const T right = to_wall ? T(0) : particles_->mass_between(on_ring() ? count - 1 : particle(last()) + 1, count);
    const Slot end = on_ring() ? last() : last() + 1;
    const T known = on_ring() || walls_.any() ? T(0)
                    : falls()                 ? T(flight(left_, time).v.value() - drift)
                                              : T(left_.velocity(*particles_) - drift);
    T at_end(0);  // the last one's x, with c = 0
    const auto moving = relative_motion(total, known, [&](const T& c, const auto& add) {
      EnergySum<T> slowing;
      add(left, T(-c));
      for (Slot s = first(); s < end; ++s) {
        slowing.add(speed_of(s));
        add(s + 1 < end ? line_.masses[s + 1] : right, less(slowing, c));
      }
      at_end = slowing.value();
    });
    const Pair<T> elapsed = clock().since_start(time);
    const T speed = from_wall ? T(at_wall(*particles_, -1, elapsed).v.value() - moving.mean)
                    : to_wall ? T(at_wall(*particles_, count, elapsed).v.value() + (at_end - moving.mean))
                              : drift;
    return total * speed * speed / T(2) + moving.energy;
  }

  // On a ring, or between two walls that are not shaken, closing speeds add up to a number that is known. What their
  // sum misses of it is rounding, of the size of that of the first closing speeds: a system that has cooled to that
  // size is another one.
  bool closed() const { return on_ring() || (!falls() && walls_.has(End::left) && walls_.has(End::right)); }
  static constexpr int certain_by = 64;  // as in Deviation
  // How much the rounding of the first and of this time leaves open of the time between them, which decimals give.
  T off_by(const T& time) const {
    return T(std::numeric_limits<T>::epsilon()) * (magnitude(clock().start()) + magnitude(clock().time(time)));
  }
  // Whether a collision at this gap may come before or after the end of the run.
  bool open(Slot s, const T& time) const {
    const T gap = gap_at(s, time), speed = closing_at(s, time);
    // Around a ring the rounding of closing speeds stays; on a line they are soon those of other particles.
    const T epsilon = std::numeric_limits<T>::epsilon();
    const T slow = epsilon * fastest_ * (closed() ? clock().elapsed(time) : magnitude(line_.gaps.flown(s, time)));
    const bool may_be_pulled = Line::watched && falls();
    if (!may_be_pulled && speed == T(0) && !(epsilon * slow < gap)) return false;  // they touch, at rest
    if constexpr (Line::watched)
      return wall_gaps_.with_motion(
          line_, [&](const auto& motion) { return line_.certainty.open(line_.gaps, motion, s, time, off_by(time)); });
    else
      return gap < T(certain_by) * (magnitude(speed) * off_by(time) + slow);
  }

  // Sums of the gaps and of the closing speeds of a configuration, from its first particle on.
  struct Sums {
    CompensatedSum<T> way, slowing;  // over all
    std::vector<T> ways{T(0)};       // to each particle, on a ring at last around it
    std::vector<Pair<T>> slowings{{}};
  };

  void place_on_ring(Configuration<T>& c, Sums& sums, const T& time) const {
    CompensatedSum<T> moment, momentum;
    for (std::size_t j = 0; j < c.m.size(); ++j) moment.add(c.m[j] * sums.ways[j]);
    // If masses are far apart, sums begin at the heaviest particle, so that light ones have the errors.
    if (line_.exact_sums()) {
      const auto heaviest = std::max_element(c.m.begin(), c.m.end()) - c.m.begin();
      const Pair<T> own = sums.slowings[static_cast<std::size_t>(heaviest)];
      for (Pair<T>& each : sums.slowings) each = each - own;
    }
    for (std::size_t j = 0; j < c.m.size(); ++j) momentum.add(c.m[j] * sums.slowings[j].value());
    c.closure_gap = particles_->circumference() - sums.way.value();
    c.closure_speed = -sums.slowing.value();
    const T mass = particles_->total_mass(), drift = particles_->momentum() / mass;
    if (!centre_) centre_ = particles_->centre_of_mass();
    const Pair<T> start = two_sum(*centre_, T(drift * clock().elapsed(time))) - T(moment.value() / mass);
    const T stretch = *c.closure_gap / sums.way.value();
    const T speed = drift + momentum.value() / mass;
    for (std::size_t j = 0; j < c.m.size(); ++j) {
      c.x.push_back((start + T(sums.ways[j] + stretch * sums.ways[j])).value());
      c.v.push_back(speed - sums.slowings[j].value());
    }
    fold(c, particles_->circumference());
  }

  void place_on_line(Configuration<T>& c, const Sums& sums, const T& time) const {
    const Flight<T> left = flight(left_, time), right = flight(right_, time);
    c.closure_gap = difference(right.x, left.x) - sums.way.value();
    c.closure_speed = line_.exact_sums() ? T((left.v - right.v - sums.slowing.pair()).value())
                                         : T(difference(left.v, right.v) - sums.slowing.value());
    const T stretch = sums.way.value() > T(0) ? T(*c.closure_gap / sums.way.value()) : T(0);
    const auto n = static_cast<std::int64_t>(c.m.size());
    for (std::size_t j = 0; j < c.m.size(); ++j) {
      c.x.push_back((left.x + T(sums.ways[j] + stretch * sums.ways[j])).value());
      const T share = n > 1 ? T(T(static_cast<std::int64_t>(j)) / T(n - 1)) : T(0);
      c.v.push_back((left.v - sums.slowings[j].low - T(sums.slowings[j].high + share * *c.closure_speed)).value());
    }
    leave_out_walls(c, particles_->count());
  }
};

}  // namespace cradle
