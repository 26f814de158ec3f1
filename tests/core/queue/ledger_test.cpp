// The ledger of energy. Proves: in native types the sum has the same bits for any order and any division of its terms,
// and differs from the exact sum by at most half a unit of the finer grid per term; for any size of the energy, zero
// and the ends of the type's range included.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "cradle/core/queue/ledger.hpp"

namespace cradle::test::ledger_test {

template <class T> class Ledgers : public testing::Test {};
using Types = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(Ledgers, Types);

// Losses from nothing to the whole of the energy, over the whole range of exponents that a run has.
template <class T> std::vector<T> losses(const T& energy, std::mt19937_64& random) {
  std::vector<T> all;
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 4000; ++i)
    all.push_back(energy * static_cast<T>(uniform(random) * std::exp2(-60 * uniform(random))) / T(4000));
  return all;
}
template <class T> T sum(const T& energy, const std::vector<T>& terms) {
  Ledger<T> ledger(energy);
  for (const T& term : terms) ledger.add(term);
  return ledger.value();
}

TYPED_TEST(Ledgers, AreTheSameInAnyOrderAndAnyParts) {
  using T = TypeParam;
  std::mt19937_64 random(7);
  for (const T energy : {T(1), T(1000), T(3) / T(1 << 20), std::numeric_limits<T>::max() / T(64)}) {
    std::vector<T> terms = losses(energy, random);
    const T first = sum(energy, terms);
    for (int i = 0; i < 20; ++i) {
      std::shuffle(terms.begin(), terms.end(), random);
      EXPECT_EQ(sum(energy, terms), first);
      std::vector<Ledger<T>> parts(7, Ledger<T>(energy));
      for (std::size_t k = 0; k < terms.size(); ++k) parts[k * k % 7].add(terms[k]);
      Ledger<T> all(energy);
      for (const Ledger<T>& part : parts) all.add(part);
      EXPECT_EQ(all.value(), first);
    }
  }
}

TYPED_TEST(Ledgers, LoseHalfAUnitOfTheFinerGridPerTermAtMost) {
  using T = TypeParam;
  std::mt19937_64 random(11);
  for (const T energy : {T(1), T(1000)}) {
    const T unit = T(2) * energy * std::numeric_limits<T>::epsilon() / T(1 << 22);  // at most
    std::vector<T> terms = losses(energy, random);
    std::sort(terms.begin(), terms.end());
    long double exact = 0, error = 0;  // a compensated sum, smallest first
    for (const T& term : terms) {
      const long double before = exact, next = static_cast<long double>(term) - error;
      exact = before + next;
      error = (exact - before) - next;
    }
    const long double off = static_cast<long double>(sum(energy, terms)) - exact;
    const long double rounding = exact * static_cast<long double>(std::numeric_limits<T>::epsilon());
    EXPECT_LE(std::abs(off), rounding + static_cast<long double>(unit / T(2)) * 4000);
  }
}

// Terms far below what the sum resolves are not lost one by one.
TYPED_TEST(Ledgers, TakeInWhatASumWouldNotSee) {
  using T = TypeParam;
  const T eps = std::numeric_limits<T>::epsilon();
  Ledger<T> ledger(T(1));
  ledger.add(T(1) / T(2));
  for (int i = 0; i < 4096; ++i) ledger.add(eps / T(1 << 12));
  EXPECT_EQ(ledger.value(), T(1) / T(2) + eps);
}

TYPED_TEST(Ledgers, OfNoEnergyOrTooMuchAreSums) {
  using T = TypeParam;
  EXPECT_EQ(Ledger<T>(T(0)).value(), T(0));
  Ledger<T> huge(std::numeric_limits<T>::infinity());
  huge.add(T(3));
  huge.add(T(4));
  EXPECT_EQ(huge.value(), T(7));
}

}  // namespace cradle::test::ledger_test
