#pragma once
// Averages over time in bins of equal width, from samples at given times. With sums over all particles that the samples
// find in a bin (of mass m and velocity v), per sample and length:
//
//   density 1, mass_density m, momentum_density m v, energy_density m v^2/2, energy_current m v^3/2,
//   velocity u = sum m v/sum m, temperature T = sum m (v - u)^2/particles, pressure m (v - u)^2,
//   heat_current m (v - u)^3/2
//
// Points transfer nothing over a distance at a collision, so the currents of momentum and energy have no other part.
// The first five are linear in what is counted, so averages over samples and replicas have no bias. The others have one
// of the order of 1/(independent particles in the bin).
//
// Errors of one run are those of the jackknife over batches of samples of equal length, and `error_growth` is that of
// the energy density (batch_means.hpp).
// Units: those of the scene; float64.

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/observe/batch_means.hpp"
#include "cradle/core/observe/profile.hpp"

namespace cradle {

class TimeAverages {
 public:
  static constexpr std::size_t batches = mean_batches, quantities = 9;
  using Numbers = std::array<double, quantities>;  // in the order above
  struct InBin {
    Numbers value, error;
  };

  // `samples` will be given. Throws std::invalid_argument for a range that is empty or not finite, no bins, or fewer
  // samples than batches.
  TimeAverages(BinRange range, std::size_t bins, std::size_t samples)
      : range_(range), bins_(bins), samples_(samples), batches_(batches, Batch(bins)), found_(bins), frame_(bins) {
    if (!(range.from < range.to) || !std::isfinite(range.to - range.from) || bins == 0 || samples < batches)
      throw std::invalid_argument("averages over time without extent: give a range, 1 bin and 32 samples at least");
  }

  // Finds the particles of a sample, which add_found() then adds. `stopped`: see for_each_particle.
  template <Real T>
  void find(const Configuration<T>& c, const Particles<T>& particles, const T& elapsed,
            const std::function<bool()>& stopped = {}) {
    seen_.clear();
    const auto see = [&](double x, double v, double m) { seen_.push_back(Seen{x, v, m}); };
    for_each_particle(c, particles, elapsed, range_, see, stopped);
  }
  void add_found() {
    Batch& batch = batches_.at(taken_ * batches / samples_);
    for (const auto& [x, v, m] : seen_) {
      const std::size_t bin = detail::bin_at((x - range_.from) / width(), bins_);
      // Sums are taken in the frame of the first particle found, lest those of a cold stream cancel.
      if (found_[bin] == 0) found_[bin] = 1, frame_[bin] = v;
      const double from_frame = v - frame_[bin];
      double* sums = &batch.sums[per_bin * bin];
      *sums++ += 1;
      double term = m;
      for (std::size_t k = 0; k + 1 < per_bin; ++k) *sums++ += term, term *= from_frame;
    }
    batch.samples += 1;
    ++taken_;
  }

  std::size_t samples() const { return taken_; }
  bool complete() const { return taken_ == samples_; }
  std::vector<double> centres() const { return bin_centres(range_, bins_); }

  // Without error (NaN) where a batch alone has particles.
  std::vector<InBin> averages() const {
    std::vector<InBin> all;
    for (std::size_t bin = 0; bin < bins_; ++bin) all.push_back({total(bin), error(bin, 1)});
    return all;
  }
  double error_growth() const {
    constexpr std::size_t energy_density = 3;
    std::vector<BatchMean> means;
    for (std::size_t bin = 0; bin < bins_; ++bin)
      means.push_back({total(bin)[energy_density], error(bin, 1)[energy_density], error(bin, 4)[energy_density]});
    return cradle::error_growth(means);
  }

  static auto state(auto& self) { return fields(self.taken_, self.batches_, self.found_, self.frame_); }
  void loaded() const {
    require_state(batches_.size() == batches && taken_ <= samples_ && found_.size() == bins_ && frame_.size() == bins_,
                  "averages");
    for (const Batch& batch : batches_) require_state(batch.sums.size() == per_bin * bins_, "bins of averages");
  }

 private:
  static constexpr std::size_t per_bin = 5;  // particles, then the sums of m (v - frame)^k for k = 0 to 3
  struct Batch {
    explicit Batch(std::size_t bins = 0) : sums(per_bin * bins) {}
    std::vector<double> sums;
    double samples = 0;
    static auto state(auto& self) { return fields(self.sums, self.samples); }
  };
  struct Seen {
    double x, v, m;
  };

  double width() const { return (range_.to - range_.from) / static_cast<double>(bins_); }

  // Of all batches but [from, to).
  Numbers without(std::size_t bin, std::size_t from, std::size_t to) const {
    std::array<double, per_bin> sum{};
    double samples = 0;
    for (std::size_t b = 0; b < batches; ++b) {
      if (b >= from && b < to) continue;
      samples += batches_[b].samples;
      for (std::size_t k = 0; k < per_bin; ++k) sum[k] += batches_[b].sums[per_bin * bin + k];
    }
    const auto& [particles, m, mv, mvv, mvvv] = sum;
    const double per = 1 / (samples * width()), frame = frame_[bin], u = m > 0 ? mv / m : 0;
    const double second = mvv - u * mv, third = mvvv - u * (3 * mvv - 2 * u * mv);
    return {per * particles,
            per * m,
            per * (mv + frame * m),
            per * (mvv + frame * (2 * mv + frame * m)) / 2,
            per * (mvvv + frame * (3 * mvv + frame * (3 * mv + frame * m))) / 2,
            detail::mean(mv + frame * m, m),
            detail::mean(second, particles),
            per * second,
            per * third / 2};
  }
  Numbers total(std::size_t bin) const { return without(bin, 0, 0); }

  // From batches joined by so many.
  Numbers error(std::size_t bin, std::size_t joined) const {
    std::array<std::vector<double>, quantities> values;
    for (std::size_t b = 0; b < batches; b += joined) {
      double samples = 0;
      for (std::size_t k = b; k < b + joined; ++k) samples += batches_[k].samples;
      if (!(samples > 0)) continue;
      const Numbers numbers = without(bin, b, b + joined);
      for (std::size_t q = 0; q < quantities; ++q) values[q].push_back(numbers[q]);
    }
    Numbers error;
    for (std::size_t q = 0; q < quantities; ++q) error[q] = detail::jackknife_error(values[q]);
    return error;
  }

  BinRange range_;
  std::size_t bins_, samples_, taken_ = 0;
  std::vector<Batch> batches_;
  std::vector<std::uint64_t> found_;  // whether a bin has had a particle
  std::vector<double> frame_;         // its velocity
  std::vector<Seen> seen_;            // room for one sample
};

}  // namespace cradle
