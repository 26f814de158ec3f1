#pragma once
// Histograms of collisions, and of gaps and clusters at sampling times. They count, so they add in any order.
//
// Bins are nearly logarithmic: every octave has eight of equal width. The bin of a number follows from the leading bits
// of its double, and the edges are exact, on every machine. Numbers of collisions have bins of their own up to 8.
//
// What is counted (a wall is no particle; flights that the start or the end of the run cuts short are not counted):
//   free_flight, pair_flight      time between two collisions of a particle, with anything; of a pair of neighbours
//   closing_speed                 of two particles at their collisions
//   dissipative_closing_speed     of those that are by the law, not below a cut-off or within the contact time
//   collisions_per_particle       over all particles of the scene
//   gap, cluster                  between neighbours; particles of a cluster, whose gaps are below a given one

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/engine/status.hpp"

namespace cradle {

// Bin 0 is below all others, the last one above them.
class OctaveBins {
 public:
  // Of positive numbers; covers the range from `low` to `high`.
  static OctaveBins of_numbers(double low, double high) { return {0, leading(low), leading(high) + 1}; }
  // Of whole numbers from 0 on, up to 2^40.
  static OctaveBins of_counts() { return {8, leading(8), leading(0x1p40)}; }

  std::size_t size() const { return singles_ + static_cast<std::size_t>(last_ - first_) + (singles_ > 0 ? 1 : 2); }
  std::size_t operator()(double x) const {
    if (singles_ > 0 && x < static_cast<double>(singles_)) return static_cast<std::size_t>(x);
    const std::int64_t bin = std::clamp(leading(x), first_ - 1, last_) - first_ + 1;
    return static_cast<std::size_t>(bin) + (singles_ > 0 ? singles_ - 1 : 0);
  }
  // Where bins begin; the last one ends at infinity.
  std::vector<double> low() const {
    std::vector<double> edges;
    for (std::size_t k = 0; k < singles_; ++k) edges.push_back(static_cast<double>(k));
    if (singles_ == 0) edges.push_back(0);
    for (std::int64_t bin = first_; bin <= last_; ++bin) edges.push_back(std::bit_cast<double>(bin << shift));
    return edges;
  }

 private:
  static constexpr int shift = 49;  // leaves sign, exponent and three bits: eight bins in an octave
  OctaveBins(std::size_t singles, std::int64_t first, std::int64_t last)
      : singles_(singles), first_(first), last_(last) {}
  static std::int64_t leading(double x) { return std::bit_cast<std::int64_t>(x) >> shift; }

  std::size_t singles_;
  std::int64_t first_, last_;
};

// Whole numbers that are spaced nearly logarithmically: 1, 2, ..., 16, 18, ..., 32, 36, ..., 64, 72, ...; beyond 8,
// eight in every octave. Lags of correlations and wave numbers are such multiples.
inline std::vector<std::uint64_t> octave_steps(std::uint64_t last) {
  std::vector<std::uint64_t> steps;
  for (std::uint64_t n = 1, step = 1; n <= last; n += step) {
    steps.push_back(n);
    if (n == 16 * step) step *= 2;
  }
  return steps;
}

class OctaveHistogram {
 public:
  explicit OctaveHistogram(const OctaveBins& bins) : bins_(bins), counts_(bins.size()) {}
  void add(double x, std::uint64_t times = 1) { counts_[bins_(x)] += times; }
  const OctaveBins& bins() const { return bins_; }
  const std::vector<std::uint64_t>& counts() const { return counts_; }
  static auto state(auto& self) { return fields(self.counts_); }
  void loaded() const { require_state(counts_.size() == bins_.size(), "bins of a histogram"); }

 private:
  OctaveBins bins_;
  std::vector<std::uint64_t> counts_;
};

template <Real T> class CollisionHistograms {
 public:
  // Of collisions of so many particles from `from` to `until`; `flights`: also what needs the past of every particle.
  CollisionHistograms(const T& from, const T& until, const OctaveBins& bins, ParticleIndex particles, bool flights)
      : from_(from), until_(until), particles_(particles), flights_(flights), free_flights(bins), pair_flights(bins),
        closing_speeds(bins), dissipative_speeds(bins) {}

  // Call both for every collision before it is made, in order: first with the counts until then.
  void made(const Counts& now) {
    if (pending_ && now.below_cutoff == below_cutoff_) dissipative_speeds.add(*pending_);
    pending_.reset();
    below_cutoff_ = now.below_cutoff;
  }
  void operator()(const Collision<T>& c) {
    const T time = c.time.value();
    const bool counted = !(time < from_) && !(until_ < time);
    const bool pair = c.left >= 0 && c.right < particles_;
    if (counted && pair) {
      pending_ = to_double(c.closing_speed);
      closing_speeds.add(*pending_);
    }
    if (!flights_) return;
    for (const ParticleIndex particle : {c.left, c.right}) {
      if (particle < 0 || particle >= particles_) continue;
      Past& past = of(particle);
      if (counted && past.met) free_flights.add(to_double(difference(c.time, past.last)));
      past.met = true, past.last = c.time, past.collisions += counted;
    }
    if (!pair) return;
    Past& past = of(c.left);
    if (counted && past.met_right) pair_flights.add(to_double(difference(c.time, past.last_right)));
    past.met_right = true, past.last_right = c.time;
  }

  OctaveHistogram collisions_per_particle() const {
    OctaveHistogram all(OctaveBins::of_counts());
    for (const Past& past : past_) all.add(static_cast<double>(past.collisions));
    all.add(0, static_cast<std::uint64_t>(particles_) - past_.size());
    return all;
  }

  static auto state(auto& self) {
    return fields(self.free_flights, self.pair_flights, self.closing_speeds, self.dissipative_speeds, self.pending_,
                  self.below_cutoff_, self.first_, self.past_);
  }
  void loaded() const {
    const auto size = static_cast<ParticleIndex>(past_.size());
    require_state(size == 0 || (first_ >= 0 && size <= particles_ && first_ <= particles_ - size), "flights");
  }

 private:
  // Of a particle and its gap on the right, since the start of the run.
  struct Past {
    Pair<T> last, last_right;
    std::uint64_t collisions = 0;  // counted
    bool met = false, met_right = false;
    static auto state(auto& self) {
      return fields(self.last, self.last_right, self.collisions, self.met, self.met_right);
    }
  };

  // Those that have collided are neighbours, in the order of the line.
  Past& of(ParticleIndex particle) {
    if (past_.empty()) first_ = particle;
    for (; particle < first_; --first_) past_.emplace_front();
    const auto place = static_cast<std::size_t>(particle - first_);
    if (place >= past_.size()) past_.resize(place + 1);
    return past_[place];
  }

  T from_, until_;
  ParticleIndex particles_;
  bool flights_;
  std::optional<double> pending_;  // closing speed of the last collision, whose kind is not known yet
  std::uint64_t below_cutoff_ = 0;
  ParticleIndex first_ = 0;  // the particle of past_[0]
  std::deque<Past> past_;

 public:
  OctaveHistogram free_flights, pair_flights, closing_speeds, dissipative_speeds;
};

// Calls visit(particles) for every cluster: a largest set of neighbours with gaps < `gap`. Merged ones count as one.
template <Real T, class Visit> void for_each_cluster(const Configuration<T>& c, const T& gap, Visit visit) {
  const std::size_t count = c.x.size();
  const auto close = [&](std::size_t j) { return j < c.gap.size() && c.gap[j] < gap; };  // j and the one behind it
  const bool on_ring = count > 0 && c.gap.size() == count;
  // On a ring begin behind a gap that is not below.
  std::size_t begin = 0;
  while (on_ring && begin < count && close((begin + count - 1) % count)) ++begin;
  if (begin == count) return count > 0 ? visit(count) : void();
  for (std::size_t k = 0, particles = 1; k < count; ++k, ++particles) {
    if (k + 1 < count && close((begin + k) % count)) continue;
    visit(particles);
    particles = 0;
  }
}

}  // namespace cradle
