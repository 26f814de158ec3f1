#pragma once
// Collision laws: closing speed and masses in, outcome out; pure functions of values.
//
//   w   closing speed u_l - u_r > 0 of the two bodies in contact
//   m   their masses, mu = m_l m_r / (m_l + m_r) the reduced mass
//
// A law is called with w and the masses and says what the two bodies do: bounce, pass through each other (Newton's
// cradle: the one that was left comes out on the right) or merge. Bodies lose J/m_l and gain J/m_r for an impulse J
// from left to right.
//
// Inelastic law (paper, section II and III): w' = -eps w, energy lost mu w^2 (1 - eps^2)/2; below the velocity cut-off
// delta the contact is elastic. The closing speed handed to the neighbours, w - w', is formed such that the sum of all
// closing speeds is kept: for eps >= 1/2 the impulse comes first and w' = w - (its effect) is exact; below, w' = -eps w
// comes first because there the difference would cancel.

#include <cmath>
#include <cstdint>

#include "cradle/core/real.hpp"

namespace cradle {

enum class Event : std::uint8_t { bounce, pass, merge };

// Outcome of a contact, in closing speeds: the pair's own after it, and what the gaps on either side gain.
template <Real T> struct Outcome {
  T closing;      // w' of the pair, <= 0
  T to_left;      // J / m_l, gained by the gap on the left
  T to_right;     // J / m_r, gained by the gap on the right
  T energy_lost;  // >= 0
  bool below_cutoff = false;
  Event event = Event::bounce;
};

template <Real T> class Inelastic {
 public:
  // restitution in [0, 1]; cutoff >= 0, a speed (0: the plain law); contact_time >= 0: contacts are elastic too where
  // one of the bodies has had another one less than that before (TC model: Luding and McNamara 1998,
  // doi 10.1007/s100350050017).
  explicit Inelastic(const T& restitution, const T& cutoff = T(0), const T& contact_time = T(0))
      : restitution_(restitution), cutoff_(cutoff), half_sum_((T(1) + restitution) / T(2)),
        lost_((T(1) - restitution) * (T(1) + restitution) / T(2)), soft_(restitution * T(2) < T(1)),
        contact_time_(contact_time), remembers_(contact_time > T(0)) {}

  // Two bodies of the same mass m: mu = m/2.
  Outcome<T> operator()(const T& w, const T& reduced_mass, bool rested = true) const {
    const bool elastic = w < cutoff_ || !rested;
    const T after = closing_after(w, elastic);
    const T handed = soft_ ? T((w - after) / T(2)) : T(share(elastic) * w);
    return {after, handed, handed, energy_lost(w, reduced_mass, elastic), elastic};
  }

  Outcome<T> operator()(const T& w, const T& mass_left, const T& mass_right, bool rested = true) const {
    const bool elastic = w < cutoff_ || !rested;
    const T total_mass = mass_left + mass_right;
    const T after = closing_after(w, elastic);
    const T handed = soft_ ? T(w - after) : T(T(2) * (share(elastic) * w));
    // The lighter body takes the larger part: form that one by subtraction, so that both parts add up to w - w'.
    const bool left_lighter = mass_left < mass_right;
    const T small = handed * ((left_lighter ? mass_left : mass_right) / total_mass);
    const T large = handed - small;
    return {after, left_lighter ? large : small, left_lighter ? small : large,
            energy_lost(w, mass_left * (mass_right / total_mass), elastic), elastic};
  }

  const T& restitution() const { return restitution_; }
  const T& cutoff() const { return cutoff_; }

  // Whether outcomes depend on when the bodies last had a contact: `rested` says that it was longer ago than
  // contact_time().
  bool remembers() const { return remembers_; }
  const T& contact_time() const { return contact_time_; }

 private:
  // Choices between two numbers at hand, not between two computations: late in a collapse they cannot be predicted.
  const T& share(bool elastic) const { return elastic ? one_ : half_sum_; }
  T closing_after(const T& w, bool elastic) const {
    if (soft_) return -((elastic ? one_ : restitution_) * w);
    const T handed = share(elastic) * w;
    return w - (handed + handed);
  }
  T energy_lost(const T& w, const T& reduced_mass, bool elastic) const {
    return (elastic ? zero_ : lost_) * reduced_mass * (w * w);
  }

  T restitution_;
  T cutoff_;
  T half_sum_;  // (1 + eps) / 2
  T lost_;      // (1 - eps)(1 + eps) / 2, the share of mu w^2 that is lost
  T one_{1}, zero_{0};
  bool soft_;  // eps < 1/2
  T contact_time_;
  bool remembers_;
};

// Inelastic law whose bodies stick below a closing speed (collapse policy `merge`).
template <Real T> class InelasticMerging {
 public:
  InelasticMerging(const Inelastic<T>& law, const T& merge_speed) : law_(law), merge_speed_(merge_speed) {}

  Outcome<T> operator()(const T& w, const T& mass_left, const T& mass_right) const {
    return w < merge_speed_ ? merged(w, mass_left, mass_right) : law_(w, mass_left, mass_right);
  }

  // They go on as one: all relative kinetic energy mu w^2/2 is lost.
  static Outcome<T> merged(const T& w, const T& mass_left, const T& mass_right) {
    const T total_mass = mass_left + mass_right;
    const T to_right = w * (mass_left / total_mass);
    return {T(0), w * (mass_right / total_mass), to_right, mass_right * to_right * w / T(2), false, Event::merge};
  }

 private:
  Inelastic<T> law_;
  T merge_speed_;
};

// Sticky law: every contact merges.
template <Real T> struct Sticky {
  Outcome<T> operator()(const T& w, const T& mass_left, const T& mass_right) const {
    return InelasticMerging<T>::merged(w, mass_left, mass_right);
  }
};

// Wet law (paper, section II): a contact costs E_loss, the bodies pass through each other; if their relative kinetic
// energy mu w^2/2 does not exceed it, they merge. With w_c = sqrt(2 E_loss/mu): w' = sqrt((w - w_c)(w + w_c)), since
// w^2 - w_c^2 loses half the digits at the threshold, and J = 2 E_loss/(w + w'), never mu (w - w'). Where w is not near
// w_c, which of the two happens is told without the root, so that the processor guesses right or learns soon.
template <Real T> class Wet {
 public:
  explicit Wet(const T& loss)
      : loss_(loss), twice_loss_(loss + loss), below_(twice_loss_ - twice_loss_ / T(1024)),
        above_(twice_loss_ + twice_loss_ / T(1024)) {}

  Outcome<T> operator()(const T& w, const T& mass_left, const T& mass_right) const {
    using std::sqrt;
    const T total = mass_left + mass_right, product = mass_left * mass_right, scaled = w * w * product;
    if (scaled < below_ * total) return InelasticMerging<T>::merged(w, mass_left, mass_right);
    const T critical = sqrt(T(twice_loss_ * (total / product)));
    if (!(scaled > above_ * total) && !(w > critical)) return InelasticMerging<T>::merged(w, mass_left, mass_right);
    const T after = sqrt(T((w - critical) * (w + critical)));
    const T impulse = twice_loss_ / (w + after);
    return {-after, impulse / mass_left, impulse / mass_right, loss_, false, Event::pass};
  }

 private:
  T loss_, twice_loss_;
  T below_, above_;  // that, a thousandth less and more
};

}  // namespace cradle
