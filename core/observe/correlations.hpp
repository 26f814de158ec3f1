#pragma once
// Correlations in time of tagged particles, from samples at equal distances of time: the mean-square displacement
// <(x(s + t) - x(s))^2> and the velocity autocorrelation <v(s) v(s + t)>, over particles and all times s of samples.
//
// A multiple-tau correlator (Ramirez, Sukumaran, Vorselaars and Likhtman, J. Chem. Phys. 133, 154103, 2010): level l
// holds every 2^l-th sample, the last 16 of these, and correlates a new one with the 8 to 15 (on level 0: 0 to 15)
// before it. Memory grows with the logarithm of the longest lag, time not at all: 24 products per particle and sample.
// Samples go to the next level as they are, not as averages of two: averages have less noise, but would smooth the
// correlations by a share of the lag; so these have no bias at any lag.
//
// Errors: the particles are divided into batches of neighbours (batch_means.hpp), which hold in states that change with
// time too. Units: those of the scene; float64, of displacements that are computed in the scalar type.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/chains/anchor.hpp"
#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/observe/batch_means.hpp"
#include "cradle/core/observe/histograms.hpp"

namespace cradle {

// Displacements since the start and velocities of every k-th particle, among particles that stay in order.
//
// On a ring they are not folded. Particles are in the order of their numbers, so the place of each is known but for
// turns that all have in common; the centre of mass, whose flight is known, gives these turns.
template <Real T> class TaggedParticles {
 public:
  TaggedParticles(const Particles<T>& particles, ParticleIndex every)
      : particles_(particles), every_(every), size_(static_cast<std::size_t>((particles.count() - 1) / every + 1)) {
    if (!particles.on_ring()) return;
    centre_ = particles.centre_of_mass();
    drift_ = particles.conserved_momentum() / particles.total_mass();
  }

  std::size_t size() const { return size_; }

  void find(const Configuration<T>& c, const T& elapsed) {
    displacement_.assign(size_, 0);
    velocity_.assign(size_, 0);
    const T length = particles_.circumference();
    const std::int64_t turns = particles_.on_ring() ? common_turns(c, elapsed) : 0;
    for (std::size_t j = 0; j < c.x.size(); ++j) {
      if (c.index[j] % every_ != 0) continue;
      const T x = particles_.on_ring() ? T(c.x[j] + T(turns - behind_seam(c, j)) * length) : c.x[j];
      put(c.index[j], T(x - particles_.position(c.index[j])), c.v[j]);
    }
    // Those that the fronts have not reached.
    const auto fly = [&](ParticleIndex from, ParticleIndex to) {
      for (ParticleIndex particle = (from + every_ - 1) / every_ * every_; particle < to; particle += every_)
        put(particle, undisturbed_way(particles_, particle, elapsed),
            undisturbed(particles_, particle, elapsed).v.value());
    };
    fly(0, c.from);
    fly(c.to + 1, particles_.count());
  }
  const std::vector<double>& displacement() const { return displacement_; }
  const std::vector<double>& velocity() const { return velocity_; }

 private:
  void put(ParticleIndex particle, const T& x, const T& v) {
    displacement_[static_cast<std::size_t>(particle / every_)] = to_double(x);
    velocity_[static_cast<std::size_t>(particle / every_)] = to_double(v);
  }
  // Positions begin with any particle; those of lower numbers, at the end of the list, are a turn ahead of the others.
  static std::int64_t behind_seam(const Configuration<T>& c, std::size_t j) { return c.index[j] < c.index[0] ? 1 : 0; }
  std::int64_t common_turns(const Configuration<T>& c, const T& elapsed) const {
    const T length = particles_.circumference();
    CompensatedSum<T> moment;
    for (std::size_t j = 0; j < c.x.size(); ++j) moment.add(c.m[j] * T(c.x[j] - T(behind_seam(c, j)) * length));
    const T ahead = centre_ + drift_ * elapsed - moment.value() / particles_.total_mass();
    const double turns = std::floor(to_double(T(ahead / length)) + 0.5);
    constexpr double most = 0x1p62;  // where no type has digits within a turn
    return static_cast<std::int64_t>(std::clamp(turns, -most, most));
  }

  const Particles<T>& particles_;
  ParticleIndex every_;
  std::size_t size_;
  T centre_{0}, drift_{0};
  std::vector<double> displacement_, velocity_;
};

class Correlator {
 public:
  static constexpr std::size_t held = 16, half = held / 2;  // samples of a level; lags from level 1 on

  // Of so many particles, for lags up to `longest`, in samples. Throws std::invalid_argument without particles.
  Correlator(std::size_t particles, std::uint64_t longest) : particles_(particles), longest_(longest) {
    if (particles == 0) throw std::invalid_argument("correlations of no particles: tag one at least");
    std::size_t levels = 1;
    while (half << levels <= longest) ++levels;
    levels_.assign(levels, Level{std::vector<double>(held * particles), std::vector<double>(held * particles)});
    sums_.assign(lags(longest).size() * mean_batches * 2, 0);
  }

  // 0 and octave_steps (histograms.hpp).
  static std::vector<std::uint64_t> lags(std::uint64_t longest) {
    std::vector<std::uint64_t> all = octave_steps(longest);
    all.insert(all.begin(), 0);
    return all;
  }
  std::vector<std::uint64_t> lags() const { return lags(longest_); }
  // Bytes that a correlator holds.
  static double bytes(double particles, std::uint64_t longest) {
    const auto levels = static_cast<double>(lags(longest).size()) / half;
    return particles * held * 2 * sizeof(double) * std::max(levels - 1, 1.);
  }

  void add(const std::vector<double>& x, const std::vector<double>& v) {
    for (std::size_t l = 0; l < levels_.size() && taken_ >> l << l == taken_; ++l) {
      Level& level = levels_[l];
      const std::uint64_t entry = taken_ >> l;
      std::copy(x.begin(), x.end(), level.x.begin() + at(entry));
      std::copy(v.begin(), v.end(), level.v.begin() + at(entry));
      for (std::uint64_t lag = l == 0 ? 0 : half; lag < held && lag <= entry && lag << l <= longest_; ++lag)
        correlate(level, entry - lag, x, v, (l * half + lag) * mean_batches * 2);
    }
    ++taken_;
  }

  std::uint64_t samples() const { return taken_; }

  struct Correlation {
    BatchMean displacement, velocity;  // squared; of two times
  };
  // One for each lag; NaN for lags that no two samples have.
  std::vector<Correlation> correlations() const {
    std::vector<Correlation> all;
    const auto count = lags().size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t level = k < held ? 0 : k / half - 1, lag = k - level * half;
      const std::uint64_t entries = taken_ == 0 ? 0 : ((taken_ - 1) >> level) + 1;
      const auto pairs = static_cast<double>(entries > lag ? entries - lag : 0);
      OfBatches squares, products, weights;
      for (std::size_t b = 0; b < mean_batches; ++b) {
        squares[b] = sums_[(k * mean_batches + b) * 2];
        products[b] = sums_[(k * mean_batches + b) * 2 + 1];
        weights[b] = pairs * static_cast<double>(first_of(b + 1) - first_of(b));
      }
      all.push_back({mean_of_batches(squares, weights), mean_of_batches(products, weights)});
    }
    return all;
  }

  static auto state(auto& self) { return fields(self.taken_, self.levels_, self.sums_); }
  void loaded() const {
    require_state(sums_.size() == lags().size() * mean_batches * 2, "lags");
    for (const Level& level : levels_)
      require_state(level.x.size() == held * particles_ && level.v.size() == held * particles_, "tagged particles");
    require_state(!levels_.empty() && half << (levels_.size() - 1) <= std::max<std::uint64_t>(longest_, half) &&
                      half << levels_.size() > longest_,
                  "levels of lags");
  }

 private:
  struct Level {
    std::vector<double> x, v;  // of all particles at one sample after the other
    static auto state(auto& self) { return fields(self.x, self.v); }
  };

  std::ptrdiff_t at(std::uint64_t entry) const { return static_cast<std::ptrdiff_t>(entry % held * particles_); }
  std::size_t first_of(std::size_t batch) const { return batch * particles_ / mean_batches; }

  void correlate(const Level& level, std::uint64_t earlier, const std::vector<double>& x, const std::vector<double>& v,
                 std::size_t sum) {
    const double *from_x = level.x.data() + at(earlier), *from_v = level.v.data() + at(earlier);
    for (std::size_t b = 0; b < mean_batches; ++b) {
      double squares = 0, products = 0;
      for (std::size_t j = first_of(b); j < first_of(b + 1); ++j) {
        const double way = x[j] - from_x[j];
        squares += way * way;
        products += v[j] * from_v[j];
      }
      sums_[sum + 2 * b] += squares;
      sums_[sum + 2 * b + 1] += products;
    }
  }

  std::size_t particles_;
  std::uint64_t longest_, taken_ = 0;
  std::vector<Level> levels_;
  std::vector<double> sums_;  // for each lag and batch: squares of displacements, products of velocities
};

}  // namespace cradle
