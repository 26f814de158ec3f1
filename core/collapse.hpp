#pragma once
// Inelastic collapse: infinitely many contacts in a finite time, at a place where the intervals between contacts shrink
// by a constant factor per cycle. What a run does about it is a declared policy:
//
//   cutoff   contacts below the law's velocity cut-off are elastic (the paper's way; nothing happens here)
//   stop     exact dynamics; stop when the collapse time is settled, or when a gap falls below a given size
//
// The watch extrapolates the collapse time: with d the interval since the last contact at the same gap and r its ratio
// to the one before, t_c = t + d r/(1 - r) (Aitken's delta-squared for a geometric sequence). It is settled when the
// intervals have shrunk by 2^20, by a steady ratio, and t_c moved by less than the chain's resolution of time, twice
// running. Bodies squeezed between dense clusters shrink their intervals for a while too, but by a ratio that drifts. A
// collapse of many bodies without a steady ratio is followed to the end of the type's range.

#include <cstdint>
#include <tuple>
#include <unordered_map>

#include "cradle/core/bodies.hpp"

namespace cradle {

enum class CollapsePolicy { cutoff, stop };

// What is known of a collapse when the run stops.
template <Real T> struct CollapseReport {
  Pair<T> time;         // extrapolated t_c
  T uncertainty{0};     // of t_c: its last movement, at least the type's resolution
  T last_contact{0};    // time of the last contact made
  T interval{0};        // between the last two contacts at the same gap
  T ratio{1};           // of successive intervals there
  T gap{0};             // smallest gap beside the last contact
  BodyIndex body = -1;  // the body on the left of the gap of the last contact
  bool extrapolated = false;

  static auto state(auto& self) {
    return std::tie(self.time, self.uncertainty, self.last_contact, self.interval, self.ratio, self.gap, self.body,
                    self.extrapolated);
  }
};

// The contacts noticed at one gap, by what extrapolation needs of them.
template <Real T> struct CollapseHistory {
  std::uint64_t contacts = 0;
  std::uint64_t steady = 0;  // so many times running the collapse time was settled
  bool extrapolated = false;
  Pair<T> estimate;                            // of the collapse time
  T last{0};                                   // local time of the last contact
  T interval{0}, first_interval{0}, ratio{1};  // since the one before; the first of those shrinking; last two of them

  static auto state(auto& self) {
    return std::tie(self.contacts, self.steady, self.extrapolated, self.estimate, self.last, self.interval,
                    self.first_interval, self.ratio);
  }
};

template <Real T> struct CollapseWatch {
  std::unordered_map<BodyIndex, CollapseHistory<T>> histories;  // by the body on the left of the gap
  CollapseReport<T> report;
  static auto state(auto& self) { return std::tie(self.histories, self.report); }

  // Takes note of a contact next to a small gap; true when the collapse time is settled. `local` is the time as an
  // offset, which resolves intervals that the full time no longer does;
  // `resolution` is what the chain can tell times apart by at that place.
  bool settled(BodyIndex body, const Pair<T>& time, const T& local, const T& gap, const T& resolution) {
    CollapseHistory<T>& h = histories[body];
    const T interval = h.contacts > 0 ? T(local - h.last) : T(0);
    report.last_contact = time.value();
    report.gap = gap;
    report.body = body;
    if (h.contacts > 1 && interval > T(0) && interval < h.interval) {
      const T ratio = interval / h.interval;
      const Pair<T> estimate = time + T(interval * ratio / (T(1) - ratio));
      const T moved = magnitude(difference(estimate, h.estimate));
      // Below the resolution of time nothing moves: what tells a collapse from a chance run of short intervals is that
      // they have shrunk without a break by a factor of a million, by the same ratio to a part in a thousand.
      const bool steady = h.extrapolated && moved < resolution / T(2) && magnitude(ratio - h.ratio) * T(1024) < ratio &&
                          interval * T(1 << 20) < h.first_interval;
      h.steady = steady ? h.steady + 1 : 0;
      h.estimate = estimate;
      h.ratio = ratio;
      h.extrapolated = true;
      report = {estimate, moved > resolution ? moved : resolution, time.value(), interval, ratio, gap, body, true};
    } else {
      h.extrapolated = false;
      h.steady = 0;
      h.first_interval = interval;
    }
    h.interval = interval;
    h.last = local;
    ++h.contacts;
    return h.steady >= 2;
  }

  void origin_moved(const T& by) {
    for (auto& [body, history] : histories) history.last -= by;
  }
};

}  // namespace cradle
