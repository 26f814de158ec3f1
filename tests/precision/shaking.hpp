#pragma once
// How a wall is shaken about its place, towards the particles, by the formulas of core/laws/wall_motion.hpp: in numbers
// of any type, at phases in turns.

#include <boost/math/constants/constants.hpp>

#include "cradle/core/laws/wall_motion.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test {

// Of double and long double; those of wider numbers are found by their types. No scene in rationals has them.
using std::abs, std::asin, std::cos, std::exp, std::floor, std::pow, std::sin, std::sqrt;
template <class... Numbers> Rational irrational(const Numbers&...) { throw std::logic_error("100 digits have this"); }
inline Rational sqrt(const Rational& x) { return irrational(x); }
inline Rational exp(const Rational& x) { return irrational(x); }
inline Rational pow(const Rational& x, const Rational& y) { return irrational(x, y); }
inline Rational sin(const Rational& x) { return irrational(x); }
inline Rational cos(const Rational& x) { return irrational(x); }
inline Rational asin(const Rational& x) { return irrational(x); }
inline Rational floor(const Rational& x) { return irrational(x); }
template <class N> N pi() { return boost::math::constants::pi<N>(); }
template <> inline Rational pi() { return irrational(); }

template <class N> struct Shaking {
  Shape shape;
  N amplitude, frequency, phase;

  N period() const { return 2 * pi<N>() / frequency; }
  N turns(const N& time) const {
    const N y = (frequency * time + phase) / (2 * pi<N>());
    return y - floor(N(y + N(1) / 2));
  }
  N place(const N& y) const {
    if (shape == Shape::sine) return amplitude * sin(N(2 * pi<N>() * y));
    return shape == Shape::sawtooth ? N(2 * amplitude * y) : N(16 * amplitude * y * (N(1) / 2 - abs(y)));
  }
  N speed(const N& y) const {
    if (shape == Shape::sine) return amplitude * frequency * cos(N(2 * pi<N>() * y));
    const N slope = amplitude * frequency / pi<N>();
    return shape == Shape::sawtooth ? slope : N(4 * slope * (1 - 4 * abs(y)));
  }
  N acceleration(const N& y) const {
    if (shape == Shape::sine) return -frequency * frequency * place(y);
    if (shape == Shape::sawtooth) return N(0);
    const N size = 8 * amplitude * frequency * frequency / (pi<N>() * pi<N>());
    return y < 0 ? size : N(-size);
  }
  // The phase at which the wall falls as fast as what is pulled there so strongly, or jumps back; nothing: never.
  std::optional<N> release(const N& pull) const {
    const N strongest = -acceleration(N(1) / 4);
    if (shape == Shape::sawtooth) return N(1) / 2;
    if (!(pull < strongest)) return {};
    return shape == Shape::sine ? N(asin(N(pull / strongest)) / (2 * pi<N>())) : N(0);
  }
};

}  // namespace cradle::test
