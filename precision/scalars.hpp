#pragma once
// The list of scalar types, and the conversion of a name to a type. A new type needs its #include and a line in the
// list: the build reads the lines, each a type and its header, and compiles the engine once per type.

#include <cstddef>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>

#include "cradle/precision/bin_float.hpp"
#include "cradle/precision/double_double.hpp"
#include "cradle/precision/text.hpp"
#ifdef CRADLE_WITH_FLOAT128
#include "cradle/precision/float128.hpp"
#endif
#ifdef CRADLE_WITH_MPFR
#include "cradle/precision/mpfr.hpp"
#endif

namespace cradle {

using Scalars = std::tuple<double,         // text.hpp
                           long double,    // text.hpp
                           double_double,  // double_double.hpp
                           bin_float       // bin_float.hpp
#ifdef CRADLE_WITH_FLOAT128
                           ,
                           float128  // float128.hpp
#endif
#ifdef CRADLE_WITH_MPFR
                           // smallest first: the first type with enough digits is used
                           ,
                           Mpfr<4>,   // mpfr.hpp
                           Mpfr<16>,  // mpfr.hpp
                           Mpfr<56>   // mpfr.hpp
#endif
                           >;

// A precision as scenes name it; digits are used only with "mpfr".
struct ScalarChoice {
  std::string name;
  unsigned digits = 0;
};

template <class T> bool is_chosen(const ScalarChoice& choice) {
  if (choice.name != scalar_name<T>) return false;
  if constexpr (requires { T::holds(choice.digits); }) return T::holds(choice.digits);
  return true;
}

namespace detail {

template <class Result, std::size_t K, class F> Result choose_scalar(const ScalarChoice& choice, F& f) {
  if constexpr (K == std::tuple_size_v<Scalars>) {
    if (choice.name == "float128")
      throw std::invalid_argument(
          "float128 is not in this build (it needs g++ with libquadmath): choose mpfr with 34 digits");
    if (choice.name == "mpfr" && choice.digits <= 1000)
      throw std::invalid_argument("mpfr is not in this build: install libmpfr-dev (Debian's name) and build again");
    throw std::invalid_argument("no scalar type " + choice.name + " of " + std::to_string(choice.digits) +
                                " digits: choose one of those that --version lists, mpfr with at most 1000 digits");
  } else {
    using T = std::tuple_element_t<K, Scalars>;
    if (is_chosen<T>(choice)) return f(std::type_identity<T>{});
    return choose_scalar<Result, K + 1>(choice, f);
  }
}

}  // namespace detail

// Calls f(std::type_identity<T>) with the type T of this name, after setting MPFR's precision; Result is the type that
// f returns. Throws std::invalid_argument for an unknown type, with advice.
template <class Result, class F> Result with_scalar(const ScalarChoice& choice, F f) {
#ifdef CRADLE_WITH_MPFR
  if (choice.name == "mpfr") MpfrPrecision::set_bits(MpfrPrecision::bits_for(choice.digits));
#endif
  return detail::choose_scalar<Result, 0>(choice, f);
}

}  // namespace cradle
