// Two decimals between which an outcome changes, and the next one to try: first whole multiples of a coarse power of
// ten, then of finer ones, each by bisection. So values are as short as can be, and a search to more digits begins with
// the values of a search to fewer. All arithmetic is on the decimals, exactly.
#pragma once

#include <optional>

#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {

class Bracket {
 public:
  /// low < high, of which `digits` significant ones are wanted, counted from the first of the larger end; `whole`: only
  /// whole numbers. Throws Error for numbers of thousands of digits.
  Bracket(Decimal low, Decimal high, unsigned digits, bool whole);

  const Decimal& low() const { return low_; }
  const Decimal& high() const { return high_; }

  /// The value to try; none if the ends are neighbours.
  const std::optional<Decimal>& next() const { return next_; }
  /// The outcome at next() is that of the low end, or is not.
  void narrow(bool as_at_low);

  /// About how many values are left.
  unsigned values_left() const;

 private:
  void find_next();

  Decimal low_, high_;
  long unit_ = 0, last_ = 0;  // powers of ten: of the values tried now, and of the finest ones
  std::optional<Decimal> next_;
};

}  // namespace cradle::tools
