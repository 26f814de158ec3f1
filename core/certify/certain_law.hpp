#pragma once
// Collision laws where closing speeds and coefficients are enclosed: what two particles do, if that is certain, and the
// coefficients c of their new world lines (checker.hpp),
//
//   l' = l - c_l (l - r),   r' = r + c_r (l - r),
//
// in places at the start and velocities alike: c_l = J/(m_l w), c_r = J/(m_r w) for the impulse J. Among identical
// particles c = (1 + eps)/2 for both, 1 in an elastic collision; particles that merge meet in c_l = m_r/(m_l + m_r).
//
// A restitution r(w) = eps + (1 - eps) exp(-y), y = (w/delta)^sigma, has c = (1 + r(w))/2. The errors of velocities do
// not grow by c but by the derivative of the impulse, d(c w)/dw (README.md, How errors grow).

#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/certify/enclosing.hpp"
#include "cradle/core/laws/law.hpp"

namespace cradle {

// exp(-y) and y exp(-y), y = x^s, of numbers with enclosures. No code is shared with the engine's own functions
// (base/elementary.hpp).
//
//   exp(-y)   in the middle of y, h = y 2^-k <= 1/8: Taylor's series, whose terms alternate and fall, so that what is
//             left out is less than the first term left out; then k squares. Elsewhere in y, up to r away, it differs
//             by at most exp(-y) (exp(r) - 1), and exp(r) - 1 <= r + r^2 for r <= 1. Where y is certainly above n,
//             2^-n the epsilon of the numbers, 0 <= exp(-y) < 2^-n and 0 <= y exp(-y) < n 2^-n.
//   x^s       whole s: products. Else exp(s ln x), ln x = n ln 2 + 2 artanh((m - 1)/(m + 1)) in the middle of x, m =
//             2^-n x between 0.7 and 1.5, and up to r/(least x) more or less in all of x. Of the series for artanh z,
//             |z| <= 1/3, less than 9^-j |z| is left out after j terms.
template <Enclosing N> class CertainFall {
  using Radius = decltype(std::declval<const N&>().radius());

 public:
  // exp(-y), and times y.
  struct Values {
    N fall, weighted;
  };

  // s > 0.
  explicit CertainFall(const N& exponent) : exponent_(exponent), epsilon_(N(std::numeric_limits<N>::epsilon()).size()) {
    for (int n = 1; n <= most_products; ++n)
      if (exponent == N(n)) whole_ = n;
    far_ = -std::ilogb(epsilon_);
    left_out_ = 1;
    for (int n = 1; !(left_out_ < epsilon_); ++n) {
      reciprocals_.push_back(N(1) / N(n));
      left_out_ /= 7 * static_cast<Radius>(n);
    }
    if (whole_ > 0) return;
    Radius left_out = 1;
    for (int n = 0; !(left_out < epsilon_); ++n, left_out /= 9) odd_.push_back(N(1) / N(2 * n + 1));
    ln2_ = artanh(N(1) / N(3)) * N(2);
  }

  // x > 0, certainly.
  Values operator()(const N& x) const {
    if (!is_finite(x)) return {open(), open()};
    const Values beyond{N::widened(N(0), epsilon_), N::widened(N(0), epsilon_ * static_cast<Radius>(far_))};
    N y(0);
    if (whole_ > 0) {
      if (N(far_) < x) return beyond;
      y = product(x);
    } else {
      const N power = exponent_ * logarithm(x);
      if (N(static_cast<int>(std::log(far_)) + 2) < power) return beyond;
      y = below_zero(power) ? fall(-power) : N(1) / fall(power);
    }
    if (N(far_) < y) return beyond;
    const N falling = fall(y);
    return {falling, y * falling};
  }

 private:
  static constexpr int most_products = 64;

  static N open() { return N::widened(N(0), std::numeric_limits<Radius>::infinity()); }
  static bool below_zero(const N& x) { return is_negative(N(x.middle(), 0)); }

  N product(N base) const {
    N result(1);
    for (int n = whole_; n > 0; n /= 2) {
      if (n % 2 != 0) result *= base;
      if (n > 1) base *= base;
    }
    return result;
  }

  // exp(-y); what is infinitely uncertain where y is by more than 1.
  N fall(const N& y) const {
    if (N(far_) < y) return N::widened(N(0), epsilon_);
    const N middle = below_zero(y) ? N(0) : N(y.middle(), 0);
    const Radius off = below_zero(y) ? y.size() : y.radius();
    double size = to_double(middle);
    if (!(off <= 1 && size < 2. * far_)) return open();
    int squares = 0;
    for (; size > 0.125; size /= 2) ++squares;
    const N h = middle * N(std::ldexp(1., -squares));
    N value(1);  // 1 - h (1 - h/2 (1 - h/3 (...)))
    for (std::size_t n = reciprocals_.size() - 1; n-- > 0;) value = N(1) - h * reciprocals_[n] * value;
    value = N::widened(value, left_out_);
    for (; squares > 0; --squares) value *= value;
    return N::widened(value, value.size() * (off + off * off));
  }

  N logarithm(const N& x) const {
    N mantissa(x.middle(), 0);
    int exponent = 0, of_near = 0;
    double near = to_double(mantissa);
    for (; near < 0x1p-900; near = to_double(mantissa)) mantissa *= N(0x1p900), exponent -= 900;
    for (; near > 0x1p900; near = to_double(mantissa)) mantissa *= N(0x1p-900), exponent += 900;
    if (std::frexp(near, &of_near) < 0.7) --of_near;
    mantissa *= N(std::ldexp(1., -of_near));
    const N value = N(exponent + of_near) * ln2_ + artanh((mantissa - N(1)) / (mantissa + N(1))) * N(2);
    return N::widened(value, x.radius() / x.least_size());
  }
  N artanh(const N& z) const {
    const N square = z * z;
    N sum(0);
    for (std::size_t n = odd_.size(); n-- > 0;) sum = sum * square + odd_[n];
    return N::widened(z * sum, epsilon_);
  }

  N exponent_;
  int whole_ = 0;  // s, if it is a whole number and not too large
  Radius epsilon_;
  int far_ = 0;                 // n: beyond it exp(-y) is less than epsilon
  std::vector<N> reciprocals_;  // 1, 1/2, ...
  Radius left_out_ = 0;         // of the series for exp(-h)
  std::vector<N> odd_;          // 1, 1/3, ...
  N ln2_{0};
};

template <Enclosing N> struct CertainLaw {
  enum class Kind { inelastic, merging, sticky, wet };
  using Share = typename N::Share;

  Kind kind = Kind::inelastic;
  N restitution{1};
  bool elastic = false;                   // restitution is 1
  std::optional<N> cutoff = {};           // none: 0
  std::optional<N> cutoff_exponent = {};  // sigma, of a restitution r(w); then the cut-off is delta
  std::optional<N> contact_time = {};     // elastic where either particle had a collision less than that before
  N merge_speed{0};                       // merging: particles stick below
  N loss{0};                              // wet: energy per collision

  bool bounces_only() const { return kind == Kind::inelastic; }
  // Whether velocities after a collision are linear functions of those before.
  bool linear() const { return kind != Kind::wet && !cutoff_exponent; }
};

// Two particles that meet, as the law sees them. `rest`: since the last collision of either, where it had one.
template <Enclosing N> struct CertainCollision {
  N closing;
  std::optional<N> left_rest, right_rest;  // of laws with a contact time
  const N* left_velocity;
  const N* right_velocity;
};

// What is certain of a collision.
template <Enclosing N> struct CertainOutcome {
  Event event = Event::bounce;
  bool below_cutoff = false;
  bool exchange = false;       // identical particles, elastic: they exchange world lines
  bool right_heavier = false;  // of two that merge
  // Nothing: (1 + eps)/2, of identical particles.
  std::optional<typename N::Share> left, right;
  // Wet, r(w): after the collision, known better than by the shares.
  std::optional<N> left_velocity, right_velocity;

  void clear() {
    event = Event::bounce;
    below_cutoff = exchange = right_heavier = false;
    left.reset(), right.reset(), left_velocity.reset(), right_velocity.reset();
  }
};

// What a law does to two particles of these masses, which are not read where all have the same (`identical`). `compare`
// is order(). Returns the two numbers whose order the law needs and that is open; nothing where all is certain.
template <Enclosing N> class CertainLaws {
 public:
  using Kind = typename CertainLaw<N>::Kind;
  using Open = std::optional<std::pair<N, N>>;

  explicit CertainLaws(const CertainLaw<N>& of) : law(of), bouncing((N(1) + of.restitution) / N(2)) {
    if (law.cutoff_exponent) fall_.emplace(*law.cutoff_exponent);
  }

  template <class Compare>
  Open operator()(const CertainCollision<N>& collision, const N& l_mass, const N& r_mass, bool identical,
                  Compare compare, CertainOutcome<N>& outcome) const {
    if (law.kind == Kind::sticky) return merged(l_mass, r_mass, compare, outcome), std::nullopt;
    if (law.kind == Kind::wet) return wet(collision, l_mass, r_mass, compare, outcome);
    const N& w = collision.closing;
    if (law.kind == Kind::merging) {
      const Order order = compare(w, law.merge_speed);
      if (order == Order::open) return {{w, law.merge_speed}};
      if (order == Order::less) return merged(l_mass, r_mass, compare, outcome), std::nullopt;
    }
    if (law.cutoff) {
      const Order order = compare(w, *law.cutoff);
      if (order == Order::open) return {{w, *law.cutoff}};
      outcome.below_cutoff = order == Order::less;
    }
    if (law.cutoff_exponent) return of_speed(collision, l_mass, r_mass, identical, outcome), std::nullopt;
    for (const auto* rest : {&collision.left_rest, &collision.right_rest}) {
      if (!*rest) continue;
      const Order order = compare(**rest, *law.contact_time);
      if (order == Order::open) return {{**rest, *law.contact_time}};
      outcome.below_cutoff = outcome.below_cutoff || order == Order::less;
    }
    const bool elastic = law.elastic || outcome.below_cutoff;
    outcome.exchange = elastic && identical;
    if (identical) return std::nullopt;
    const N of_both = (elastic ? N(2) : N(1) + law.restitution) / (l_mass + r_mass);
    outcome.left.emplace(of_both * r_mass);
    outcome.right.emplace(of_both * l_mass);
    return std::nullopt;
  }

  CertainLaw<N> law;
  typename N::Share bouncing;

 private:
  using Share = typename N::Share;
  std::optional<CertainFall<N>> fall_;

  // What bounces of constant restitution do not need is compiled apart from them: the checker inlines all of theirs.
  template <class Compare>
  [[gnu::noinline]] void merged(const N& l_mass, const N& r_mass, Compare compare, CertainOutcome<N>& outcome) const {
    const N all = l_mass + r_mass;
    outcome.event = Event::merge;
    outcome.right_heavier = compare(l_mass, r_mass) == Order::less;
    outcome.left.emplace(r_mass / all);
    outcome.right.emplace(l_mass / all);
  }

  [[gnu::noinline]] void of_speed(const CertainCollision<N>& collision, const N& l_mass, const N& r_mass,
                                  bool identical, CertainOutcome<N>& outcome) const {
    const N &w = collision.closing, &eps = law.restitution, missing = N(1) - eps;
    const auto falls = [&](const N& speed) { return (*fall_)(speed / *law.cutoff); };
    const auto [fall, weighted] = falls(w);
    const N twice = N(1) + eps + missing * fall, in_middle = N(1) + eps + missing * falls(N(w.middle(), 0)).fall,
            slope = N(1) + eps + missing * (fall - *law.cutoff_exponent * weighted);
    const N half = N(1) / N(2), all = l_mass + r_mass, l = identical ? half : r_mass / all,
            r = identical ? half : l_mass / all;
    outcome.left.emplace(l * twice), outcome.right.emplace(r * twice);
    const Share left(l * in_middle, l * slope), right(r * in_middle, r * slope);
    const auto velocities = N::combined(*collision.left_velocity, *collision.right_velocity, w, left, right);
    outcome.left_velocity = velocities.left, outcome.right_velocity = velocities.right;
  }

  // J(w) = mu (w - w') falls with w, at the rate mu (w/w' - 1). So v_l' = v_l - J(w)/m_l is J at the middle of w, and
  // what the radius of w makes of it at the greatest rate: enclosing J itself would forget that v_l is in w.
  template <class Compare>
  [[gnu::noinline]] Open wet(const CertainCollision<N>& collision, const N& l_mass, const N& r_mass, Compare compare,
                             CertainOutcome<N>& outcome) const {
    const N& w = collision.closing;
    const N twice_loss = law.loss + law.loss, mu = l_mass * r_mass / (l_mass + r_mass), critical = twice_loss / mu;
    const N square = w * w;
    const Order order = compare(critical, square);
    if (order == Order::open) return {{critical, square}};
    if (order == Order::greater) return merged(l_mass, r_mass, compare, outcome), std::nullopt;
    const auto impulse_at = [&](const N& speed) { return twice_loss / (speed + sqrt(speed * speed - critical)); };
    const N impulse = impulse_at(N(w.middle(), 0)), rate = mu * (w / sqrt(square - critical) - N(1));
    const auto after = [&](const N& velocity, const N& change, const N& mass) {
      return N::widened(N(velocity.middle(), 0) + change / mass, velocity.radius() + (rate / mass).size() * w.radius());
    };
    outcome.event = Event::pass;
    const N over_speed = impulse_at(w) / w;
    outcome.left.emplace(over_speed / l_mass);
    outcome.right.emplace(over_speed / r_mass);
    outcome.left_velocity = after(*collision.left_velocity, -impulse, l_mass);
    outcome.right_velocity = after(*collision.right_velocity, impulse, r_mass);
    return std::nullopt;
  }
};

}  // namespace cradle
