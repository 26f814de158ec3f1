#pragma once
// Inelastic collapse. README.md (Collapse) says what a run does about it, when a collapse is settled (proved), how far
// it is then followed, and where more than `few` particles stop without a proof: at gaps that have shrunk by 2^100,
// since particles that are squeezed between clusters can part after gaps have shrunk by 2^60 and more.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/chains/chain.hpp"
#include "cradle/core/engine/collapse_ahead.hpp"

namespace cradle {

enum class CollapsePolicy {
  cutoff,  // the law prevents it; nothing is done here
  stop     // exact dynamics; stop when the collapse time is known, or when a gap is below a given size
};

// What is known of a collapse when the run stops, in numbers of the scalar type or of what stands for that in a report.
template <class T, class Time = Pair<T>> struct CollapseReport {
  T last_collision{0};          // time of the last collision made
  T interval{0};                // since the previous collision at the same gap, 0 if there was none
  T gap{0};                     // smallest gap beside the last collision, or height of the rebound from a floor
  ParticleIndex particle = -1;  // the particle on the left of the gap of the last collision
  bool settled = false;
  // If it is settled: t_c, the limit of the ratio of successive intervals there, and bounds of their errors.
  Time time{};
  T uncertainty{0}, ratio{0}, ratio_uncertainty{0};

  static auto state(auto& self) {
    return fields(self.last_collision, self.interval, self.gap, self.particle, self.settled, self.time,
                  self.uncertainty, self.ratio, self.ratio_uncertainty);
  }
};

// The proved collapse of two neighbouring gaps, with the best bounds known.
template <Real T> struct KnownCollapse {
  std::uint64_t collisions = 0;  // recorded at these two gaps since it was found
  Pair<T> time;
  T uncertainty{0}, ratio{0}, ratio_uncertainty{0};
  static auto state(auto& self) {
    return fields(self.collisions, self.time, self.uncertainty, self.ratio, self.ratio_uncertainty);
  }
};

template <Real T> struct CollapseWatch {
  static constexpr std::uint64_t most_followed = 1024;  // collisions, once the collapse time is known
  static constexpr ParticleIndex few = 16;

  std::unordered_map<ParticleIndex, T> last;  // local times of collisions, by the particle left of the gap
  std::unordered_map<ParticleIndex, KnownCollapse<T>> known;  // by the particle left of both gaps
  CollapseReport<T> report;
  T fastest{0};            // largest closing or opening speed of a gap until now
  T greatest_approach{0};  // largest speed at which any two particles can ever approach
  GapErrors<T> errors;     // of all gaps, for few particles in a chain of gaps
  static auto state(auto& self) { return fields(self.last, self.known, self.report, self.fastest, self.errors); }

  // Call it before the first collision; `least` is the smallest gap. Returns the floor: gaps below it beside a
  // collision are inspected. For few particles, whose rounding errors are least before their first collisions, all gaps
  // are.
  template <class Chain> T begin(const Chain& chain, const T& least) {
    if constexpr (provable<Chain>) {
      if (in_gaps<Chain> && chain.falls()) return least / T(64);
      using std::sqrt;
      greatest_approach = sqrt(chain.particles().greatest_approach_squared());
      if (chain.particles().count() <= few) {
        for (Slot s = chain.first(); s <= chain.last(); ++s) moves_at(chain.closing(s));
        if constexpr (in_gaps<Chain>) errors.begin(chain.particles(), chain.local_time(chain.start()));
        return far_away<T>();
      }
      fastest = greatest_approach;
    }
    return least / T(64);
  }

  // Records the collision at slot s, which has left a small gap beside it. Returns whether its collapse is settled and
  // has been followed for long enough. `local` is its time as an offset, which resolves intervals that the full time
  // does not; `collisions` is the number of all collisions.
  template <class Law, class Chain>
  bool record(const Law& law, const Chain& chain, Slot s, const T& local, std::uint64_t collisions) {
    const ParticleIndex particle = chain.particle(s);
    const Pair<T> now = chain.stamp(local);
    const auto before = last.find(particle);
    const T nearest = chain.nearest_gap(s);
    const auto back = chain.rebound(s);
    report = {now.value(), before == last.end() ? T(0) : T(local - before->second),
              back && back->height < nearest ? back->height : nearest, particle};
    last.insert_or_assign(particle, local);
    for (const auto& gap : {left_of(chain, s), std::optional(s), right_of(chain, s)})
      if (gap) moves_at(chain.closing(*gap));
    if constexpr (ScaleFreeLaw<Law> && provable<Chain>)
      if (law.scale_free() && !chain.falls()) {  // the theorem is of gaps that are straight lines in time
        if constexpr (in_gaps<Chain>)
          if (errors.kept()) errors.collision(law, chain, left_of(chain, s), s, right_of(chain, s), local);
        for (const bool on_left : {true, false})
          if (const KnownCollapse<T>* found = beside(law, chain, s, on_left, local, collisions)) {
            report.settled = true;
            report.time = found->time, report.uncertainty = found->uncertainty;
            report.ratio = found->ratio, report.ratio_uncertainty = found->ratio_uncertainty;
            const T left = difference(found->time, now);
            return left < chain.time_resolution(s, local) || found->collisions >= most_followed;
          }
      }
    return false;
  }

  // Whether the gap left beside the collision at slot s, recorded before, ends the run of many particles although no
  // collapse is proved there.
  template <class Chain> bool ends_unproved(const Chain& chain, Slot s, const T& gap) const {
    if constexpr (in_gaps<Chain>)
      return !chain.falls() && !report.settled && chain.particles().count() > few && is_positive(gap) &&
             gap < chain.particles().gap(chain.particle(s)) / T(std::int64_t{1} << 50) / T(std::int64_t{1} << 50);
    else
      return false;
  }

  void origin_moved(const T& by) {
    for (auto& [particle, time] : last) time -= by;
    errors.origin_moved(by);
  }

 private:
  // Whether collapses are proved: not in exact types, which have no square roots, nor where particles merge.
  template <class Chain>
  static constexpr bool provable = !std::numeric_limits<T>::is_exact && requires(const Chain& chain) {
    chain.particles();
  };

  // Whether such a chain keeps gaps; the other one derives them from positions.
  template <class Chain> static constexpr bool in_gaps = provable<Chain>&& requires(const Chain& chain) {
    chain.line();
  };

  void moves_at(const T& closing) {
    if (fastest < magnitude(closing)) fastest = magnitude(closing);
  }

  // The collapse of the gap at s, where a collision has just been made, and its left or right neighbour; null if none
  // is known. Each collision may improve the bounds.
  template <class Law, class Chain>
  const KnownCollapse<T>* beside(const Law& law, const Chain& chain, Slot s, bool on_left, const T& local,
                                 std::uint64_t collisions) {
    const auto there = on_left ? left_of(chain, s) : right_of(chain, s);
    if (!there) return nullptr;
    const Slot left = on_left ? *there : s, right = on_left ? s : *there;
    const auto ahead = collapse_of(law, chain, s, *there, local, collisions);
    auto found = known.find(chain.particle(left));
    if (ahead && (found != known.end() || alone(chain, left, right, ahead->time, local))) {
      if (found == known.end()) found = known.try_emplace(chain.particle(left)).first;
      KnownCollapse<T>& k = found->second;
      const Pair<T> time = chain.stamp(local) + ahead->time.value;
      const T uncertainty = of_time(chain, s, time.value(), local, collisions) + ahead->time.error;
      if (k.collisions == 0 || uncertainty < k.uncertainty)
        k = {k.collisions, time, uncertainty, ahead->ratio.value, ahead->ratio.error};
    }
    if (found == known.end()) return nullptr;
    ++found->second.collisions;
    return &found->second;
  }

  template <class Law, class Chain>
  std::optional<CollapseAhead<T>> collapse_of(const Law& law, const Chain& chain, Slot here, Slot there, const T& local,
                                              std::uint64_t collisions) const {
    const auto of_here = chain.at_unit_speed(law, here), of_there = chain.at_unit_speed(law, there);
    if (!of_here || !of_there || !is_positive(chain.closing(there))) return {};
    const bool to_left = there == chain.left(here);
    const bool identical = chain.particles().identical_masses();
    const LawError<T> error_here = law_error(*of_here, identical), error_there = law_error(*of_there, identical);
    const T rebound_here = T(-of_here->closing), rebound_there = T(-of_there->closing),
            &handed_there = to_left ? of_here->to_left : of_here->to_right,
            &handed_here = to_left ? of_there->to_right : of_there->to_left,
            &of_handed_there = to_left ? error_here.to_left : error_here.to_right,
            &of_handed_here = to_left ? error_there.to_right : error_there.to_left;
    if (!is_positive(rebound_here) || !is_positive(rebound_there)) return {};
    const TwoGaps<T> two{T(-chain.closing(here)),
                         chain.gap_at(there, local),
                         chain.closing(there),
                         rebound_here,
                         rebound_there,
                         handed_there,
                         handed_here,
                         std::max<T>(error_here.rebound / rebound_here, error_there.rebound / rebound_there),
                         std::max<T>(of_handed_there / handed_there, of_handed_here / handed_here)};
    if constexpr (in_gaps<Chain>)
      if (errors.kept()) return collapse_ahead(two, errors.at(chain.particle(here)), errors.at(chain.particle(there)));
    // The history is not stored: add up the errors of each collision, with the greatest speeds until now.
    const Roundoff<T> of;
    const T steps = T(static_cast<std::int64_t>(collisions + 1)),
            largest = std::max(error_here.to_left, error_here.to_right),
            times = (of.quotient + of.way + T(3) * of.unit) / T(std::numeric_limits<T>::epsilon());
    const GapError<T> any{T(steps * (times * chain.time_resolution(here, local) * fastest + of.unit * two.gap)),
                          T(steps * (largest + of.unit) * fastest)};
    return collapse_ahead(two, any, any);
  }

  // The error of a time. In gaps the times of collisions are pairs of numbers, and the distance to the next one follows
  // from the gaps; the bound must also hold for a single number. In positions each collision rounds its time.
  template <class Chain>
  static T of_time(const Chain& chain, Slot s, const T& time, const T& local, std::uint64_t collisions) {
    const Roundoff<T> of;
    const T steps = T(static_cast<std::int64_t>(collisions + 1));
    if constexpr (in_gaps<Chain>)
      return of.unit * magnitude(time) * (T(of.nearest ? 1 : 5) + T(8) * steps * of.unit);
    else
      return steps * chain.time_resolution(s, local) / T(2);
  }

  // Whether no other particle can arrive before the collapse; no, if a gap beside the two is not held yet.
  template <class Chain>
  bool alone(const Chain& chain, Slot left, Slot right, const Bounded<T>& ahead, const T& local) const {
    const T reach = T(2) * greatest_approach * (ahead.value + ahead.error);
    const auto far = [&](const std::optional<Slot>& outer, bool at_end) {
      return outer ? reach < chain.gap_at(*outer, local) : at_end;
    };
    const GapRange all = chain.particles().gaps();
    return far(left_of(chain, left), chain.particle(left) == all.first) &&
           far(right_of(chain, right), chain.particle(right) == all.last);
  }

  template <class Chain> static std::optional<Slot> left_of(const Chain& chain, Slot s) {
    return chain.on_ring() || s > chain.first() ? std::optional(chain.left(s)) : std::nullopt;
  }
  template <class Chain> static std::optional<Slot> right_of(const Chain& chain, Slot s) {
    return chain.on_ring() || s < chain.last() ? std::optional(chain.right(s)) : std::nullopt;
  }
};

}  // namespace cradle
