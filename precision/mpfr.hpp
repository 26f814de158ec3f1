#pragma once
// MPFR numbers of a precision chosen at run time, without the heap: the limbs are part of the object, so a chain's
// numbers are side by side in memory. `Limbs` is the number of limbs (64 bits each) that fit. The precision is one
// value per process, set before the first number is made and before any thread starts. All operations round to nearest.

#include <cstdint>  // mpfr.h declares its functions of std::intmax_t only after this header

#include <mpfr.h>

#include <array>
#include <compare>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "cradle/precision/text.hpp"

namespace cradle {

// The working precision of every Mpfr number, in bits.
class MpfrPrecision {
 public:
  // The bits for so many decimal digits, plus one.
  static constexpr mpfr_prec_t bits_for(unsigned digits) { return static_cast<mpfr_prec_t>(digits) * 3322 / 1000 + 2; }
  static mpfr_prec_t bits() { return bits_; }
  // Writes only a new value: several threads may begin runs of one precision at once.
  static void set_bits(mpfr_prec_t bits) {
    if (bits_ != bits) bits_ = bits;
  }
  static int limbs() { return static_cast<int>((bits_ + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS); }

 private:
  static inline mpfr_prec_t bits_ = 53;
};

template <int Limbs> class Mpfr {
 public:
  // Whether so many digits fit: 8 limbs hold 153 digits, 56 hold 1078.
  static constexpr bool holds(unsigned digits) { return MpfrPrecision::bits_for(digits) <= Limbs * GMP_NUMB_BITS; }

  Mpfr() { mpfr_custom_init_set(&v_, MPFR_ZERO_KIND, 0, MpfrPrecision::bits(), limbs_.data()); }
  explicit Mpfr(int i) : Mpfr() { mpfr_set_si(&v_, i, MPFR_RNDN); }
  explicit Mpfr(std::int64_t i) : Mpfr() { mpfr_set_sj(&v_, i, MPFR_RNDN); }
  explicit Mpfr(double x) : Mpfr() { mpfr_set_d(&v_, x, MPFR_RNDN); }
  // Converts a decimal literal that has been checked.
  explicit Mpfr(const char* literal) : Mpfr() { mpfr_strtofr(&v_, literal, nullptr, 10, MPFR_RNDN); }

  Mpfr(const Mpfr& x) noexcept { take(x); }
  Mpfr& operator=(const Mpfr& x) noexcept {
    if (this != &x) take(x);
    return *this;
  }
  ~Mpfr() = default;

  explicit operator double() const { return mpfr_get_d(&v_, MPFR_RNDN); }
  mpfr_srcptr get() const { return &v_; }

  // Saves kind (with the sign), sign and, for numbers other than 0, exponent and limbs.
  void save(auto& to) const {
    const std::array<std::int32_t, 2> kind{mpfr_custom_get_kind(&v_), mpfr_signbit(&v_)};
    to.put(kind.data(), sizeof kind);
    if (!mpfr_regular_p(&v_)) return;
    const std::int64_t exponent = v_._mpfr_exp;
    to.put(&exponent, sizeof exponent);
    to.put(limbs_.data(), static_cast<std::size_t>(MpfrPrecision::limbs()) * sizeof(mp_limb_t));
  }
  void load(auto& from) {
    std::array<std::int32_t, 2> kind{};
    from.get(kind.data(), sizeof kind);
    bool valid = kind[0] >= -MPFR_REGULAR_KIND && kind[0] <= MPFR_REGULAR_KIND;
    std::int64_t exponent = 0;
    if (valid && std::abs(kind[0]) == MPFR_REGULAR_KIND) {
      from.get(&exponent, sizeof exponent);
      from.get(limbs_.data(), static_cast<std::size_t>(MpfrPrecision::limbs()) * sizeof(mp_limb_t));
      const auto leading = static_cast<std::size_t>(MpfrPrecision::limbs() - 1);
      const auto unused = MpfrPrecision::limbs() * GMP_NUMB_BITS - MpfrPrecision::bits();
      valid = limbs_[leading] >> (GMP_NUMB_BITS - 1) == 1 && (limbs_[0] & ((mp_limb_t{1} << unused) - 1)) == 0 &&
              exponent >= mpfr_get_emin() && exponent <= mpfr_get_emax();
    }
    if (!valid) throw std::invalid_argument("no number (limbs that none has): take the file from a copy");
    mpfr_custom_init_set(&v_, kind[0], exponent, MpfrPrecision::bits(), limbs_.data());
  }

  friend Mpfr operator-(const Mpfr& x) {
    Mpfr negative(x);
    negative.v_._mpfr_sign = -negative.v_._mpfr_sign;
    return negative;
  }
  friend Mpfr operator+(const Mpfr& x, const Mpfr& y) { return make(mpfr_add, x, y); }
  friend Mpfr operator-(const Mpfr& x, const Mpfr& y) { return make(mpfr_sub, x, y); }
  friend Mpfr operator*(const Mpfr& x, const Mpfr& y) { return make(mpfr_mul, x, y); }
  friend Mpfr operator/(const Mpfr& x, const Mpfr& y) { return make(mpfr_div, x, y); }
  Mpfr& operator+=(const Mpfr& y) { return mpfr_add(&v_, &v_, &y.v_, MPFR_RNDN), *this; }
  Mpfr& operator-=(const Mpfr& y) { return mpfr_sub(&v_, &v_, &y.v_, MPFR_RNDN), *this; }
  Mpfr& operator*=(const Mpfr& y) { return mpfr_mul(&v_, &v_, &y.v_, MPFR_RNDN), *this; }
  Mpfr& operator/=(const Mpfr& y) { return mpfr_div(&v_, &v_, &y.v_, MPFR_RNDN), *this; }

  friend bool operator==(const Mpfr& x, const Mpfr& y) { return mpfr_equal_p(&x.v_, &y.v_) != 0; }
  friend std::partial_ordering operator<=>(const Mpfr& x, const Mpfr& y) {
    if (mpfr_unordered_p(&x.v_, &y.v_)) return std::partial_ordering::unordered;
    return mpfr_cmp(&x.v_, &y.v_) <=> 0;
  }
  friend bool operator<(const Mpfr& x, const Mpfr& y) { return mpfr_less_p(&x.v_, &y.v_) != 0; }

  friend bool is_negative(const Mpfr& x) { return x.v_._mpfr_sign < 0 && !mpfr_zero_p(&x.v_); }
  friend bool is_positive(const Mpfr& x) { return x.v_._mpfr_sign > 0 && !mpfr_zero_p(&x.v_); }

  friend Mpfr sqrt(const Mpfr& x) {
    Mpfr root;
    mpfr_sqrt(&root.v_, &x.v_, MPFR_RNDN);
    return root;
  }
  friend Mpfr ldexp(const Mpfr& x, long exponent) {
    Mpfr scaled;
    mpfr_mul_2si(&scaled.v_, &x.v_, exponent, MPFR_RNDN);
    return scaled;
  }

  // x = mantissa 2^exponent, mantissa in [1/2, 1] or 0: read from the leading limb, with a relative error of 2^-52.
  friend double split(const Mpfr& x, long& exponent) {
    if (!mpfr_regular_p(&x.v_)) {
      exponent = 0;
      return mpfr_zero_p(&x.v_) ? 0.0 : mpfr_get_d(&x.v_, MPFR_RNDN);
    }
    exponent = x.v_._mpfr_exp;
    const auto leading = x.limbs_[static_cast<std::size_t>((x.v_._mpfr_prec - 1) / GMP_NUMB_BITS)];
    const double mantissa = static_cast<double>(leading >> 1) * 0x1p-63;  // the signed conversion is one instruction
    return x.v_._mpfr_sign < 0 ? -mantissa : mantissa;
  }

 private:
  template <class Operation> static Mpfr make(Operation operation, const Mpfr& x, const Mpfr& y) {
    Mpfr result;
    operation(&result.v_, &x.v_, &y.v_, MPFR_RNDN);
    return result;
  }

  void take(const Mpfr& x) noexcept {
    v_ = x.v_;
    v_._mpfr_d = limbs_.data();
    if constexpr (Limbs <= 4)
      limbs_ = x.limbs_;
    else
      std::memcpy(limbs_.data(), x.limbs_.data(), static_cast<std::size_t>(MpfrPrecision::limbs()) * sizeof(mp_limb_t));
  }

  __mpfr_struct v_;
  std::array<mp_limb_t, static_cast<std::size_t>(Limbs)> limbs_;
};

}  // namespace cradle

template <int Limbs> class std::numeric_limits<cradle::Mpfr<Limbs>> {
  using T = cradle::Mpfr<Limbs>;

 public:
  static constexpr bool is_specialized = true, is_signed = true, is_integer = false, is_exact = false;
  static constexpr std::float_round_style round_style = std::round_to_nearest;
  static constexpr bool has_infinity = true, has_quiet_NaN = true, is_iec559 = false, is_bounded = true;
  static constexpr int radix = 2;
  // The number of digits is chosen at run time: see MpfrPrecision.
  // The range ends above MPFR's least exponent by more than the precision: differences of larger numbers are exact or
  // rounded, never zero.
  static constexpr long min_exponent = -(1L << 30) + (1L << 20) + 3, max_exponent = (1L << 30) - 1;
  static T epsilon() { return ldexp(T(1), 1 - cradle::MpfrPrecision::bits()); }
  static T min() { return ldexp(T(1), min_exponent - 1); }
  static T max() { return ldexp(T(1) - ldexp(T(1), -cradle::MpfrPrecision::bits()), max_exponent); }
  static T lowest() { return -max(); }
  static T infinity() { return T(std::numeric_limits<double>::infinity()); }
  static T quiet_NaN() { return T(std::numeric_limits<double>::quiet_NaN()); }
};

template <int Limbs> inline constexpr std::string_view cradle::scalar_name<cradle::Mpfr<Limbs>> = "mpfr";

template <int Limbs> struct cradle::Text<cradle::Mpfr<Limbs>> {
  static Mpfr<Limbs> from(std::string_view literal) { return Mpfr<Limbs>(checked_literal(literal).c_str()); }
  // With as many digits as are needed to read the same number back in the same precision.
  static std::string to(const Mpfr<Limbs>& x) {
    if (mpfr_zero_p(x.get())) return mpfr_signbit(x.get()) ? "-0" : "0";
    mpfr_exp_t exponent = 0;
    char* raw = mpfr_get_str(nullptr, &exponent, 10, 0, x.get(), MPFR_RNDN);
    std::string text = raw;
    mpfr_free_str(raw);
    const std::string sign = text.front() == '-' ? "-" : "";
    std::string figures = text.substr(sign.size());
    figures.erase(figures.find_last_not_of('0') + 1);
    const auto size = static_cast<mpfr_exp_t>(figures.size());
    // 0.figures 10^exponent
    if (exponent > 0 && exponent <= 21 && exponent >= size)
      return sign + figures + std::string(static_cast<std::size_t>(exponent - size), '0');
    if (exponent > 0 && exponent <= 21) return sign + figures.insert(static_cast<std::size_t>(exponent), ".");
    if (exponent <= 0 && exponent > -5)
      return sign + "0." + std::string(static_cast<std::size_t>(-exponent), '0') + figures;
    if (size > 1) figures.insert(1, ".");
    return sign + figures + "e" + std::to_string(exponent - 1);
  }
};

template <int Limbs> struct cradle::SavedNumber<cradle::Mpfr<Limbs>> {
  static void save(auto& to, const Mpfr<Limbs>& x) { x.save(to); }
  static void load(auto& from, Mpfr<Limbs>& x) { x.load(from); }
};
