#pragma once
// Bounds on what rounding has done to the gaps and closing speeds of a few particles, from the history of their
// collisions: README.md (Bounds on rounding) has the maps that they obey. The rounding of each operation of a collision
// is added where it happens.

#include <limits>
#include <tuple>
#include <unordered_map>

#include "cradle/core/base/real.hpp"
#include "cradle/core/chains/masses.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

// The largest rounding error of an operation, relative to its result: half of epsilon if it gives the nearest number,
// else epsilon for sums, products and roots, and 4 epsilon for quotients (precision/double_double.hpp).
template <Real T> struct Roundoff {
  static constexpr bool nearest = sums_can_be_exact<T>;
  T unit = T(std::numeric_limits<T>::epsilon()) / T(nearest ? 2 : 1);
  T quotient = nearest ? unit : T(T(4) * unit);
  T way = T(nearest ? 2 : 4) * unit;  // of a time since the local time of a gap, with a moved origin
};

// Bounds on the errors of a gap at some time, and of its closing speed.
template <Real T> struct GapError {
  T gap{0}, speed{0};
  static auto state(auto& self) { return std::tie(self.gap, self.speed); }
};

// Bounds on the errors of the outcome of a collision at the speed 1, computed from the law's decimals.
template <Real T> struct LawError { T rebound, to_left, to_right; };
template <Real T> LawError<T> law_error(const Outcome<T>& at_unit_speed, bool identical_masses) {
  const T rebound = T(-at_unit_speed.closing), &left = at_unit_speed.to_left, &right = at_unit_speed.to_right;
  const Roundoff<T> of;
  const T& unit = of.unit;
  // The errors of r w are those of the decimal and of a product. For r >= 1/2, w - 2 f with f = ((1 + r)/2) w has those
  // of half of the decimal, a sum and a product.
  const bool soft = rebound + rebound < T(1);
  const T own = soft ? T(T(2) * unit * rebound) : T(unit * (T(5) * (left + right) / T(2) + rebound));
  // Half of the velocity exchanged: f, or the result of r w and a sum.
  const T of_half = T(5) * unit / T(2);
  if (identical_masses) return {own, T(of_half * left), T(of_half * right)};
  // The lighter particle's mass over the sum: two decimals, a sum, a quotient; then times the velocity exchanged. The
  // other share is the rest; it includes the rounding of w' if closing speeds add up without error.
  const bool larger_left = right < left;
  const T &small = larger_left ? right : left, &large = larger_left ? left : right;
  const T quotient = small * (T(4) * unit + of.quotient), of_small = of_half * small + quotient,
          of_large = (of_half + unit) * large + quotient + own;
  return {own, larger_left ? of_large : of_small, larger_left ? of_small : of_large};
}

template <Real T> class GapErrors {
 public:
  // Initial errors, at the local time `now`: decimals and their differences are rounded.
  void begin(const Particles<T>& particles, const T& now) {
    const T unit = Roundoff<T>().unit;
    const GapRange all = particles.gaps();
    for (ParticleIndex particle = all.first; particle <= all.last; ++particle) {
      const bool seam = particles.on_ring() && particle == all.last;
      const ParticleIndex next = seam ? 0 : particle + 1;
      const T gap = particles.gap(particle), closing = particles.closing_speed(particle),
              places = magnitude(particles.rounded_place(particle)) + magnitude(particles.rounded_place(next)),
              speeds = magnitude(particles.velocity(particle)) + magnitude(particles.velocity(next));
      gaps_[particle] = {now,
                         closing,
                         {T(unit * (T(2) * gap + places + T(2) * particles.circumference())),
                          T(unit * (speeds + magnitude(closing)))}};
    }
  }
  bool kept() const { return !gaps_.empty(); }

  // Adds the last collision, at slot s and the local time `now`, between the gaps `left` and `right` if these exist.
  template <class Law, class Chain, class Beside>
  void collision(const Law& law, const Chain& chain, const Beside& left, Slot s, const Beside& right, const T& now) {
    const auto unit_speed = chain.at_unit_speed(law, s);
    if (!unit_speed) return;  // a wall that gives energy: nothing is proved there
    const Roundoff<T> of;
    const T rebound = T(-unit_speed->closing);
    const LawError<T> error = law_error(*unit_speed, chain.particles().identical_masses());
    // The line here at the time of the collision, which is rounded.
    Line& here = gaps_[chain.particle(s)];
    const T w = here.closing, since = magnitude(T(now - here.time));
    const GapError<T> off{T(here.off.gap + since * here.off.speed +
                            w * ((of.quotient + of.way) * since + T(2) * of.unit * magnitude(now))),
                          here.off.speed};
    here = {now, chain.closing(s), {T(rebound * off.gap), T(rebound * off.speed + w * error.rebound)}};
    const auto hand = [&](Slot to, const T& share, const T& of_share) {
      Line& there = gaps_[chain.particle(to)];
      const T way = magnitude(T(now - there.time));
      // Before the collision or, if it comes late, after it.
      const T fastest = magnitude(there.closing) + share * w;
      there.off.gap += way * there.off.speed + way * fastest * (of.way + of.unit) +
                       of.unit * magnitude(chain.gap_at(to, now)) + share * off.gap;
      there.off.speed += share * off.speed + of_share * w + of.unit * magnitude(chain.closing(to));
      there.time = now, there.closing = chain.closing(to);
    };
    if (left) hand(*left, unit_speed->to_left, error.to_left);
    if (right) hand(*right, unit_speed->to_right, error.to_right);
  }
  // The error of the gap right of a particle, after the last collision at it or beside it. Second orders are left out
  // of the bounds, which are themselves rounded: about 20 units per collision, far less than 1/64 of the bounds.
  GapError<T> at(ParticleIndex particle) const {
    const auto found = gaps_.find(particle);
    if (found == gaps_.end()) return {far_away<T>(), far_away<T>()};
    const GapError<T>& off = found->second.off;
    return {T(off.gap + off.gap / T(64)), T(off.speed + off.speed / T(64))};
  }

  void origin_moved(const T& by) {
    for (auto& [particle, line] : gaps_) line.time -= by;
  }
  static auto state(auto& self) { return std::tie(self.gaps_); }

 private:
  struct Line {
    T time{0}, closing{0};  // of the last collision at it or beside it, and the closing speed after it
    GapError<T> off;        // at that time
    static auto state(auto& self) { return std::tie(self.time, self.closing, self.off); }
  };
  std::unordered_map<ParticleIndex, Line> gaps_;
};

}  // namespace cradle
