#pragma once
// Particles on a line in a conventional event-driven program: absolute positions and velocities in double; a particle
// is advanced only when it collides. Equal masses; inelastic law with a velocity cut-off. The heaps and the priority
// queue in this folder differ only in how they find the next collision.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "cradle/core/initial/particles.hpp"

namespace twins {

inline constexpr double never = std::numeric_limits<double>::infinity();

struct Law {
  double restitution;
  double cutoff;  // closing speed below which collisions are elastic
};

// That flies freely: x is the position at `time`.
struct Flying {
  double x, v, time;
  double at(double t) const { return x + v * (t - time); }
  void advance(double t) {
    x = at(t);
    time = t;
  }
};

class Line {
 public:
  Line(const cradle::Particles<double>& particles, Law law) : law_(law) {
    particles_.reserve(static_cast<std::size_t>(particles.count()));
    for (cradle::ParticleIndex b = 0; b < particles.count(); ++b)
      particles_.push_back({particles.position(b), particles.velocity(b), 0});
  }

  std::size_t gaps() const { return particles_.size() - 1; }

  // Time of the next collision of particles i and i + 1, predicted at the time `now`.
  double due(std::size_t i, double now) const {
    const Flying &left = particles_[i], &right = particles_[i + 1];
    const double closing = left.v - right.v;
    if (!(closing > 0)) return never;
    return now + std::max(right.at(now) - left.at(now), 0.0) / closing;  // rounding can make the gap negative
  }

  std::vector<double> all_due() const {
    std::vector<double> times(gaps());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = due(i, 0);
    return times;
  }

  // Collision of particles i and i + 1.
  void collide(std::size_t i, double time) {
    Flying &left = particles_[i], &right = particles_[i + 1];
    left.advance(time);
    right.advance(time);
    right.x = left.x;
    const double closing = left.v - right.v;
    const double impulse = (1 + (closing < law_.cutoff ? 1 : law_.restitution)) / 2 * closing;
    left.v -= impulse;
    right.v += impulse;
  }

 private:
  Law law_;
  std::vector<Flying> particles_;
};

}  // namespace twins
