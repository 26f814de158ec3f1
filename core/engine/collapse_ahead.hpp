#pragma once
// The proof of a collapse. A closed form decides whether two neighbouring gaps collapse, and when: README.md (The
// theorem) has it, and the symbols. How far rounding has moved gaps and closing speeds is bounded, for a few particles,
// from the history of their collisions: README.md (Bounds on rounding) has the maps that the bounds obey. The rounding
// of each operation of a collision is added where it happens.

#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "cradle/core/base/fields.hpp"
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
  static auto state(auto& self) { return fields(self.gap, self.speed); }
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
  static auto state(auto& self) { return fields(self.gaps_); }

 private:
  struct Line {
    T time{0}, closing{0};  // of the last collision at it or beside it, and the closing speed after it
    GapError<T> off;        // at that time
    static auto state(auto& self) { return fields(self.time, self.closing, self.off); }
  };
  std::unordered_map<ParticleIndex, Line> gaps_;
};

// Two gaps just after a collision at one of them, gap 1, "here".
template <Real T> struct TwoGaps {
  T opening;                      // r_1 w_0, w_0 the closing speed of the last collision
  T gap, closing;                 // g and w_1 of gap 2, "there"
  T rebound_here, rebound_there;  // r_1, r_2
  T handed_there, handed_here;    // c_1: added there by a collision here, c_2: added here by one there
  T of_rebound, of_handed;        // relative errors of these
};

// A number with a bound of its error.
template <Real T> struct Bounded { T value{0}, error{0}; };
template <Real T> struct CollapseAhead {
  Bounded<T> time;   // from now to t_c
  Bounded<T> ratio;  // limit of the ratio of successive intervals between collisions at the same gap
};

// Nothing if the two separate, or if rounding leaves that open. The given errors are those of the gaps here (which is
// 0) and there, now.
template <Real T>
std::optional<CollapseAhead<T>> collapse_ahead(const TwoGaps<T>& two, const GapError<T>& of_here,
                                               const GapError<T>& of_there) {
  using std::sqrt;
  const T &e = two.rebound_here, &f = two.rebound_there, unit = Roundoff<T>().unit, quotient = Roundoff<T>().quotient;
  if (!is_positive(e) || !is_positive(f) || !is_positive(two.gap) || !is_positive(two.closing)) return {};
  // Sums of positive numbers have at most the relative errors of their terms and one unit more each. The root of a
  // product has half of the errors of its factors and of the product, and one unit of its own.
  const T coupling = two.handed_there * two.handed_here, mean = sqrt(T(e * f)), least = e + f + mean + mean;
  const T excess = coupling - least;
  const T of_excess = coupling * (T(2) * two.of_handed + unit) + least * (two.of_rebound + T(4) * unit) + unit * excess;
  if (!(excess > of_excess + of_excess)) return {};
  // If x has a relative error d up to 1/2, its root has at most 3 d/5: 1 - sqrt(1 - d) <= (2 - sqrt 2) d.
  const T sum = excess + T(4) * mean, of_sum = of_excess + T(4) * mean * (two.of_rebound + T(3) * unit);
  const T root = sqrt(T(excess * sum)),
          of_root = root * (T(3) * (of_excess / excess + of_sum / sum) / T(5) + T(2) * unit);
  const T larger = (excess + mean + mean + root) / T(2),
          of_larger = (of_excess + of_root) / T(2) + mean * (two.of_rebound + T(2) * unit) + T(2) * unit * larger;

  const T share = two.handed_there / (larger + e),
          of_share = share * ((of_larger + e * two.of_rebound) / (larger + e) + two.of_handed + unit + quotient);
  const T speed = two.closing - share * two.opening;
  const T of_speed = of_there.speed + share * of_here.speed + two.opening * (of_share + unit * share) + unit * speed;
  if (!(speed > of_speed + of_speed)) return {};
  // The line of gap 2 plus k times that of gap 1, which is 0 now, is 0 at t_c.
  const T time = two.gap / speed, of_gaps = of_there.gap + share * of_here.gap, ratio = e * f / (larger * larger);
  const T of_time = (of_gaps + time * of_speed) / (speed - of_speed) + quotient * time;
  if (!is_finite(of_time)) return {};
  return {{{time, of_time},
           {ratio, T(ratio * (T(4) * of_larger / larger + T(2) * two.of_rebound + T(2) * unit + quotient))}}};
}

}  // namespace cradle
