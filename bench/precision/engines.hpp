#pragma once
// The compared engines: every scalar type in both representations. Numbers of different types are compared as `Wide`,
// 240 digits; converting to it adds no relevant rounding.

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "../common.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/precision/scalars.hpp"

namespace precision {

using cradle::ParticleIndex;

// ---- engines

struct Engine {
  cradle::ScalarChoice scalar;
  bool gaps;

  std::string name() const {
    std::string type = scalar.digits > 0 ? scalar.name + "_" + std::to_string(scalar.digits) : scalar.name;
    std::replace(type.begin(), type.end(), ' ', '_');
    return (gaps ? "gaps/" : "absolute/") + type;
  }
};

inline std::vector<cradle::ScalarChoice> scalars() {
  return {{"double"},       {"long double"}, {"double-double"},
#ifdef CRADLE_WITH_FLOAT128
          {"float128"},
#endif
#ifdef CRADLE_WITH_MPFR
          {"mpfr", 20},     {"mpfr", 34},    {"mpfr", 50},      {"mpfr", 100}, {"mpfr", 200},
#endif
          {"cpp_bin_float"}};
}

// The widest available type with at most so many digits, in gaps: the reference for the others.
inline Engine reference([[maybe_unused]] unsigned digits) {
#ifdef CRADLE_WITH_MPFR
  return {{"mpfr", digits}, true};
#else
  return {{"cpp_bin_float"}, true};
#endif
}

// Calls f(std::type_identity<Chain>) with the engine's chain.
template <class Result, template <class> class Masses = cradle::IdenticalMasses, class F>
Result with_chain(const Engine& engine, F f) {
  return cradle::with_scalar<Result>(engine.scalar, [&]<class T>(std::type_identity<T>) -> Result {
    if (engine.gaps) return f(std::type_identity<cradle::GapChain<T, Masses<T>>>{});
    return f(std::type_identity<cradle::PositionChain<T>>{});
  });
}

template <class Chain>
using Run = cradle::Simulation<typename Chain::Scalar, cradle::Inelastic<typename Chain::Scalar>, Chain>;

// ---- comparing numbers of all types

using Wide =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<800, boost::multiprecision::digit_base_2>,
                                  boost::multiprecision::et_off>;

inline Wide widen(double x) { return Wide(x); }
inline Wide widen(long double x) { return Wide(x); }
inline Wide widen(const cradle::double_double& x) { return Wide(x.high()) + x.low(); }
template <class T> Wide widen(const T& x) { return Wide(cradle::to_text(x)); }

// |value - exact| / |exact|, at most 1, which means that no digit is right.
inline double relative_error(const Wide& value, const Wide& exact) {
  return std::min(static_cast<double>(Wide(abs(Wide(value - exact)) / abs(exact))), 1.0);
}

// Seconds of one call of f: the least of several trials, or of one trial if a call takes long.
template <class F> double best_seconds(F f) {
  double best = bench::seconds_of(f);
  if (best > 1) return best;
  const int calls = std::max(1, static_cast<int>(0.05 / best));
  const auto all = [&] {
    for (int i = 0; i < calls; ++i) f();
  };
  for (int trial = 0; trial < 4; ++trial) best = std::min(best, bench::seconds_of(all) / calls);
  return best;
}

}  // namespace precision
