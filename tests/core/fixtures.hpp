#pragma once
// Initial states that several tests share, and the runs made from them. Both fixtures perturb their particles by a hash
// (the finaliser of splitmix64) and are exact in double: every scalar type starts from the same numbers. Also states of
// runs placed by hand, and means of them.
//
//   rmix    x_i = i + (h & 0x3FF)/2048,  v_i = (((h >> 20) & 0x3FFF) - 8192)/8192
//   rshock  x_i = (2 i - N + 1)/2 + ((h & 0x3FFFF) - 131072)/2^28,  v = +u0 for i < N/2, else -u0

#include <ostream>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/initial/cold.hpp"
#include "cradle/core/initial/gas.hpp"
#include "cradle/core/initial/list.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/core/laws/law.hpp"

namespace cradle::test {

template <class T> using Scene = std::shared_ptr<const Particles<T>>;
template <class T> using GapRun = Simulation<T, Inelastic<T>, GapChain<T>>;
template <class T> using PositionRun = Simulation<T, Inelastic<T>, PositionChain<T>>;

inline std::uint64_t hash(ParticleIndex i) { return splitmix64(static_cast<std::uint64_t>(i) + 0x9E3779B97F4A7C15); }

inline std::int64_t bits_of(ParticleIndex particle, int shift, std::uint64_t mask) {
  return static_cast<std::int64_t>((hash(particle) >> shift) & mask);
}

// With a circumference: on a ring.
template <class T>
Scene<T> list(std::vector<T> x, std::vector<T> v, std::vector<T> m = {}, const T& circumference = T(0)) {
  return std::make_shared<List<T>>(std::move(x), std::move(v), std::move(m), circumference);
}

template <class T> Scene<T> rmix(ParticleIndex n) {
  std::vector<T> x, v;
  for (ParticleIndex i = 0; i < n; ++i) {
    x.push_back(T(i) + T(bits_of(i, 0, 0x3FF)) / T(2048));
    v.push_back(T(bits_of(i, 20, 0x3FFF) - 8192) / T(8192));
  }
  return list(std::move(x), std::move(v));
}

inline std::int64_t rshock_displacement(ParticleIndex particle) { return bits_of(particle, 0, 0x3FFFF) - 131072; }

// Rows of unit spacing that approach each other at plus and minus 1/2.
template <class T = double> Scene<T> displaced_rows(ParticleIndex n, const Displacement& displacement) {
  return std::make_shared<Rows<T>>(symmetric_rows<T>(n, T(T(1) / T(2)), T(1), displacement));
}
template <class T> Scene<T> rshock(ParticleIndex n) { return displaced_rows<T>(n, rshock_displacement); }

// Without displacements: many pairs collide at one time.
inline std::int64_t still(ParticleIndex) { return 0; }
template <class T = double> Scene<T> lattice_rows(ParticleIndex n) { return displaced_rows<T>(n, still); }
// At integers, with the speeds -1, 0 and 1 by chance: crowds of them collide at one time.
template <class T> Scene<T> crowds(ParticleIndex n, ParticleIndex seed) {
  std::vector<T> x, v;
  for (ParticleIndex i = 0; i < n; ++i) {
    x.push_back(T(i));
    v.push_back(T(static_cast<std::int64_t>(hash(i + 1000000 * seed) % 3) - 1));
  }
  return list(std::move(x), std::move(v));
}
// Rows with different densities and speeds, with a heavy particle between them.
template <class T> CentralParticle<T> heavy_particle() { return {T(20), T(1) / T(8)}; }
template <class T = double>
Scene<T> unequal_rows(std::optional<CentralParticle<T>> centre = heavy_particle<T>(), MassPattern<T> masses = {},
                      ParticleIndex times = 1) {
  return std::make_shared<Rows<T>>(Row<T>{160 * times, T(3) / T(4), T(1) / T(2)},
                                   Row<T>{240 * times, T(-1) / T(4), T(3) / T(2)}, std::move(centre),
                                   rshock_displacement, std::move(masses));
}
// Masses that repeat, on rows and in a cold gas, of which so many particles move.
inline const MassPattern<double> one_and_two({1, 2}), three_masses({1, 4.25, .5});
inline Scene<double> cold_gas(ParticleIndex hot, HotPlace place) {
  HotParticles<double> moving = hot == 1 ? kicked(first_hot(place, 2000, 1), 0.75)
                                         : heated(first_hot(place, 2000, hot), hot, 10., one_and_two, 5, 2);
  return std::make_shared<Cold<double>>(2000, 1., place, std::move(moving), rshock_displacement, one_and_two);
}

// Rows and rings as in scenes, displaced by counter-based random numbers.
inline Scene<double> uniform_rows(ParticleIndex count, double perturbation = 0.05, std::uint64_t seed = 3) {
  return displaced_rows(count, uniform_displacement(perturbation, seed, 0));
}
inline Scene<double> gaussian_ring(ParticleIndex count, double length, std::uint64_t seed = 3,
                                   double perturbation = 0.05, std::uint64_t replica = 0,
                                   MassPattern<double> masses = {}) {
  return std::make_shared<Ring<double>>(count, length, 1., gaussian_velocity(seed, replica),
                                        uniform_displacement(perturbation, seed, replica), std::move(masses));
}

// The same particles as a list, which does not know that they are rows; also with other masses, by their number, and on
// a ring.
template <class T, class Mass>
Scene<T> as_list(const Particles<T>& particles, const Mass& mass, const T& circumference = T(0)) {
  std::vector<T> x, v, m;
  for (ParticleIndex b = 0; b < particles.count(); ++b) {
    x.push_back(particles.position(b));
    v.push_back(particles.velocity(b));
    m.push_back(mass(b));
  }
  return list(std::move(x), std::move(v), std::move(m), circumference);
}
template <class T> Scene<T> as_list(const Particles<T>& particles) {
  return as_list(particles, [&](ParticleIndex b) { return particles.mass(b); });
}

// The same particles in other units, in a moving frame or, with negative lengths and speeds, in the mirror.
struct Frame {
  double length = 1, speed = 1, mass = 1, drift = 0;
};
inline constexpr Frame mirror_frame{.length = -1, .speed = -1};
inline Scene<double> seen_in(const Particles<double>& particles, const Frame& frame) {
  std::vector<double> x, v, m;
  Differences<double> differences;  // as a drift leaves them, which may round all velocities to one
  for (ParticleIndex k = 0; k < particles.count(); ++k) {
    const ParticleIndex b = frame.length < 0 ? particles.count() - 1 - k : k;
    x.push_back(frame.length * particles.position(b));
    v.push_back(frame.speed * particles.velocity(b) + frame.drift);
    m.push_back(frame.mass * particles.mass(b));
    if (frame.drift == 0) continue;
    differences.from_first.push_back(particles.velocity(b) - particles.velocity(0));
    if (k + 1 == particles.count()) break;
    differences.gaps.push_back(particles.gap(b));
    differences.closing_speeds.push_back(particles.closing_speed(b));
  }
  return std::make_shared<List<double>>(x, v, m, 0., std::nullopt, std::move(differences));
}

// Collide at t = 1, and then both gaps are 1 wide and closing at 1: below a restitution of 7 - 4 sqrt 3 they collapse.
// (0, 1, 2 would be a triple collision.)
template <class T = double> Scene<T> three_particles(std::vector<T> m = {}) {
  return list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}, std::move(m));
}

// Their collapse in numbers (McNamara and Young, Phys. Fluids A 4, 496 (1992), evaluated to 40 digits).
struct ThreeCollapse {
  const char *eps, *collapse_time;
  std::array<std::uint64_t, 4> passes;  // collision at which the gap is first below 1e-16, 1e-34, 1e-100, 1e-300
  std::uint64_t plain_clock_stops;      // last collision that moves a plain clock, in double

  double restitution() const { return std::stod(eps); }
  friend void PrintTo(const ThreeCollapse& r, std::ostream* out) { *out << "eps=" << r.eps; }
};
inline constexpr ThreeCollapse three_collapses[] = {
    {"0.05", "1.714285714285714285714285714285714285714285714286", {18, 38, 111, 333}, 31},
    {"0.01", "1.6736937682559527405521559675474991365441632665957", {11, 21, 61, 179}, 13},
    {"0.0625", "1.7377984054260977582367587110958928498213699562943", {22, 45, 133, 398}, 49},
};

struct Options {
  bool hold_all = false;
  int least_queue_bits = 3;
};

template <class T, class Law>
Simulation<T, Law, GapChain<T>> gap_run(const Scene<T>& particles, const Law& law, Policy<T> policy = {},
                                        const T& start = T(0), Options options = {}) {
  return {law, GapChain<T>(particles, start, options.hold_all), std::move(policy), options.least_queue_bits};
}

template <class T, class Law>
Simulation<T, Law, GapChain<T, IndividualMasses<T>>> mass_run(const Scene<T>& particles, const Law& law,
                                                              Policy<T> policy = {}, const T& start = T(0)) {
  return {law, GapChain<T, IndividualMasses<T>>(particles, start), std::move(policy)};
}

template <class T, class Law>
Simulation<T, Law, PositionChain<T>> position_run(const Scene<T>& particles, const Law& law, Policy<T> policy = {},
                                                  const T& start = T(0)) {
  return {law, PositionChain<T>(particles, start), std::move(policy)};
}

// A configuration of particles placed by hand: all have collided; masses are 1 if none are given.
inline Configuration<double> placed(std::vector<double> x, std::vector<double> v, std::vector<double> m = {}) {
  Configuration<double> c;
  c.x = std::move(x), c.v = std::move(v);
  c.m = m.empty() ? std::vector<double>(c.x.size(), 1.) : std::move(m);
  c.index.resize(c.x.size());
  std::iota(c.index.begin(), c.index.end(), 0);
  c.to = static_cast<ParticleIndex>(c.x.size()) - 1;
  c.collided_to = c.x.size();
  for (std::size_t j = 0; j + 1 < c.x.size(); ++j) c.gap.push_back(c.x[j + 1] - c.x[j]);
  return c;
}

// The mean and its error in the plainest way.
struct PlainMean {
  double mean, error;  // one standard error
};
inline PlainMean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.) / n;
  double squares = 0;
  for (const double x : values) squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / (n * (n - 1)))};
}

template <class Run, class T> auto configuration_at(const Run& run, const T& time) {
  return run.chain().configuration(run.chain().local_time(time));
}

}  // namespace cradle::test
