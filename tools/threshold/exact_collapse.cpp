// Symbols as in core/engine/collapse_ahead.hpp, with one restitution e = r_1 = r_2: S = c_1 c_2 - 2 e, L the larger
// root of L^2 - S L + e^2 = 0, u the speed at which the gap just closed opens, w the closing speed of the other one.
#include "cradle/tools/threshold/threshold.hpp"

#include <array>

#include "cradle/tools/scene/rational.hpp"

namespace cradle::tools {

namespace {

constexpr std::uint64_t most_collisions = 64;

struct ThreeParticles {
  std::array<Rational, 2> gap, closing, coupling;  // c: what a collision at this gap adds to the other one's speed
  Rational restitution, time_left;
};

std::optional<ThreeParticles> three_particles(const Scene& scene) {
  const Initial& initial = scene.initial;
  const bool plain = scene.law.type == LawType::inelastic && stops_at_collapse(scene) &&
                     scene.law.cutoff == Decimal("0") && !scene.law.cutoff_exponent && !scene.gravity.acts() &&
                     !scene.walls.any() && initial.type == InitialType::list && !initial.on_ring();
  if (!plain || initial.x.size() != 3) return {};
  std::array<Rational, 3> x, v, m;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto place = rational(initial.x[i]), speed = rational(initial.v[i]),
               mass = rational(initial.m.empty() ? "1" : initial.m[i]);
    if (!place || !speed || !mass) return {};
    x.at(i) = *place, v.at(i) = *speed, m.at(i) = *mass;
  }
  const auto e = rational(scene.law.restitution.text), start = rational(scene.run.start.text),
             until = rational(scene.run.until.text);
  if (!e || !start || !until || *e == 0) return {};
  const Rational pushed = 1 + *e;
  return ThreeParticles{{x[1] - x[0], x[2] - x[1]},
                        {v[0] - v[1], v[1] - v[2]},
                        {pushed * m[0] / (m[0] + m[1]), pushed * m[2] / (m[1] + m[2])},
                        *e,
                        *until - *start};
}

// The sign of w - k u, with k = c/(L + e) and L = (S + sqrt(D))/2, for w > 0: that of P + Q sqrt(D) with
// P = w (S/2 + e) - c u and Q = w/2.
int sign_of_margin(const Rational& w, const Rational& u, const Rational& c, const Rational& e, const Rational& s) {
  const Rational d = s * s - 4 * e * e, p = w * (s / 2 + e) - c * u, q = w / 2;
  if (p > 0) return 1;
  const Rational difference = q * q * d - p * p;
  return difference > 0 ? 1 : difference < 0 ? -1 : 0;
}

}  // namespace

std::optional<ExactCollapse> exact_collapse(const Scene& scene) {
  auto three = three_particles(scene);
  if (!three) return {};
  const Rational &e = three->restitution, s = three->coupling[0] * three->coupling[1] - 2 * e;
  const bool can_collapse = s >= 2 * e;
  if (!can_collapse) return ExactCollapse{false, 0};
  for (std::uint64_t collisions = 0; collisions < most_collisions; ++collisions) {
    std::array<std::optional<Rational>, 2> times;
    for (std::size_t k = 0; k < 2; ++k)
      if (three->closing.at(k) > 0) times.at(k) = three->gap.at(k) / three->closing.at(k);
    if (!times[0] && !times[1]) return ExactCollapse{false, collisions};
    if (times[0] == times[1]) return {};
    const std::size_t here = times[0] && (!times[1] || *times[0] < *times[1]) ? 0 : 1, there = 1 - here;
    const Rational flight = *times.at(here);
    if (flight > three->time_left) return ExactCollapse{false, collisions};
    three->time_left -= flight;
    three->gap.at(here) = 0;
    three->gap.at(there) -= three->closing.at(there) * flight;
    three->closing.at(there) += three->coupling.at(here) * three->closing.at(here);
    three->closing.at(here) *= -e;

    const Rational &w = three->closing.at(there), u = -three->closing.at(here), &c = three->coupling.at(here);
    if (w <= 0 || sign_of_margin(w, u, c, e, s) <= 0) continue;
    // t_c - t = g/(w - k u) is at most the time left if w - g/(time left) - k u is not negative.
    if (three->time_left == 0) return {};
    const Rational slower = w - three->gap.at(there) / three->time_left;
    const int in_time = slower > 0 ? sign_of_margin(slower, u, c, e, s) : -1;
    if (in_time == 0) return {};
    return ExactCollapse{in_time > 0, collisions + 1};
  }
  return {};
}

}  // namespace cradle::tools
