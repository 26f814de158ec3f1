#pragma once
// Boost.Multiprecision's own binary floating point, header only: the portable fallback where neither MPFR nor
// libquadmath is there. A fixed 100 decimal digits.

#include <boost/multiprecision/cpp_bin_float.hpp>

namespace cradle {

using bin_float = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_100::backend_type,
                                                boost::multiprecision::et_off>;

}  // namespace cradle
