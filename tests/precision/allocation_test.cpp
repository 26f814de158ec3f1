// No heap in the event loop. Proves: after a start, a hundred thousand collisions of the paper's shock (N = 8000, eps =
// 0.999, delta = 1e-5, t = 300 to 600) make no allocation, neither in C++ nor in GMP and MPFR, in any scalar type; nor
// do twenty thousand of the wet shock (E_loss = 1e-4). All gaps are held from the start, since a streamed chain may
// allocate when it grows. If clusters merge and rows stream in, the chain is laid out anew from time to time: a few
// blocks of memory for every few dozen collisions.
#include <atomic>
#include <cstdlib>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test {
extern std::atomic<std::uint64_t> allocations;  // how many until now (counted_heap.cpp)
}
namespace cradle::test::allocation_test {

#ifdef CRADLE_WITH_MPFR
void* gmp_allocate(std::size_t size) { return ++allocations, std::malloc(size); }
void* gmp_reallocate(void* memory, std::size_t, std::size_t size) { return ++allocations, std::realloc(memory, size); }
void gmp_free(void* memory, std::size_t) { std::free(memory); }
#endif

template <class P> class Allocations : public InPrecision<P> {
 protected:
#ifdef CRADLE_WITH_MPFR
  void SetUp() override {
    InPrecision<P>::SetUp();
    mpfr_mp_memory_cleanup();
    mp_set_memory_functions(gmp_allocate, gmp_reallocate, gmp_free);
  }
  void TearDown() override {
    mpfr_mp_memory_cleanup();
    mp_set_memory_functions(nullptr, nullptr, nullptr);
  }
#endif
};

#ifdef CRADLE_WITH_MPFR
using LongMpfr = testing::Types<Precision<Mpfr<16>, 100>, Precision<Mpfr<56>, 1000>>;
#else
using LongMpfr = testing::Types<>;
#endif
using Counted = Joined<testing::Types<Precision<double>>, WidePrecision, LongMpfr>::Types;
TYPED_TEST_SUITE(Allocations, Counted, PrecisionName);

// From t = 300 on; before that it warms up.
template <class Run> void expect_none(Run run, int until, std::uint64_t least_collisions) {
  using T = typename Run::Scalar;
  const T warm(300), end(until);
  ASSERT_EQ(run.advance(warm), Status::reached);
  const std::uint64_t collisions = run.counts().collisions, before = allocations;
  ASSERT_GT(before, 0U);  // they are counted
  const Status status = run.advance(end);
  const std::uint64_t after = allocations;
  ASSERT_EQ(status, Status::reached);
  EXPECT_GT(run.counts().collisions, collisions + least_collisions);
  EXPECT_EQ(after - before, 0U);
}

PRECISION_TEST(Allocations, NoneInAHundredThousandCollisions) {
  const Inelastic<T> law(from_text<T>(".999"), from_text<T>("1e-5"));
  expect_none(gap_run(rshock<T>(8000), law, {}, T(0), {.hold_all = true}), 600, 90000);
}

PRECISION_TEST(Allocations, NoneInTwentyThousandWetCollisions) {
  const Wet<T> law(from_text<T>("1e-4"));
  expect_none(Simulation(law, ClusterChain<T>(rshock<T>(8000), T(0), true)), 400, 20000);
}

// The slow wet shock of Fig. 11, whose zone of some tens of particles changes all through. A new layout takes four
// blocks (cells, lags, the list of cells kept, the queue), and there is one for every 12 cells vacated or 24 particles
// taken in at most; to a collision in three there is a merger.
PRECISION_TEST(Allocations, FewWhereParticlesComeInAndMerge) {
  Simulation run(Wet<T>(from_text<T>(".05")), ClusterChain<T>(rshock<T>(200000), T(0)));
  ASSERT_EQ(run.advance(T(1000)), Status::reached);
  const std::uint64_t collisions = run.counts().collisions, before = allocations;
  ASSERT_EQ(run.advance(T(2000)), Status::reached);
  EXPECT_LT(allocations - before, (run.counts().collisions - collisions) / 9);
}

}  // namespace cradle::test::allocation_test
