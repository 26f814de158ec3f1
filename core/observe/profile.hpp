#pragma once
// Profiles over bins of equal width: number and mass density, mass-weighted mean velocity and its variance (the
// granular temperature), and number density and velocity of right- and left-movers apart (the paper's rho±, u±; Figs. 2
// b, c, 6, 7). Lengths, speeds, masses in units of the scene; float64, since a bin holds many particles. Bins without
// particles have density 0 and no velocity (NaN). The last bin has its right end too, where particles rest on a wall;
// not so on a ring, where that may be the place at which the first bin begins.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <vector>

#include "cradle/core/chains/anchor.hpp"
#include "cradle/core/chains/configuration.hpp"

namespace cradle {

struct Profile {
  double time = 0;
  std::vector<double> x;  // bin centres; all arrays have one entry per bin
  std::vector<double> velocity, density, mass_density, temperature;
  std::vector<double> density_right, velocity_right, density_left, velocity_left;
};

struct BinRange {
  double from, to;
};

namespace detail {

// One bin, filled particle by particle; mean and variance by West's update, since late temperatures are small compared
// with v^2. A particle at rest is neither a right- nor a left-mover: `rest` is a speed that may be rounding.
struct Bin {
  double count = 0, mass = 0, velocity = 0, scatter = 0;
  double right = 0, right_speed = 0, left = 0, left_speed = 0;

  void add(double v, double m, double rest) {
    count += 1;
    mass += m;
    const double from_mean = v - velocity;
    velocity += from_mean * (m / mass);
    scatter += m * from_mean * (v - velocity);
    if (v > rest) right += 1, right_speed += v;
    if (v < -rest) left += 1, left_speed += v;
  }
};

// The bin of a particle within the range: `place` counts bins from the start of the range; it is their number for a
// particle at the end, and may be rounded up to it just below.
inline std::size_t bin_at(double place, std::size_t bins) {
  return std::min(static_cast<std::size_t>(place), bins - 1);
}

inline double mean(double sum, double weight) {
  return weight > 0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace detail

// Thrown by a loop over particles that its caller has stopped: its result is incomplete.
struct WalkStopped : std::exception {
  const char* what() const noexcept override { return "a walk over particles was stopped"; }
};

// Calls visit(x, v, m) for every particle in a range, also for those that the fronts have not reached (anchor.hpp). On
// a ring a finite range has all images of the particles that are in it, a circumference apart. There may be very many
// particles: `stopped` is called from time to time; if it returns true, WalkStopped is thrown.
template <Real T>
void for_each_particle(const Configuration<T>& c, const Particles<T>& particles, const T& elapsed, BinRange range,
                       const std::function<void(double x, double v, double m)>& visit,
                       const std::function<bool()>& stopped = {}) {
  const double length = to_double(particles.circumference());
  const bool images = length > 0 && std::isfinite(range.to - range.from);
  const double most_turns = images ? (range.to - range.from) / length + 2 : 0;
  require(most_turns < 0x1p21, "a range of more turns of the ring than can be counted (", most_turns,
          "): give a shorter one");
  const auto turns = static_cast<std::int64_t>(most_turns);
  for (std::size_t j = 0; j < c.x.size(); ++j) {
    const double x = to_double(c.x[j]), first = images ? std::floor((range.from - x) / length) : 0;
    for (std::int64_t turn = 0; turn <= turns; ++turn) {
      const double image = images ? x + (first + static_cast<double>(turn)) * length : x;
      if (image >= range.from && (images ? image < range.to : image <= range.to))
        visit(image, to_double(c.v[j]), to_double(c.m[j]));
    }
  }
  const auto fly = [&](ParticleIndex particle) {
    return to_double(undisturbed(particles, particle, elapsed).x.value());
  };
  const auto visit_free = [&](ParticleIndex particle, double x) {
    constexpr ParticleIndex between_stops = 1 << 14;
    if (particle % between_stops == 0 && stopped && stopped()) throw WalkStopped();
    visit(x, to_double(undisturbed(particles, particle, elapsed).v.value()), to_double(particles.mass(particle)));
  };
  // They fly in order: finds the first of [low, high) that is not to the left of the range, or that is to its right.
  const auto first = [&](ParticleIndex low, ParticleIndex high, const auto& is_before) {
    while (low < high) {
      const ParticleIndex middle = low + (high - low) / 2;
      const bool before = is_before(fly(middle));
      low = before ? middle + 1 : low;
      high = before ? high : middle;
    }
    return low;
  };
  const auto left_of_it = [&](double x) { return x < range.from; };
  const auto up_to_its_end = [&](double x) { return x <= range.to; };
  for (ParticleIndex particle = first(0, c.from, up_to_its_end) - 1; particle >= 0; --particle) {
    const double x = fly(particle);
    if (x < range.from) break;
    visit_free(particle, x);
  }
  for (ParticleIndex particle = first(c.to + 1, particles.count(), left_of_it); particle < particles.count();
       ++particle) {
    const double x = fly(particle);
    if (!up_to_its_end(x)) break;
    visit_free(particle, x);
  }
}

// How fast a particle at rest may seem: some roundings of the fastest and, where velocities are sums of closing speeds,
// what these have lost of their sum.
template <Real T> double rounding_of_speeds(const Configuration<T>& c) {
  T fastest(0);
  for (const T& v : c.v) fastest = std::max(fastest, magnitude(v));
  const T lost = c.speeds_are_sums && c.closure_speed ? magnitude(*c.closure_speed) : T(0);
  return to_double(T(lost + T(4) * T(std::numeric_limits<T>::epsilon()) * fastest));
}

inline std::vector<double> bin_centres(BinRange range, std::size_t bins) {
  const double width = (range.to - range.from) / static_cast<double>(bins);
  std::vector<double> x;
  for (std::size_t b = 0; b < bins; ++b) x.push_back(range.from + (static_cast<double>(b) + 0.5) * width);
  return x;
}

// Throws std::invalid_argument for a range that is empty or not finite, or no bins; WalkStopped, see for_each_particle.
template <Real T>
Profile profile(const Configuration<T>& c, const Particles<T>& particles, const T& elapsed, BinRange range,
                std::size_t bins, const std::function<bool()>& stopped = {}) {
  require(range.from < range.to && std::isfinite(range.to - range.from) && bins > 0,
          "profile without extent: give a range that increases and at least one bin");
  const double width = (range.to - range.from) / static_cast<double>(bins);
  std::vector<detail::Bin> sums(bins);
  const auto enter = [&, rest = rounding_of_speeds(c)](double x, double v, double m) {
    sums[detail::bin_at((x - range.from) / width, bins)].add(v, m, rest);
  };
  for_each_particle(c, particles, elapsed, range, enter, stopped);

  Profile p;
  p.time = to_double(c.time);
  p.x = bin_centres(range, bins);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t b = 0; b < bins; ++b) {
    const detail::Bin& s = sums[b];
    p.velocity.push_back(s.count > 0 ? s.velocity : nan);
    p.density.push_back(s.count / width);
    p.mass_density.push_back(s.mass / width);
    p.temperature.push_back(detail::mean(s.scatter, s.mass));
    p.density_right.push_back(s.right / width);
    p.velocity_right.push_back(detail::mean(s.right_speed, s.right));
    p.density_left.push_back(s.left / width);
    p.velocity_left.push_back(detail::mean(s.left_speed, s.left));
  }
  return p;
}

}  // namespace cradle
