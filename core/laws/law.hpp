#pragma once
// Collision laws: closing speed and masses in, outcome out; pure functions of values, all with the same interface,
//
//   law(w, masses)
//
//   w        closing speed v_l - v_r > 0 of the two colliding particles
//   masses   theirs, as TwoMasses or EqualMasses; mu = m_l m_r / (m_l + m_r) is the reduced mass
//
// The outcome says what the two particles do: bounce, pass through each other (Newton's cradle: the left one comes out
// on the right) or merge. For an impulse J from left to right the left particle loses J/m_l and the right one gains
// J/m_r. README.md (Laws) has the laws, and says why their formulas are computed as they are.

#include <cmath>
#include <concepts>
#include <cstdint>

#include "cradle/core/base/elementary.hpp"
#include "cradle/core/base/real.hpp"

namespace cradle {

enum class Event : std::uint8_t { bounce, pass, merge };

// Outcome of a collision, in closing speeds: that of the pair after it, and the gains of the gaps on either side.
template <Real T> struct Outcome {
  T closing;      // w' of the pair, <= 0
  T to_left;      // J / m_l, gained by the gap on the left
  T to_right;     // J / m_r, gained by the gap on the right
  T energy_lost;  // >= 0
  bool below_cutoff = false;
  Event event = Event::bounce;
};

// The changes of the closing speed by each of the two particles, J/m_l and J/m_r; their sum is w - w'.
template <Real T> struct Shares { T left, right; };

// The masses of two colliding particles: references to numbers held elsewhere; do not store them.
template <Real T> struct TwoMasses {
  const T &left, &right;

  T reduced() const { return left * (right / (left + right)); }
  // The lighter particle takes the larger share: compute that one by subtraction, so that both shares add up. It is
  // rounded, for masses in the ratio of small integers more often up than down, or down than up: then take the smaller
  // share as what is left, which is exact, unless that would cost it more than 4 bits.
  Shares<T> shares(const T& half) const {
    const T handed = half + half;
    const bool left_lighter = left < right;
    const T share = (left_lighter ? left : right) / (left + right);
    const T rough = handed * share, large = handed - rough, small = share < T(1) / T(16) ? rough : T(handed - large);
    return {left_lighter ? large : small, left_lighter ? small : large};
  }
};

// The same mass twice, and half of it, without divisions. The bits are those of TwoMasses.
template <Real T> struct EqualMasses {
  const T &left, &half;
  const T& right = left;

  const T& reduced() const { return half; }
  Shares<T> shares(const T& half_of_change) const { return {half_of_change, half_of_change}; }
};

// A collision law in the scalar T; `bounces_only` says whether particles keep their order and number.
template <class L, class T>
concept Law = Real<T> && requires(const L law, const T& w, const TwoMasses<T>& two, const EqualMasses<T>& equal) {
  { L::bounces_only } -> std::convertible_to<bool>;
  { law(w, two) } -> std::same_as<Outcome<T>>;
  { law(w, equal) } -> std::same_as<Outcome<T>>;
};

// A law for which a collision is elastic(w, masses) if one of the particles has had another one within contact_time() >
// 0 before it; the chain remembers when.
template <class L, class T>
concept LawWithMemory = Law<L, T> && requires(const L law, const T& w, const TwoMasses<T>& two) {
  { law.contact_time() } -> std::convertible_to<T>;
  { law.elastic(w, two) } -> std::same_as<Outcome<T>>;
};

// A law that says whether every outcome is proportional to the closing speed, at any speed. For other laws this is
// unknown, and no collapse is proved for them (collapse_ahead.hpp).
template <class L>
concept ScaleFreeLaw = requires(const L law) {
  { law.scale_free() } -> std::same_as<bool>;
};

// Whether it says that outcomes are not proportional.
template <class L> bool has_threshold(const L& law) {
  if constexpr (ScaleFreeLaw<L>)
    return !law.scale_free();
  else
    return false;
}

// Inelastic law (paper, section II and III): w' = -eps w; below the velocity cut-off delta the collision is elastic.
template <Real T> class Inelastic {
 public:
  static constexpr bool bounces_only = true;

  // restitution in [0, 1]; cutoff >= 0, a speed (0: none).
  explicit Inelastic(const T& restitution, const T& cutoff = T(0))
      : restitution_(restitution), cutoff_(cutoff), half_sum_((T(1) + restitution) / T(2)),
        lost_((T(1) - restitution) * (T(1) + restitution) / T(2)), soft_(restitution * T(2) < T(1)) {}

  template <class Masses> Outcome<T> operator()(const T& w, const Masses& masses) const {
    return outcome(w, masses, w < cutoff_);
  }
  // The outcome of an elastic collision, as below the cut-off, for any speed.
  template <class Masses> Outcome<T> elastic(const T& w, const Masses& masses) const {
    return outcome(w, masses, true);
  }

  const T& restitution() const { return restitution_; }
  const T& cutoff() const { return cutoff_; }
  bool scale_free() const { return !is_positive(cutoff_); }
  // The law's numbers as they are used in computing.
  const T& half_sum() const { return half_sum_; }
  const T& lost_share() const { return lost_; }
  bool soft() const { return soft_; }

 private:
  template <class Masses> Outcome<T> outcome(const T& w, const Masses& masses, bool elastic) const {
    const T after = closing_after(w, elastic);
    const Shares<T> shares = masses.shares(soft_ ? T((w - after) / T(2)) : T(share(elastic) * w));
    return {after, shares.left, shares.right, energy_lost(w, masses.reduced(), elastic), elastic};
  }

  // Selects a number, not a computation: late in a collapse the choice cannot be predicted.
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
};

// Inelastic law whose restitution depends on the closing speed (Shinde, Das and Rajesh, PRL 99, 234505, 2007, doi
// 10.1103/PhysRevLett.99.234505):
//
//   eps(w) = eps + (1 - eps) exp(-(w/delta)^sigma),
//
// elastic for slow collisions and with restitution eps for fast ones; sigma -> infinity is the plain law's cut-off.
// Collisions below delta are counted as below the cut-off.
template <Real T> class SpeedDependent {
 public:
  static constexpr bool bounces_only = true;

  // restitution in [0, 1]; cutoff delta > 0, a speed; exponent sigma > 0.
  SpeedDependent(const T& restitution, const T& cutoff, const T& exponent)
      : missing_(T(1) - restitution), cutoff_(cutoff), power_(exponent) {}

  template <class Masses> Outcome<T> operator()(const T& w, const Masses& masses) const {
    const T missing = missing_ * rise_(power_(T(w / cutoff_)));  // 1 - eps(w)
    const T restitution = T(1) - missing;
    const T half_sum = T(1) - missing / T(2);  // (1 + eps(w))/2
    T after(0), half(0);
    if (restitution * T(2) < T(1)) {  // as in the plain law, the number that would cancel is computed second
      after = -(restitution * w);
      half = (w - after) / T(2);
    } else {
      half = half_sum * w;
      after = w - (half + half);
    }
    const Shares<T> shares = masses.shares(half);
    return {after, shares.left, shares.right, missing * half_sum * masses.reduced() * (w * w), w < cutoff_};
  }
  bool scale_free() const { return false; }
  bool below_cutoff(const T& w) const { return w < cutoff_; }

  // The law's numbers as they are used in computing: 1 - eps, delta, the functions of (w/delta)^sigma.
  const T& missing() const { return missing_; }
  const T& delta() const { return cutoff_; }
  const Power<T>& power() const { return power_; }
  const ExponentialRise<T>& rise() const { return rise_; }

 private:
  T missing_, cutoff_;
  Power<T> power_;
  ExponentialRise<T> rise_;
};

// The inelastic law with a duration of collisions (TC model: Luding and McNamara 1998, doi 10.1007/s100350050017). A
// collision is also elastic if one of the particles has had another one within that duration.
template <Real T> class ContactTime {
 public:
  static constexpr bool bounces_only = true;

  // contact_time > 0.
  ContactTime(const Inelastic<T>& law, const T& contact_time) : law_(law), contact_time_(contact_time) {}

  template <class Masses> Outcome<T> operator()(const T& w, const Masses& masses) const { return law_(w, masses); }
  template <class Masses> Outcome<T> elastic(const T& w, const Masses& masses) const { return law_.elastic(w, masses); }
  const T& contact_time() const { return contact_time_; }
  bool scale_free() const { return false; }
  const T& cutoff() const { return law_.cutoff(); }

 private:
  Inelastic<T> law_;
  T contact_time_;
};

// Inelastic law whose particles merge below a closing speed (collapse policy `merge`).
template <Real T> class InelasticMerging {
 public:
  static constexpr bool bounces_only = false;

  InelasticMerging(const Inelastic<T>& law, const T& merge_speed) : law_(law), merge_speed_(merge_speed) {}

  template <class Masses> Outcome<T> operator()(const T& w, const Masses& masses) const {
    return w < merge_speed_ ? merged(w, masses) : law_(w, masses);
  }

  // They merge: all relative kinetic energy mu w^2/2 is lost.
  template <class Masses> static Outcome<T> merged(const T& w, const Masses& masses) {
    const T total_mass = masses.left + masses.right;
    const T to_right = w * (masses.left / total_mass);
    return {T(0), w * (masses.right / total_mass), to_right, masses.right * to_right * w / T(2), false, Event::merge};
  }

 private:
  Inelastic<T> law_;
  T merge_speed_;
};

// Sticky law: every collision merges.
template <Real T> struct Sticky {
  static constexpr bool bounces_only = false;

  template <class Masses> Outcome<T> operator()(const T& w, const Masses& masses) const {
    return InelasticMerging<T>::merged(w, masses);
  }
};

// Wet law (paper, section II): a collision costs E_loss, and the particles pass through each other; if their relative
// kinetic energy mu w^2/2 does not exceed E_loss, they merge. If w is not near w_c = sqrt(2 E_loss/mu), the outcome is
// decided without the root, so that the processor predicts the branch.
template <Real T> class Wet {
 public:
  static constexpr bool bounces_only = false;

  explicit Wet(const T& loss)
      : loss_(loss), twice_loss_(loss + loss), below_(twice_loss_ - twice_loss_ / T(1024)),
        above_(twice_loss_ + twice_loss_ / T(1024)) {}

  template <class Masses> Outcome<T> operator()(const T& w, const Masses& masses) const {
    using std::sqrt;
    const T total = masses.left + masses.right, product = masses.left * masses.right, scaled = w * w * product;
    if (scaled < below_ * total) return InelasticMerging<T>::merged(w, masses);
    const T critical = sqrt(T(twice_loss_ * (total / product)));
    if (!(scaled > above_ * total) && !(w > critical)) return InelasticMerging<T>::merged(w, masses);
    const T after = sqrt(T((w - critical) * (w + critical)));
    const T impulse = twice_loss_ / (w + after);
    return {-after, impulse / masses.left, impulse / masses.right, loss_, false, Event::pass};
  }

  // The law's numbers as they are used in computing.
  const T& loss() const { return loss_; }
  const T& twice_loss() const { return twice_loss_; }
  const T& below() const { return below_; }
  const T& above() const { return above_; }

 private:
  T loss_, twice_loss_;
  T below_, above_;  // 2 E_loss times 1 - 1/1024 and 1 + 1/1024: between them mu w^2 needs the root
};

}  // namespace cradle
