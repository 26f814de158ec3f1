#pragma once
// Exact arithmetic: quotients of integers of any size, without expression templates, as the engine's scalar. The oracle
// of small cases: no rounding, so every identity of the dynamics holds with ==.

#include <boost/multiprecision/cpp_int.hpp>

#include "cradle/core/real.hpp"

namespace cradle::test {

using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;

// A double is a quotient of integers.
inline Rational exactly(double x) { return Rational(x); }

}  // namespace cradle::test
