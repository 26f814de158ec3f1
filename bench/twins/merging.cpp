#include "merging.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace twins {

namespace {
constexpr auto none = std::numeric_limits<std::uint32_t>::max();
}

MergingEngine::MergingEngine(const cradle::Bodies<double>& bodies, double loss)
    : loss_(loss), circumference_(bodies.circumference()), heap_({}) {
  const auto count = static_cast<std::uint32_t>(bodies.count());
  for (std::uint32_t b = 0; b < count; ++b)
    bodies_.push_back({bodies.position(b), bodies.velocity(b), bodies.mass(b), 0, b - 1, b + 1});
  bodies_.front().left = circumference_ > 0 ? count - 1 : none;
  bodies_.back().right = circumference_ > 0 ? 0 : none;
  std::vector<double> times;
  for (std::uint32_t b = 0; b < count; ++b) times.push_back(due(b, 0));
  heap_ = IndexedHeap(std::move(times));
}

double MergingEngine::due(std::uint32_t i, double now) const {
  const Body& left = bodies_[i];
  if (left.right == none || left.right == i) return never;
  const Body& right = bodies_[left.right];
  const double closing = left.v - right.v;
  if (!(closing > 0)) return never;
  const double around = left.right < i ? circumference_ : 0;
  const double gap = right.x + right.v * (now - right.time) + around - (left.x + left.v * (now - left.time));
  return now + std::max(gap, 0.0) / closing;
}

void MergingEngine::fly(Body& body, double time) const {
  body.x += body.v * (time - body.time);
  body.time = time;
}

void MergingEngine::advance(double until) {
  for (;;) {
    const std::uint32_t i = heap_.first();
    const double time = heap_.due(i);
    if (time > until) return;
    Body& left = bodies_[i];
    const std::uint32_t j = left.right;
    Body& right = bodies_[j];
    fly(left, time);
    fly(right, time);
    ++contacts_;
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
      ++merges_;
      left.v = centre;
      left.m += right.m;
      left.right = right.right;
      if (left.right != none) bodies_[left.right].left = i;
      heap_.update(j, never);
      heap_.update(i, due(i, time));
    }
    if (left.left != none) heap_.update(left.left, due(left.left, time));
  }
}

}  // namespace twins
