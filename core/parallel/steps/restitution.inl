// A restitution that depends on the closing speed (SpeedDependent, law.hpp), on vectors: a part of doubles.inl. The
// operations are those of core/base/elementary.hpp, one for one, where exponents are within those of normal numbers.

namespace cradle {
namespace HWY_NAMESPACE {

class OfSpeed {
 public:
  explicit HWY_INLINE OfSpeed(const StepTask& task) : law_(task.of_speed), delta_(task.cutoff), lost_(task.lost) {}

  // What comes of collisions at so many closing speeds `w`: closing speeds after them, half of their changes, and the
  // energy lost over reduced mass and w^2 (over w^2 if masses are equal). False where some are for scalars.
  HWY_INLINE bool operator()(double* w, std::size_t count, double* after, double* half, double* lost) const {
    const Lanes d;
    auto inside = hn::FirstN(d, lanes);
    hn::StoreU(hn::Set(d, w[count - 1]), d, w + count);
    for (std::size_t k = 0; k < count; k += lanes) {
      const V speed = hn::LoadU(d, w + k), one = hn::Set(d, 1);
      const V missing = hn::Mul(hn::Set(d, law_.missing), rise(power(hn::Div(speed, hn::Set(d, delta_)), inside)));
      const V restitution = hn::Sub(one, missing), half_sum = hn::Sub(one, hn::Mul(missing, hn::Set(d, 0.5)));
      const V soft = hn::Neg(hn::Mul(restitution, speed)), hard_half = hn::Mul(half_sum, speed);
      const auto is_soft = hn::Lt(hn::Add(restitution, restitution), one);
      const V soft_half = hn::Mul(hn::Sub(speed, soft), hn::Set(d, 0.5));
      hn::StoreU(hn::IfThenElse(is_soft, soft, hn::Sub(speed, hn::Add(hard_half, hard_half))), d, after + k);
      hn::StoreU(hn::IfThenElse(is_soft, soft_half, hard_half), d, half + k);
      hn::StoreU(hn::Mul(hn::Mul(missing, half_sum), hn::Set(d, lost_)), d, lost + k);
    }
    return hn::AllTrue(d, inside);
  }

 private:
  using V = hn::Vec<Lanes>;
  using M = hn::Mask<Lanes>;

  // 1 - exp(-y).
  HWY_INLINE V rise(V y) const {
    const Lanes d;
    const V one = hn::Set(d, 1), eighth = hn::Set(d, 0.125), half = hn::Set(d, 0.5);
    const M finite = hn::Lt(y, hn::Set(d, law_.all));
    V h = hn::IfThenElseZero(finite, y), halvings = hn::Zero(d);
    int most = 0;
    for (M large = hn::Gt(h, eighth); !hn::AllFalse(d, large); large = hn::Gt(h, eighth), ++most) {
      h = hn::IfThenElse(large, hn::Mul(h, half), h);
      halvings = hn::Add(halvings, hn::IfThenElseZero(large, one));
    }
    V bracket = one;
    for (std::size_t n = law_.count; n-- > 1;)
      bracket = hn::Sub(one, hn::Mul(hn::Mul(h, hn::Set(d, law_.reciprocals[n])), bracket));
    V rise = hn::Mul(h, bracket);
    for (; most > 0; --most) {
      const M doubles = hn::Ge(halvings, hn::Set(d, most));
      rise = hn::IfThenElse(doubles, hn::Mul(rise, hn::Sub(hn::Set(d, 2), rise)), rise);
    }
    return hn::IfThenElse(finite, rise, one);
  }

  // x^s; clears `inside` where x, or what comes of it, is near the ends of the range.
  HWY_INLINE V power(V x, M& inside) const {
    const Lanes d;
    V power = hn::Set(d, 1);
    if (law_.whole > 0) {
      V base = x;
      for (int n = law_.whole; n > 0; n /= 2) {
        if (n % 2 != 0) power = hn::Mul(power, base);
        if (n > 1) base = hn::Mul(base, base);
      }
    } else {
      const M normal = hn::And(hn::Gt(x, hn::Set(d, 0x1p-1000)), hn::Lt(x, hn::Set(d, 0x1p1000)));
      inside = hn::And(inside, normal);
      power = exponential(hn::Mul(hn::Set(d, law_.exponent), logarithm(hn::IfThenElse(normal, x, power))));
    }
    inside = hn::And(inside, hn::And(hn::Gt(power, hn::Set(d, 0x1p-1000)), hn::Lt(power, hn::Set(d, 0x1p1000))));
    return power;
  }
  HWY_INLINE V logarithm(V x) const {
    const Lanes d;
    const hn::RebindToSigned<Lanes> i;
    const V one = hn::Set(d, 1), two = hn::Set(d, 2);
    const auto bits = hn::BitCast(i, x);
    V exponent = hn::ConvertTo(d, hn::Sub(hn::ShiftRight<52>(bits), hn::Set(i, 1022)));
    V mantissa = hn::BitCast(d, hn::Or(hn::And(bits, hn::Set(i, 0xFFFFFFFFFFFFF)), hn::Set(i, 1022LL << 52)));
    const M small = hn::Lt(hn::Mul(hn::Mul(mantissa, mantissa), two), one);
    mantissa = hn::IfThenElse(small, hn::Add(mantissa, mantissa), mantissa);
    exponent = hn::IfThenElse(small, hn::Sub(exponent, one), exponent);
    const V s = hn::Div(hn::Sub(mantissa, one), hn::Add(mantissa, one)), square = hn::Mul(s, s);
    V sum = hn::Zero(d);
    for (std::size_t n = law_.odds; n-- > 0;) sum = hn::Add(hn::Mul(sum, square), hn::Set(d, law_.odd[n]));
    return hn::Add(hn::Mul(exponent, hn::Set(d, law_.ln2)), hn::Mul(two, hn::Mul(s, sum)));
  }
  HWY_INLINE V exponential(V u) const {
    const Lanes d;
    const hn::RebindToSigned<Lanes> i;
    const V one = hn::Set(d, 1), ln2 = hn::Set(d, law_.ln2), most = hn::Set(d, 1020);
    const V turns = hn::Min(hn::Max(hn::Div(u, ln2), hn::Neg(most)), most);
    const V exponent = hn::Floor(hn::Add(turns, hn::Set(d, 0.5)));
    const V rest = hn::Sub(u, hn::Mul(exponent, ln2)), left = hn::Sub(one, rise(hn::Abs(rest)));
    const V near = hn::IfThenElse(hn::Lt(rest, hn::Zero(d)), left, hn::Div(one, left));
    const auto bits = hn::ShiftLeft<52>(hn::Add(hn::ConvertTo(i, exponent), hn::Set(i, 1023)));
    return hn::Mul(near, hn::BitCast(d, bits));
  }

  const StepRestitution& law_;
  double delta_, lost_;
};

}  // namespace HWY_NAMESPACE
}  // namespace cradle
