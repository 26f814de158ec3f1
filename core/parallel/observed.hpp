#pragma once
// Collisions of a time slab for an observer. Each segment logs its own (segment.hpp); all logs together are sorted by
// (exact time, place), which is the order of the plain loop: README.md (Observers) says why.
//
// The times of a time slab are spread over it about evenly, and those of a log nearly in order. So the collisions go
// into buckets of time, twice as many as there are of them; what is left to sort are those that share a bucket. Buckets
// are chosen by times rounded to double, which keeps their order in every type.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "cradle/core/initial/particles.hpp"

namespace cradle {

// Parts add which particles they are, where that does not follow from the place.
template <Real T> struct ObservedCollision {
  T time, closing_speed;                       // local; before the collision
  ParticleIndex place;                         // in the order of the line
  std::uint32_t below_cutoff = 0, merges = 0;  // how many it counts for
};

template <class Collision> class ObservedInOrder {
 public:
  // What all the reports have logged.
  template <class Reports> const std::vector<Collision>& of(const Reports& reports) {
    const auto each = [&](auto visit) {
      for (const auto& report : reports)
        for (const Collision& collision : report.observed) visit(collision, to_double(collision.time));
    };
    double first = std::numeric_limits<double>::infinity(), last = -first;  // about
    std::size_t count = 0;
    for (const auto& report : reports) {
      if (report.observed.empty()) continue;
      first = std::min(first, to_double(report.observed.front().time));
      last = std::max(last, to_double(report.observed.back().time));
      count += report.observed.size();
    }
    const double buckets = 2 * static_cast<double>(count), rate = buckets / (last - first);
    const auto bucket = [&, one = !std::isfinite(rate)](double time) -> std::size_t {
      const double place = (time - first) * rate;
      return one || !(place > 0) ? 0 : static_cast<std::size_t>(std::min(place, buckets));
    };
    place_.assign(2 * count + 1, 0);
    each([&](const Collision&, double time) { ++place_[bucket(time)]; });
    constexpr std::uint32_t few = 16;
    many_.clear();
    std::uint32_t before = 0;
    for (std::uint32_t& place : place_) {
      if (place > few) many_.emplace_back(before, before + place);
      before += std::exchange(place, before);
    }
    all_.resize(count);
    each([&](const Collision& collision, double time) { all_[place_[bucket(time)]++] = collision; });
    const auto at = [&](std::size_t k) { return all_.begin() + static_cast<std::ptrdiff_t>(k); };
    for (const auto& [from, to] : many_) std::sort(at(from), at(to), comes_before);
    for (std::size_t k = 1; k < count; ++k)
      if (comes_before(all_[k], all_[k - 1])) put_back(k);
    return all_;
  }

 private:
  static bool comes_before(const Collision& a, const Collision& b) {
    return a.time < b.time || (a.time == b.time && a.place < b.place);
  }
  void put_back(std::size_t k) {
    const Collision collision = all_[k];
    for (; k > 0 && comes_before(collision, all_[k - 1]); --k) all_[k] = all_[k - 1];
    all_[k] = collision;
  }

  std::vector<Collision> all_;
  std::vector<std::uint32_t> place_;                       // where the next collision of each bucket goes
  std::vector<std::pair<std::size_t, std::size_t>> many_;  // buckets that hold many
};

}  // namespace cradle
