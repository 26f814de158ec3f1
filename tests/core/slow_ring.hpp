#pragma once
// Bodies on a ring in the plainest form, twin of the chains on a ring: positions and velocities, all bodies advanced
// from contact to contact, the next one found by looking at every pair of neighbours.

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/bodies.hpp"
#include "cradle/core/law.hpp"

namespace cradle::test {

template <Real T> class SlowRing {
 public:
  struct Body {
    T x, v, m;  // x unwrapped: those of the list increase and span less than the circumference
    BodyIndex index;
  };

  explicit SlowRing(const Bodies<T>& bodies) : length_(bodies.circumference()) {
    for (BodyIndex b = 0; b < bodies.count(); ++b)
      ring_.push_back({bodies.position(b), bodies.velocity(b), bodies.mass(b), b});
  }

  template <class Law> void advance(const Law& law, const T& until) {
    while (ring_.size() > 1) {
      std::optional<T> soonest;
      std::size_t left = 0;
      for (std::size_t i = 0; i < ring_.size(); ++i) {
        const T closing = ring_[i].v - ring_[next(i)].v;
        if (!(closing > T(0))) continue;
        const T due = time_ + gap(i) / closing;
        if (!soonest || due < *soonest) soonest = due, left = i;
      }
      if (!soonest || *soonest > until) break;
      fly(*soonest);
      collide(law, left);
      ++contacts;
    }
    fly(until);
  }

  // As they are told, from the first one on the left; on a ring so large that nothing comes round: a line.
  const std::vector<Body>& unfolded() const { return ring_; }
  // From the first body right of 0.
  std::vector<Body> folded() const {
    std::vector<Body> bodies = ring_;
    for (Body& b : bodies) {
      while (b.x < T(0)) b.x += length_;
      while (!(b.x < length_)) b.x -= length_;
    }
    std::sort(bodies.begin(), bodies.end(), [](const Body& a, const Body& b) { return a.x < b.x; });
    return bodies;
  }

  std::uint64_t contacts = 0, merges = 0;

 private:
  std::size_t next(std::size_t i) const { return i + 1 < ring_.size() ? i + 1 : 0; }
  T gap(std::size_t i) const {
    return i + 1 < ring_.size() ? T(ring_[i + 1].x - ring_[i].x) : T(ring_[0].x + length_ - ring_[i].x);
  }
  void fly(const T& time) {
    for (Body& b : ring_) b.x += b.v * (time - time_);
    time_ = time;
  }
  template <class Law> void collide(const Law& law, std::size_t i) {
    Body& l = ring_[i];
    Body& r = ring_[next(i)];
    const Outcome<T> outcome = law(T(l.v - r.v), TwoMasses<T>{l.m, r.m});
    l.v -= outcome.to_left;
    r.v += outcome.to_right;
    if (outcome.event == Event::pass) {
      std::swap(l.v, r.v);
      std::swap(l.m, r.m);
      std::swap(l.index, r.index);
    }
    if (outcome.event == Event::merge) {
      if (l.m < r.m) l.index = r.index;
      l.v = (l.m * l.v + r.m * r.v) / (l.m + r.m);
      l.m += r.m;
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(next(i)));
      ++merges;
    }
  }

  std::vector<Body> ring_;
  T length_, time_{0};
};

}  // namespace cradle::test
