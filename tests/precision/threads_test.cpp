// Runs in parallel threads. Proves: two runs at once give the bits of the same two runs in turn, in double-double,
// binary128 and MPFR, whose working precision is one value per process set before the threads start.
#include <gtest/gtest.h>

#include <thread>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace threads_test {

using namespace cradle;
using namespace cradle::test;

template <class P> using Threads = InPrecision<P>;
TYPED_TEST_SUITE(Threads, WidePrecision, PrecisionName);

template <class T> struct Result {
  Configuration<T> configuration;
  T energy_lost{0};
  Counts counts;
};

// The restitution distinguishes the runs.
template <class T> Result<T> result(const char* restitution) {
  auto run = gap_run(rshock<T>(200), Inelastic<T>(from_text<T>(restitution), from_text<T>("1e-3")));
  const T end(75);
  run.advance(end);
  return {configuration_at(run, end), run.energy_lost(), run.counts()};
}

TYPED_TEST(Threads, RunsAtOnceHaveTheBitsOfRunsInTurn) {
  using T = typename TypeParam::Scalar;
  const char* const restitutions[] = {".9", ".92"};
  const Result<T> in_turn[] = {result<T>(restitutions[0]), result<T>(restitutions[1])};
  ASSERT_FALSE(identical(in_turn[0].configuration, in_turn[1].configuration));
  for (int repeat = 0; repeat < 3; ++repeat) {
    Result<T> at_once[2];
    {
      std::jthread first([&] { at_once[0] = result<T>(restitutions[0]); });
      std::jthread second([&] { at_once[1] = result<T>(restitutions[1]); });
    }
    for (const std::size_t k : {0U, 1U}) {
      EXPECT_TRUE(identical(at_once[k].configuration, in_turn[k].configuration)) << k;
      EXPECT_TRUE(at_once[k].energy_lost == in_turn[k].energy_lost) << k;
      EXPECT_TRUE(identical(at_once[k].counts, in_turn[k].counts)) << k;
    }
  }
}

}  // namespace threads_test
