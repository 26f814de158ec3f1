#pragma once
// Particles on a ring in the plainest form, the slow twin of the chains on a ring: positions and velocities; all
// particles are advanced from collision to collision, and the next one is searched among all pairs of neighbours.

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/initial/particles.hpp"
#include "cradle/core/laws/law.hpp"

namespace cradle::test {

template <Real T> class SlowRing {
 public:
  struct Particle {
    T x, v, m;  // x unwrapped: increases along the list, which spans less than the circumference
    ParticleIndex index;
  };

  explicit SlowRing(const Particles<T>& particles) : length_(particles.circumference()) {
    for (ParticleIndex b = 0; b < particles.count(); ++b)
      ring_.push_back({particles.position(b), particles.velocity(b), particles.mass(b), b});
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
      ++collisions;
    }
    fly(until);
  }

  // The particles from the first one on the left. A very large ring serves as a line.
  const std::vector<Particle>& unfolded() const { return ring_; }
  // The particles from the first one right of 0.
  std::vector<Particle> folded() const {
    std::vector<Particle> particles = ring_;
    for (Particle& b : particles) {
      while (b.x < T(0)) b.x += length_;
      while (!(b.x < length_)) b.x -= length_;
    }
    std::sort(particles.begin(), particles.end(), [](const Particle& a, const Particle& b) { return a.x < b.x; });
    return particles;
  }

  std::uint64_t collisions = 0, merges = 0;

 private:
  std::size_t next(std::size_t i) const { return i + 1 < ring_.size() ? i + 1 : 0; }
  T gap(std::size_t i) const {
    return i + 1 < ring_.size() ? T(ring_[i + 1].x - ring_[i].x) : T(ring_[0].x + length_ - ring_[i].x);
  }
  void fly(const T& time) {
    for (Particle& b : ring_) b.x += b.v * (time - time_);
    time_ = time;
  }
  template <class Law> void collide(const Law& law, std::size_t i) {
    Particle& l = ring_[i];
    Particle& r = ring_[next(i)];
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

  std::vector<Particle> ring_;
  T length_, time_{0};
};

}  // namespace cradle::test
