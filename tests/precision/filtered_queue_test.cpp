// The filtered queue: 64-bit keys made from rounded times, and exact times only if keys are too close. Proves that it
// is equal to a loop that searches all gaps for the least (exact time, position): the same collisions in the same order
// at each particle, at the same times to the last bit, in collapses and in shocks. In lattices, where many collisions
// are simultaneous, collisions that commute may swap, and rounding decides triple collisions: there every single choice
// is checked against all gaps that might be first. The number of index bits in a key changes no bit of a run.
#include <gtest/gtest.h>

#include <utility>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"
#include "cradle/tests/precision/search.hpp"

namespace filtered_queue_test {

using namespace cradle;
using namespace cradle::test;

template <class P> using FilteredQueue = InPrecision<P>;
TYPED_TEST_SUITE(FilteredQueue, WidePrecision, PrecisionName);

template <class T>
void expect_same_collisions(const Scene<T>& particles, const Inelastic<T>& law, const T& end,
                            std::uint64_t least_collisions, Policy<T> policy = {}) {
  const Recorded<T> run = recorded(gap_run(particles, law, std::move(policy)), end);
  EXPECT_GE(run.counts.collisions, least_collisions);
  expect_same_meetings(run.meetings, searched(GapChain<T>(particles, T(0)), law, run));
}

// Of all gaps the chosen one is first by (exact time, position), whatever the keys.
template <class T>
void expect_every_choice_right(const Scene<T>& particles, const Inelastic<T>& law, const T& end,
                               std::uint64_t least_collisions) {
  auto run = gap_run(particles, law);
  const auto& chain = run.chain();
  std::uint64_t wrong = 0;
  run.advance(end, [&](const Collision<T>& collision) {
    const Slot chosen = static_cast<Slot>(collision.left - chain.particle(0));
    const T time = chain.due(chosen);
    for (Slot s = chain.first(); s <= chain.last(); ++s) {
      if (s == chosen || !(chain.closing(s) > T(0))) continue;
      const T due = chain.due(s);
      wrong += due < time || (due == time && s < chosen);
    }
  });
  EXPECT_EQ(wrong, 0U);
  EXPECT_GE(run.counts().collisions, least_collisions);
  EXPECT_GT(run.counts().close_calls, 0U);
}

TYPED_TEST(FilteredQueue, MixedVelocities) {
  using T = typename TypeParam::Scalar;
  expect_same_collisions(rmix<T>(32), Inelastic<T>(T(15) / T(16), T(0)), T(1000), 188);
}

TYPED_TEST(FilteredQueue, Shock) {
  using T = typename TypeParam::Scalar;
  expect_same_collisions(rshock<T>(200), Inelastic<T>(from_text<T>(".9"), from_text<T>("1e-3")), T(66), 5000);
}

TYPED_TEST(FilteredQueue, ThreeParticleCollapse) {
  using T = typename TypeParam::Scalar;
  for (const char* restitution : {".05", ".01", ".0625"})
    expect_same_collisions(list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}),
                           Inelastic<T>(from_text<T>(restitution), T(0)), T(10), 100,
                           stop_below(from_text<T>("1e-280")));
}

// At eps = 0.4 seven particles are enough: 2/(1 - (4/pi) atan sqrt eps) = 7.1.
TYPED_TEST(FilteredQueue, ManyParticleCollapse) {
  using T = typename TypeParam::Scalar;
  expect_same_collisions(rshock<T>(12), Inelastic<T>(from_text<T>(".4"), T(0)), T(100), 100,
                         stop_below(from_text<T>("1e-200")));
}

// Elastic rows of a perfect lattice: all pairs of a generation meet at one time, exactly representable.
TYPED_TEST(FilteredQueue, ElasticLattice) {
  using T = typename TypeParam::Scalar;
  expect_same_collisions(lattice_rows<T>(40), Inelastic<T>(T(1), T(0)), T(100), 20 * 21 / 2);
}

// Inelastic ones: mirror symmetry makes pairs of equal times, and triple collisions that rounding decides.
TYPED_TEST(FilteredQueue, InelasticLattice) {
  using T = typename TypeParam::Scalar;
  expect_same_collisions(lattice_rows<T>(40), Inelastic<T>(T(15) / T(16), from_text<T>("1e-3")), T(30), 100);
}

TYPED_TEST(FilteredQueue, IntegerPlacesAndVelocities) {
  using T = typename TypeParam::Scalar;
  expect_every_choice_right(integers<T>(), Inelastic<T>(T(1), T(0)), T(200), 200);
  expect_every_choice_right(integers<T>(), Inelastic<T>(T(3) / T(4), from_text<T>("1e-3")), T(10), 100);
  expect_every_choice_right(lattice_rows<T>(40), Inelastic<T>(T(1), T(0)), T(100), 20 * 21 / 2);
  expect_every_choice_right(lattice_rows<T>(40), Inelastic<T>(T(15) / T(16), from_text<T>("1e-3")), T(30), 100);
}

template <class T>
std::uint64_t expect_index_bits_change_no_bit(const Scene<T>& particles, const Inelastic<T>& law, const T& step,
                                              int steps) {
  const auto make = [&](int bits) { return gap_run(particles, law, {}, T(0), {.least_queue_bits = bits}); };
  return test::expect_index_bits_change_no_bit(make, step, steps);
}

TYPED_TEST(FilteredQueue, IndexBitsChangeNoBit) {
  using T = typename TypeParam::Scalar;
  expect_index_bits_change_no_bit(rshock<T>(200), Inelastic<T>(from_text<T>(".9"), from_text<T>("1e-3")), T(14), 5);
  expect_index_bits_change_no_bit(rmix<T>(32), Inelastic<T>(T(15) / T(16), T(0)), T(200), 5);
}

TYPED_TEST(FilteredQueue, IndexBitsChangeNoBitWhereTimesAreEqual) {
  using T = typename TypeParam::Scalar;
  EXPECT_GT(expect_index_bits_change_no_bit(lattice_rows<T>(40), Inelastic<T>(T(15) / T(16), T(0)), T(2), 8), 0U);
  EXPECT_GT(expect_index_bits_change_no_bit(integers<T>(), Inelastic<T>(T(1), T(0)), T(2), 20), 0U);
}

}  // namespace filtered_queue_test
