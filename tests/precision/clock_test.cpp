// A run that starts late. Proves: from t = 1e12, where a double resolves 1e-4, a run makes the collisions of a run from
// t = 0 with the same gaps and closing speeds to the last bit, and its collision times minus 1e12 agree to 1e-18.
//
// Bound. Times are kept as a sum of two numbers; a move of the origin rounds the lower one, which is at most half a
// unit in the last place of 1e12, 2^-14 in double, to 53 bits: 2^-68 a move, 3.4e-21. The scenes here move it some tens
// of times: below 1e-18 even if all roundings had the same sign, and that much more exact in wider types.
#ifdef CRADLE_WITH_MPFR

#include <gtest/gtest.h>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"
#include "cradle/tests/precision/reference.hpp"

namespace cradle::test::clock_test {

template <class P> using LateStart = InPrecision<P>;
using Precisions = testing::Types<Precision<double>, Precision<double_double>, Precision<Mpfr<4>, 30>>;
TYPED_TEST_SUITE(LateStart, Precisions, PrecisionName);

template <class T> struct Seen {
  ParticleIndex left;
  Reference time;
  T closing_speed;
  std::vector<T> gaps;  // of all, at this collision: to read one at a given time would round that time
};

template <class T>
void expect_same_run(const Scene<T>& particles, const Inelastic<T>& law, int end, Policy<T> policy = {}) {
  const T late(std::int64_t{1000000000000}), shift(end);
  auto early_run = gap_run(particles, law, policy), late_run = gap_run(particles, law, policy, late);
  std::vector<Seen<T>> early_collisions, late_collisions;
  const auto into = [](std::vector<Seen<T>>& all, const auto& run) {
    return [&](const Collision<T>& c) {
      const auto& chain = run.chain();
      const Slot chosen = chain.first() + static_cast<Slot>(c.left - chain.particle(chain.first()));
      all.push_back({c.left, reference(c.time), c.closing_speed, {}});
      for (Slot s = chain.first(); s <= chain.last(); ++s)
        all.back().gaps.push_back(chain.gap_at(s, chain.due(chosen)));
    };
  };
  const Status status = early_run.advance(shift, into(early_collisions, early_run));
  ASSERT_EQ(late_run.advance(late + shift, into(late_collisions, late_run)), status);

  ASSERT_TRUE(identical(early_run.counts(), late_run.counts()));
  ASSERT_LE(early_run.counts().origin_moves, 147U) << "the bound needs fewer than 1e-18 2^68/2 moves a run";
  ASSERT_EQ(early_collisions.size(), late_collisions.size());
  for (std::size_t n = 0; n < early_collisions.size(); ++n) {
    const Seen<T>&a = early_collisions[n], &b = late_collisions[n];
    ASSERT_EQ(a.left, b.left) << n;
    ASSERT_TRUE(a.closing_speed == b.closing_speed && a.gaps == b.gaps) << n;
    ASSERT_LE(abs(b.time - 1e12 - a.time), 1e-18) << n;
  }
  if (status != Status::reached) return;
  const auto a = configuration_at(early_run, shift), b = configuration_at(late_run, T(late + shift));
  EXPECT_TRUE(a.closing_speed == b.closing_speed);
  EXPECT_TRUE(a.v == b.v);
  EXPECT_EQ(a.gap.size(), b.gap.size());
  EXPECT_TRUE(early_run.energy_lost() == late_run.energy_lost());
}

TYPED_TEST(LateStart, MakesTheSameCollisions) {
  using T = typename TypeParam::Scalar;
  expect_same_run(rmix<T>(32), Inelastic<T>(T(15) / T(16), T(0)), 1000);
  expect_same_run(rshock<T>(200), Inelastic<T>(from_text<T>(".9"), from_text<T>("1e-3")), 58);
  // Gaps fall to 1e-30 while time advances at 1e12.
  expect_same_run(list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}), Inelastic<T>(from_text<T>(".05"), T(0)), 2,
                  stop_below(from_text<T>("1e-30")));
}

}  // namespace cradle::test::clock_test

#endif
