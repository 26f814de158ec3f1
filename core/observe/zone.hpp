#pragma once
// The interaction zone of a late wet shock, averaged over time, in bins: number density n± and mean speed u± of single
// particles (those that have not merged), right-movers + and left-movers -. And the width 2L of the zone, from the
// slope of u+. In the paper's linear model (section VI, Fig. 7) u+ falls linearly from u0 to u_crit over the length 2L
// (9). So, by definition here,
//
//   2L = (u0 - u_crit)/|slope|,   |slope| = (u0/2)/(x_{1/4} - x_{3/4}),   u+(x_q) = q u0,
//
// from right-movers and mirrored left-movers together. The zone moves with the heavy clusters, which would smear a long
// average: time is divided into parts, and 2L is the median of their widths. Its error is that of a median of n
// Gaussian numbers, 1.253 sigma/sqrt(n), with sigma = 1.483 times the median deviation. Equation (13) counts the fall
// from u0 to 0, which is u0/(u0 - u_crit) times as wide.
// Sampling and units: those of the scene; float64.

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/profile.hpp"

namespace cradle {

struct ZoneWidth {
  double width, error;  // 2L and its standard error; NaN where u+ does not fall through 3/4 and 1/4 of u0 in most parts
};

class ZoneAverage {
 public:
  static constexpr std::size_t parts = 16;

  // `samples` will be given, over a range -reach to reach around the centre of the shock. Throws std::invalid_argument
  // for fewer samples than parts or a reach that is not positive.
  ZoneAverage(double reach, std::size_t bins, std::size_t samples, double row_mass)
      : reach_(reach), bins_(bins), samples_(samples), row_mass_(row_mass), part_(parts, Part(bins)) {
    if (!(reach > 0) || bins < 4 || samples < parts)
      throw std::invalid_argument("zone without extent: give it a positive reach, 4 bins and 16 samples at least");
  }

  // Finds the particles of a sample, which add_found() then adds. `stopped`: see for_each_particle.
  template <Real T>
  void find(const Configuration<T>& c, const Particles<T>& particles, const T& elapsed,
            const std::function<bool()>& stopped = {}) {
    Part& part = found_ = part_.at(taken_ * parts / samples_);
    const auto count = [&](double x, double v, double m) {
      Bin& bin = part[detail::bin_at((x + reach_) / (2 * reach_) * static_cast<double>(bins_), bins_)];
      bin.mass += m;
      if (m != row_mass_ || v == 0) return;
      (v > 0 ? bin.right : bin.left) += 1;
      (v > 0 ? bin.right_speed : bin.left_speed) += v;
    };
    for_each_particle(c, particles, elapsed, {-reach_, reach_}, count, stopped);
  }
  void add_found() {
    part_[taken_ * parts / samples_] = std::move(found_);
    ++taken_;
  }

  std::size_t samples() const { return taken_; }
  double centre(std::size_t bin) const { return place(static_cast<double>(bin) + 0.5); }
  std::vector<double> mass_density() const { return per_length(&Bin::mass); }
  std::vector<double> density_right() const { return per_length(&Bin::right); }
  std::vector<double> density_left() const { return per_length(&Bin::left); }
  std::vector<double> velocity_right() const { return quotient(&Bin::right_speed, &Bin::right); }
  std::vector<double> velocity_left() const { return quotient(&Bin::left_speed, &Bin::left); }

  // For rows at `speed` whose particles merge below the closing speed `critical`.
  ZoneWidth width(double speed, double critical) const {
    std::vector<double> widths;
    for (const Part& part : part_)
      if (const auto fall = half_fall(part, speed)) widths.push_back(2 * *fall * (1 - critical / speed));
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (2 * widths.size() <= parts) return {none, none};
    const double middle = median(widths), n = static_cast<double>(widths.size());
    for (double& width : widths) width = std::abs(width - middle);
    return {middle, 1.253 * 1.483 * median(widths) / std::sqrt(n)};
  }

  static auto state(auto& self) { return fields(self.taken_, self.part_); }
  void loaded() const {
    require_state(part_.size() == parts && taken_ <= samples_, "samples");
    for (const Part& part : part_) require_state(part.size() == bins_, "bins");
  }

 private:
  struct Bin {
    double mass = 0, right = 0, right_speed = 0, left = 0, left_speed = 0;
    static auto state(auto& self) {
      return fields(self.mass, self.right, self.right_speed, self.left, self.left_speed);
    }
  };
  using Part = std::vector<Bin>;  // sums over the samples of one part of the time

  double place(double bin) const { return reach_ * (2 * bin / static_cast<double>(bins_) - 1); }

  double total(double Bin::*number, std::size_t bin) const {
    double sum = 0;
    for (const Part& part : part_) sum += part[bin].*number;
    return sum;
  }
  std::vector<double> per_length(double Bin::*number) const {
    const double scale = static_cast<double>(bins_) / (2 * reach_ * static_cast<double>(taken_));
    std::vector<double> density(bins_);
    for (std::size_t bin = 0; bin < bins_; ++bin) density[bin] = total(number, bin) * scale;
    return density;
  }
  std::vector<double> quotient(double Bin::*sum, double Bin::*weight) const {
    std::vector<double> mean(bins_);
    for (std::size_t bin = 0; bin < bins_; ++bin) mean[bin] = detail::mean(total(sum, bin), total(weight, bin));
    return mean;
  }

  // The distance between the points at which u+ is 3/4 and 1/4 of u0, interpolated between the centres of bins.
  std::optional<double> half_fall(const Part& part, double speed) const {
    std::array<double, 2> crossing{};
    std::size_t found = 0;
    double before = speed, x_before = -reach_;
    for (std::size_t bin = 0; bin < bins_ && found < 2; ++bin) {
      const Bin &here = part[bin], &mirrored = part[bins_ - 1 - bin];
      const double speeds = here.right_speed - mirrored.left_speed, movers = here.right + mirrored.left;
      if (!(movers > 0)) continue;
      const double u = speeds / movers, x = centre(bin);
      while (found < 2 && u < speed * (found == 0 ? 0.75 : 0.25)) {
        const double level = speed * (found == 0 ? 0.75 : 0.25);
        crossing.at(found++) = x_before + (x - x_before) * (before - level) / (before - u);
      }
      before = u;
      x_before = x;
    }
    if (found < 2) return std::nullopt;
    return crossing[1] - crossing[0];
  }

  double reach_;
  std::size_t bins_, samples_, taken_ = 0;
  double row_mass_;
  std::vector<Part> part_;
  Part found_;  // the part of a sample that has been found, with it
};

}  // namespace cradle
