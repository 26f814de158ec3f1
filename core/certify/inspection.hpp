#pragma once
// `Inspection` finds what is certain of all particles at a time up to which their collisions are proved (checker.hpp):
// that every gap is positive then and every collision past, and the numbers of a certificate.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cradle/core/certify/certain_state.hpp"
#include "cradle/core/certify/certain_walls.hpp"
#include "cradle/core/certify/world_lines.hpp"

namespace cradle {

template <Enclosing N> class Inspection {
 public:
  // `now`: those that meet just at this time, if the run ends with that; they are in one place.
  Inspection(const Motion<N>& motion, const CertainWalls<N>& walls, const N& time, const LastMeeting<N>& now)
      : motion_(motion), lines_(motion.lines), walls_(walls), time_(time), now_(now) {
    state.walls = walls.accounts(), state.sizes = walls.sizes();
    if (walls.any()) check_walls();
    check_particles();
  }

  CertainState<N> state;

 private:
  using Line = WorldLine<N>;

  void check_particles() {
    const auto meets = [&](ParticleIndex b) { return b == now_.l || b == now_.r; };
    const bool walled = walls_.any();
    const ParticleIndex first = walled ? std::max<ParticleIndex>(lines_.first(), 0) : lines_.first(),
                        last = walled ? std::min(lines_.last(), lines_.count() - 1) : lines_.last();
    N before{0}, present{0};
    for (ParticleIndex b = first; b <= last; ++b) {
      const N mass = lines_.particles().mass(b), speed = lines_.particles().velocity(b);
      before += mass * squared(speed);
      state.sizes.add(to_double(mass), to_double(speed));
      if (!lines_.is_cluster(b)) continue;
      const Line& line = lines_[b];
      present += lines_.mass(b) * squared(motion_.falls ? motion_.velocity_at(b, time_) : line.velocity);
      const N x = b == ahead_ ? place_ahead_ : motion_.place_at(b, time_);
      widest_ = std::max(widest_, x.radius());
      state.sizes.place = std::max(state.sizes.place, std::abs(to_double(x)));
      if (line.touched && !meets(b))
        if (const Order order = motion_.compare(line.changed, time_); order != Order::less && !state.doubt)
          state.doubt = Doubt<N>{Check::before, order == Order::greater, b, b, line.changed, time_};
      if (walls_.pulled())
        if (auto doubt = walls_.stays_open(motion_, b, time_); doubt && !state.doubt) state.doubt = std::move(doubt);
      const ParticleIndex next = check_pair(b, x);
      if (lines_.on_ring() || !line.touched) continue;
      // Particles that no collision has reached stay between those that one has, in the order of their numbers: the
      // first of several separate regions begins at the front on the left, the last one ends at that on the right.
      const bool begins = lines_.left(b) == lines_.none || !lines_[lines_.left(b)].touched;
      if (begins && !state.front_left) state.front_left = x;
      if (next == lines_.none || !lines_[next].touched) state.front_right = x;
    }
    const bool all = lines_.first() <= 0 && lines_.last() + 1 >= lines_.count();
    const N twice = all ? present : twice_energy_of_others(first, last, before) + present;
    state.energy = twice * (N(1) / N(2));
    if (motion_.falls) state.sizes.fall_energy = fall_energy();
    state.widest = power_of_ten(widest_), state.least_gap = power_of_ten(least_gap_);
    if (of_gap_ >= 0) state.widest_of_gap = power_of_ten(widest_of_gap_) - power_of_ten(gap_of_widest_);
  }
  // Of particles that are not held, which fly on as they began.
  N twice_energy_of_others(ParticleIndex first, ParticleIndex last, const N& twice_of_these) const {
    const Particles<N>& all = lines_.particles();
    const N twice = all.kinetic_energy() * N(2) - twice_of_these;
    if (!motion_.falls) return twice;
    N mass = all.total_mass(), momentum = all.momentum();
    for (ParticleIndex b = first; b <= last; ++b) mass -= all.mass(b), momentum -= all.mass(b) * all.velocity(b);
    const N gained = motion_.acceleration * time_;
    return twice + gained * (N(2) * momentum + mass * gained);
  }
  // The kinetic energy that particles can have gained by falling, at most: all of them to the floor; without one,
  // sum m (v + a t)^2/2 <= sum m v^2 + M (a t)^2.
  double fall_energy() const {
    const Particles<N>& all = lines_.particles();
    const double pull = std::abs(to_double(motion_.acceleration)), mass = to_double(all.total_mass()),
                 time = std::abs(to_double(time_));
    const Wall<N>* floor = all.floor();
    if (floor == nullptr) return to_double(all.kinetic_energy()) + mass * (pull * time) * (pull * time);
    const double moved = std::abs(to_double(floor->speed)) * time, place = to_double(floor->position),
                 highest = std::max(std::abs(to_double(all.position(0)) - place),
                                    std::abs(to_double(all.position(all.count() - 1)) - place));
    return pull * mass * (highest + moved);
  }

  static N squared(const N& x) { return x * x; }
  static double power_of_ten(auto radius) { return static_cast<double>(std::log10(radius)); }
  [[gnu::noinline]] void check_walls() {
    for (const ParticleIndex b : {lines_.first(), lines_.last()}) {
      if (!lines_.is_wall(b)) continue;
      const N x = motion_.place_at(b, time_);
      state.sizes.place = std::max(state.sizes.place, std::abs(to_double(x)));
      check_pair(b, x);
    }
  }
  // The gap right of b, which is at x; returns the particle there.
  ParticleIndex check_pair(ParticleIndex b, const N& x) {
    const ParticleIndex next = lines_.right(b);
    if (next == lines_.none || next == b) return next;
    if (!(b == now_.l && next == now_.r)) check_gap(b, next, x);
    if (walls_.pulled() && (lines_.is_wall(b) || lines_.is_wall(next))) state.over = false;
    if (!state.over) return next;
    const N closing = lines_[b].velocity - lines_[next].velocity;
    state.over = is_negative(closing) || closing == motion_.zero;
    return next;
  }
  void check_gap(ParticleIndex b, ParticleIndex next, const N& x) {
    ahead_ = next, place_ahead_ = motion_.place_at(next, time_);
    N gap = place_ahead_ - x;
    if (b == lines_.seam()) gap += motion_.length;
    if (const Order order = motion_.compare(N(0), gap); order != Order::less && !state.doubt)
      state.doubt = Doubt<N>{Check::gap, order == Order::greater, b, next, N(0), gap};
    least_gap_ = std::min(least_gap_, gap.size());
    const long double of_gap = static_cast<long double>(gap.radius()) / gap.size();
    if (of_gap > of_gap_) of_gap_ = of_gap, widest_of_gap_ = gap.radius(), gap_of_widest_ = gap.size();
  }

  const Motion<N>& motion_;
  const WorldLines<N>& lines_;
  const CertainWalls<N>& walls_;
  const N& time_;
  const LastMeeting<N>& now_;
  ParticleIndex ahead_ = WorldLines<N>::none;  // the one whose place was last needed, for a gap
  N place_ahead_{0};
  // What `state` has as powers of ten; a logarithm for each particle would take a tenth of a proof.
  using Radius = decltype(place_ahead_.radius());
  Radius widest_ = 0, least_gap_ = std::numeric_limits<Radius>::infinity(), widest_of_gap_ = 0, gap_of_widest_ = 1;
  long double of_gap_ = -1;  // the largest radius of a gap against the gap
};

}  // namespace cradle
