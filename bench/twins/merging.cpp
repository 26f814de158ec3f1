#include "merging.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace twins {

constexpr auto none = std::numeric_limits<std::uint32_t>::max();

MergingEngine::MergingEngine(const cradle::Particles<double>& particles, double loss)
    : loss_(loss), circumference_(particles.circumference()), heap_({}) {
  const auto count = static_cast<std::uint32_t>(particles.count());
  for (std::uint32_t b = 0; b < count; ++b)
    particles_.push_back({{particles.position(b), particles.velocity(b), 0}, particles.mass(b), b - 1, b + 1});
  particles_.front().left = circumference_ > 0 ? count - 1 : none;
  particles_.back().right = circumference_ > 0 ? 0 : none;
  std::vector<double> times;
  for (std::uint32_t b = 0; b < count; ++b) times.push_back(due(b, 0));
  heap_ = IndexedHeap(std::move(times));
}

double MergingEngine::due(std::uint32_t i, double now) const {
  const Particle& left = particles_[i];
  if (left.right == none || left.right == i) return never;
  const Particle& right = particles_[left.right];
  const double closing = left.v - right.v;
  if (!(closing > 0)) return never;
  const double around = left.right < i ? circumference_ : 0;
  return now + std::max(right.at(now) + around - left.at(now), 0.0) / closing;
}

void MergingEngine::advance(double until) {
  for (;;) {
    const auto [time, i] = heap_.first();
    if (time > until) return;
    Particle& left = particles_[i];
    const std::uint32_t j = left.right;
    Particle& right = particles_[j];
    left.advance(time);
    right.advance(time);
    ++collisions_;
    const double closing = left.v - right.v, reduced = left.m * right.m / (left.m + right.m);
    const double centre = (left.m * left.v + right.m * right.v) / (left.m + right.m);
    if (reduced * closing * closing / 2 > loss_ && loss_ >= 0) {
      const double after = std::sqrt(closing * closing - 2 * loss_ / reduced);
      std::swap(left.m, right.m);
      left.v = centre - after * right.m / (left.m + right.m);
      right.v = centre + after * left.m / (left.m + right.m);
      heap_.update(j, due(j, time));
      heap_.update(i, due(i, time));
    } else {
      left.v = centre;
      left.m += right.m;
      left.right = right.right;
      if (left.right != none) particles_[left.right].left = i;
      heap_.update(j, never);
      heap_.update(i, due(i, time));
    }
    if (left.left != none) heap_.update(left.left, due(left.left, time));
  }
}

}  // namespace twins
