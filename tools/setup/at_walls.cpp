// The distances of particles to walls, in rationals.
#include "cradle/tools/setup/initial_state.hpp"

#include "cradle/precision/bin_float.hpp"
#include "cradle/tools/scene/rational.hpp"

namespace cradle::tools {
namespace {

// The place of an end of rows or a cold gas in spacings: a whole number times 2^-29 or, where the density falls, a
// double, and so exact in 100 digits.
Rational in_spacings(Initial initial, End end, const Displacement& displacement) {
  initial.spacing = initial.left.density = initial.right.density = Decimal("1");
  initial.masses = initial.random_masses = {};
  const auto particles = detail::particles_without_walls<bin_float>(initial, {}, displacement);
  const bin_float place = particles->position(end == End::left ? 0 : particles->count() - 1);
  using std::ldexp;
  return Rational(ldexp(place, 200).convert_to<Whole>()) / Rational(Whole(1) << 200);
}

}  // namespace

std::optional<AtWallText> at_wall(const Scene& scene, End end, const Displacement& displacement) {
  const Initial& initial = scene.initial;
  const bool left = end == End::left;
  const WallAt& wall = left ? scene.walls.left : scene.walls.right;
  if (!wall.position) return {};
  const auto closing = [&](std::string_view v) {
    return left ? difference(wall.speed.text, v) : difference(v, wall.speed.text);
  };
  if (initial.type == InitialType::list) {
    const std::string_view x = left ? initial.x[0] : initial.x.back(), v = left ? initial.v[0] : initial.v.back();
    return AtWallText{left ? difference(x, wall.position->text) : difference(wall.position->text, x), closing(v)};
  }
  if (initial.type != InitialType::rows && initial.type != InitialType::cold) return {};
  const scene::Row& row = left ? initial.left : initial.right;
  const auto at = rational(wall.position->text),
             spacing = rational(initial.general_rows() ? row.density.text : initial.spacing.text);
  if (!at || !spacing) return {};
  const Rational place = in_spacings(initial, end, displacement),
                 x = initial.general_rows() ? Rational(place / *spacing) : Rational(place * *spacing);
  AtWallText text{decimal_text(left ? Rational(x - *at) : Rational(*at - x), scene.run.decimal_digits() + 40), {}};
  if (initial.type == InitialType::rows)
    text.closing_speed = closing(initial.general_rows() ? row.speed.text
                                 : left                 ? initial.speed.text
                                                        : difference("0", initial.speed.text));
  return text;
}

}  // namespace cradle::tools
