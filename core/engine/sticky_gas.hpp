#pragma once
// The sticky gas without events: its state at a time t follows from the initial data alone. Particles merge if their
// free flights up to t would be out of order; averaging continues until none are. From left to right, every particle is
// put on a stack with its mass M, moment S = m (x + v t) and momentum P = m v; while the cluster below the top is at or
// beyond the top one (compare S/M), the two are merged. The remaining clusters are at S/M with velocity P/M (the lower
// convex hull of moment against mass; weighted isotonic regression). It takes O(N), and less from one time to the next,
// since clusters never separate: they are the particles of the next step.
//
// On a ring of circumference L the line must be cut between two clusters. Such a place is the minimum of
//   F_k = S_k - (L/2M) M_k^2 - (S_N - L M/2) M_k/M,   M_k, S_k cumulative mass and moment, M = M_N,
// computed from its increments m [y - (L/M)(M_k + m/2) - (S_N/M - L/2)], y = x + v t: differences of terms of N^2 L
// would not resolve it.
//
// Of incoming rows only particles that have been hit are held, and one more on either side, which moves freely, as do
// all particles beyond it. Particles are taken in at both ends until the outermost held cluster is a single particle.

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/core/queue/ledger.hpp"
#include "cradle/core/queue/relative_motion.hpp"

namespace cradle {

template <Real T> class StickyGas {
 public:
  using Scalar = T;

  // Throws std::invalid_argument as chains do. Of the policy it uses the caller's functions.
  StickyGas(std::shared_ptr<const Particles<T>> particles, const T& start, Policy<T> policy = {})
      : particles_(std::move(particles)), policy_(std::move(policy)), ring_(particles_->on_ring()), start_(start),
        time_(start), common_(particles_->common_velocity()), lost_(particles_->energy_to_lose()) {
    require_particles(*particles_, start);
    require_no_gravity(*particles_, "leave gravity out, which merges no particles");
    const GapRange moving = ring_ ? GapRange{0, particles_->count() - 2} : particles_->gaps_in_motion();
    for (ParticleIndex b = moving.first; b <= moving.last + 1; ++b) held_.push_back(single(b));
  }

  // Advances to the state at a time not before the last one: all particles that meet until then have merged. After an
  // interruption a call with the same time continues, with the same bits: the held clusters are in order already.
  Status advance(const T& time) {
    time_ = time;
    elapsed_ = time - start_;
    for (MergedParticles& lump : held_) lump.x = place(lump);
    if (ring_) cut();
    std::deque<MergedParticles> before = std::exchange(held_, {});
    for (const MergedParticles& lump : before) push_right(lump);
    return ring_ ? Status::reached : take_in_rows();
  }

  const Counts& counts() const { return counts_; }
  T energy_lost() const { return lost_.value(); }
  T energy_lost(const T&) const { return energy_lost(); }
  // Of all particles of the scene; unheld particles move like the outermost held one.
  static constexpr bool falls() { return false; }
  T kinetic_energy(const T&) const { return kinetic_energy(); }
  T kinetic_energy() const {
    const T total = particles_->total_mass(), drift = particles_->conserved_momentum() / total;
    const auto moving = relative_motion(total, T(drift - common_), [&](const T& c, const auto& add) {
      for (std::size_t k = 0; k < held_.size(); ++k) {
        T mass = held_[k].mass;
        if (!ring_ && k == 0) mass += particles_->mass_between(0, held_[k].first);
        if (!ring_ && k + 1 == held_.size())
          mass += particles_->mass_between(held_[k].first + held_[k].count, particles_->count());
        add(mass, T(velocity(held_[k]) - c));
      }
    });
    return total * drift * drift / T(2) + moving.energy;
  }
  T last_collision_time() const { return time_; }  // collisions have no times here: the time of the state
  const Account<T>& account() const { return account_; }
  bool on_ring() const { return ring_; }

  // ---- at the time advanced to
  // The number of clusters between the outermost two that have collided, both included.
  ParticleIndex collided_particles() const {
    if (ring_) return static_cast<ParticleIndex>(held_.size());
    const auto [from, to] = collided();
    return static_cast<ParticleIndex>(to - from);
  }
  T front_left(const T&) const { return drifted(held_[collided().first].x); }
  T front_right(const T&) const { return drifted(held_[collided().second - 1].x); }

  // As for a chain, but that a cluster is named after its heaviest particle, the leftmost of equal ones: the order of
  // merges, by which a chain names it, is not known here.
  Configuration<T> configuration(const T&) const {
    Configuration<T> c;
    c.time = time_;
    auto [from, to] = ring_ ? std::pair{std::size_t{0}, held_.size()} : collided();
    const bool begun = from < to;
    const std::size_t first = begun && from > 0 ? from - 1 : 0;
    const std::size_t last = begun && to < held_.size() ? to + 1 : held_.size();
    if (begun) c.collided_from = from - first, c.collided_to = to - first;
    for (std::size_t j = first; j < last; ++j) {
      c.index.push_back(held_[j].heaviest);
      c.m.push_back(held_[j].mass);
      c.x.push_back(held_[j].x);
      c.v.push_back(velocity(held_[j]));
    }
    for (std::size_t j = 0; j + 1 < c.x.size(); ++j) {
      c.gap.push_back(c.x[j + 1] - c.x[j]);
      c.closing_speed.push_back(c.v[j] - c.v[j + 1]);
    }
    c.from = held_[first].first;
    c.to = held_[last - 1].first + held_[last - 1].count - 1;
    if (ring_) {
      c.from = 0, c.to = particles_->count() - 1;
      c.gap.push_back(c.x.front() + (particles_->circumference() - c.x.back()));
      c.closing_speed.push_back(c.v.back() - c.v.front());
    }
    for (T& x : c.x) x = drifted(x);
    for (T& v : c.v) v += common_;
    if (ring_) fold(c, particles_->circumference());
    return c;
  }

  Configuration<T> configuration_at_last_collision() const { return configuration(time_); }

  static auto state(auto& self) { return fields(self.time_, self.elapsed_, self.held_, self.counts_, self.lost_); }
  void loaded() const {
    require_state(!held_.empty(), "no particles");
    const ParticleIndex count = particles_->count();
    ParticleIndex in_all = 0;
    for (const MergedParticles& lump : held_) {
      require_state(lump.holds_numbers() && lump.first >= 0 && lump.first < count && lump.count > 0 &&
                        lump.count <= (ring_ ? count - in_all : count - lump.first) && lump.heaviest >= 0 &&
                        lump.heaviest < count,
                    "clusters");
      in_all += lump.count;
    }
    require_state(!ring_ || in_all == count, "clusters");
    for (std::size_t k = 0; !ring_ && k + 1 < held_.size(); ++k)
      require_state(held_[k].first + held_[k].count == held_[k + 1].first, "clusters");
    require_state(is_finite(time_) && is_finite(elapsed_), "times");
  }

 private:
  // Particles that have merged, in a frame that moves with the velocity that all have in common. moment: at the start;
  // x: at the time advanced to.
  struct MergedParticles {
    T mass, moment, momentum, x;
    ParticleIndex first, count, heaviest;
    T greatest;  // mass of the heaviest particle

    static auto state(auto& self) {
      return fields(self.mass, self.moment, self.momentum, self.x, self.first, self.count, self.heaviest,
                    self.greatest);
    }
    bool holds_numbers() const {
      return is_positive(mass) && is_positive(greatest) && is_finite(T(mass + greatest)) && is_finite(moment) &&
             is_finite(momentum) && is_finite(x);
    }
  };

  MergedParticles single(ParticleIndex b) const {
    const T m = particles_->mass(b);
    const T v = particles_->relative_velocity(b, common_);
    MergedParticles lump{m, m * particles_->position(b), m * v, T(0), b, 1, b, m};
    lump.x = place(lump);
    return lump;
  }
  T place(const MergedParticles& c) const { return (c.moment + c.momentum * elapsed_) / c.mass; }
  static T velocity(const MergedParticles& c) { return c.momentum / c.mass; }
  T drifted(const T& x) const { return x + common_ * elapsed_; }

  // Particles of equal velocity never meet, even if rounding of distant positions says so.
  static bool met(const MergedParticles& left, const MergedParticles& right) {
    return !(left.x < right.x) && velocity(right) < velocity(left);
  }
  void push_right(MergedParticles lump) {
    for (; !held_.empty() && met(held_.back(), lump); held_.pop_back()) lump = merged(held_.back(), lump);
    held_.push_back(std::move(lump));
  }
  void push_left(MergedParticles lump) {
    for (; !held_.empty() && met(lump, held_.front()); held_.pop_front()) lump = merged(lump, held_.front());
    held_.push_front(std::move(lump));
  }
  MergedParticles merged(const MergedParticles& left, const MergedParticles& right) {
    const T mass = left.mass + right.mass, closing = velocity(left) - velocity(right);
    lost_.add(left.mass * (right.mass / mass) * closing * closing / T(2));
    ++counts_.merges;
    ++counts_.collisions;
    MergedParticles both = left.greatest < right.greatest ? right : left;  // with its name
    both.mass = mass, both.moment = left.moment + right.moment, both.momentum = left.momentum + right.momentum;
    both.first = left.first, both.count = left.count + right.count;
    both.x = place(both);
    return both;
  }

  // The half-open range of held lumps between the outermost ones that have collided.
  std::pair<std::size_t, std::size_t> collided() const {
    std::size_t from = 0, to = held_.size();
    while (from < to && held_[from].count == 1) ++from;
    while (to > from && held_[to - 1].count == 1) --to;
    return {from, to};
  }

  Status take_in_rows() {
    std::uint64_t taken = 0;
    for (bool more = true; more;) {
      if (++taken % (1 << 14) == 0 && policy_.poll(time_, counts_) != Status::reached) return Status::interrupted;
      more = false;
      const ParticleIndex left = held_.front().first - 1, right = held_.back().first + held_.back().count;
      const bool reaches_left = held_.front().count > 1 && left >= 0;
      if (held_.back().count > 1 && right < particles_->count()) push_right(single(right)), more = true;
      if (reaches_left) push_left(single(left)), more = true;
    }
    return Status::reached;
  }

  // Rotates the ring so that it is cut between two clusters.
  void cut() {
    CompensatedSum<T> mass_sum, moment_sum;
    for (const MergedParticles& lump : held_) {
      mass_sum.add(lump.mass);
      moment_sum.add(lump.mass * lump.x);
    }
    const T length = particles_->circumference(), mass = mass_sum.value();
    const T middle = moment_sum.value() / mass - length / T(2), per_mass = length / mass;
    CompensatedSum<T> height;
    T least(0), passed(0);
    std::size_t lowest = 0;
    for (std::size_t k = 0; k + 1 < held_.size(); ++k) {
      const MergedParticles& lump = held_[k];
      height.add(lump.mass * (lump.x - per_mass * (passed + lump.mass / T(2)) - middle));
      passed += lump.mass;
      if (height.value() < least) least = height.value(), lowest = k + 1;
    }
    for (std::size_t k = 0; k < lowest; ++k) {
      held_[k].moment += held_[k].mass * length;
      held_[k].x += length;
    }
    std::rotate(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(lowest), held_.end());
  }

  std::shared_ptr<const Particles<T>> particles_;
  Policy<T> policy_;
  bool ring_;
  T start_, time_, elapsed_{0}, common_;
  std::deque<MergedParticles> held_;  // from left to right
  Counts counts_;
  Ledger<T> lost_;
  Account<T> account_;  // always empty: without events none can be late
};

}  // namespace cradle
