#pragma once
// A gas of a few particles in exact rational arithmetic, in the plainest way: all pairs of neighbours are asked who
// meets first, particles fly there, the law acts. What two neighbouring pairs do at one moment is nobody's to say:
// `tied`.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/initial/particles.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test {

enum class ExactLaw { inelastic, sticky };

struct ExactGas {
  std::vector<Rational> x, v, m;
  Rational restitution{1}, cutoff{0}, length{0};  // length: of a ring
  ExactLaw law = ExactLaw::inelastic;

  Rational time{0};
  std::vector<std::vector<ParticleIndex>> clusters;  // from left to right; of one particle each unless they merge
  std::uint64_t below_cutoff = 0;
  bool tied = false;

  void begin() {
    clusters.clear();
    for (std::size_t b = 0; b < x.size(); ++b) clusters.push_back({static_cast<ParticleIndex>(b)});
  }

  // The next collision not after `until`, made; `wrong_side`: as if it were on the other side of the cut-off.
  std::optional<std::pair<ParticleIndex, ParticleIndex>> next(const Rational& until, bool wrong_side = false) {
    std::optional<Rational> first;
    std::size_t at = 0;
    const std::size_t pairs = clusters.size() < 2 ? 0 : clusters.size() - (length > 0 ? 0 : 1);
    std::vector<std::size_t> together;
    for (std::size_t k = 0; k < pairs; ++k) {
      const std::size_t l = name(k), r = name(next_to(k));
      if (!(v[l] > v[r])) continue;
      const Rational gap = x[r] - x[l] + (k + 1 == clusters.size() ? length : Rational(0));
      const Rational due = time + gap / (v[l] - v[r]);
      if (!first || due < *first) first = due, at = k, together.clear();
      if (due == *first) together.push_back(k);
    }
    if (!first || *first > until) return std::nullopt;
    for (const std::size_t a : together)
      for (const std::size_t b : together) tied = tied || (a != b && (next_to(a) == b || next_to(b) == a));
    fly(*first);
    return collide(at, wrong_side);
  }
  void fly(const Rational& to) {
    for (const auto& cluster : clusters) {
      const std::size_t b = static_cast<std::size_t>(cluster.front());
      x[b] += v[b] * (to - time);
    }
    time = to;
  }
  Rational energy() const {
    Rational twice(0);
    for (std::size_t k = 0; k < clusters.size(); ++k) twice += mass(k) * v[name(k)] * v[name(k)];
    return twice / 2;
  }
  // A cluster's place and velocity are those of its first particle in the list.
  std::size_t name(std::size_t k) const { return static_cast<std::size_t>(clusters[k].front()); }

 private:
  std::size_t next_to(std::size_t k) const { return k + 1 < clusters.size() ? k + 1 : 0; }
  Rational mass(std::size_t k) const {
    Rational all(0);
    for (const ParticleIndex b : clusters[k]) all += m[static_cast<std::size_t>(b)];
    return all;
  }

  std::pair<ParticleIndex, ParticleIndex> collide(std::size_t k, bool wrong_side) {
    const std::size_t n = next_to(k), l = name(k), r = name(n);
    const Rational w = v[l] - v[r], left = mass(k), right = mass(n), all = left + right;
    const std::pair collision{clusters[k].front(), clusters[n].front()};
    if (law == ExactLaw::sticky) {
      const Rational velocity = (left * v[l] + right * v[r]) / all;
      clusters[k].insert(clusters[k].end(), clusters[n].begin(), clusters[n].end());
      v[l] = velocity;
      clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(n));
      return collision;
    }
    const bool below = (w < cutoff) != wrong_side;
    below_cutoff += below;
    const Rational handed = (1 + (below ? Rational(1) : restitution)) * w;
    v[l] -= handed * right / all;
    v[r] += handed * left / all;
    return collision;
  }
};

}  // namespace cradle::test
