// Ensembles on either executor: the same bits for any number of threads; replicas that throw, that are cut short and
// continued, that run ensembles of their own; and what is held in memory while they run.
#include "cradle/core/ensemble/ensemble.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "cradle/tests/core/replicas.hpp"

namespace cradle::test::ensemble_test {

template <class E> class Executors : public testing::Test {};
#ifdef __SANITIZE_THREAD__  // Debian's oneTBB is not instrumented
using Both = testing::Types<ThreadExecutor>;
#else
using Both = testing::Types<ThreadExecutor, TbbExecutor>;
#endif
TYPED_TEST_SUITE(Executors, Both);

// Work of very uneven length, so that replicas finish out of order.
void dawdle(ReplicaIndex k) {
  volatile double x = 1;
  for (std::uint64_t i = 0; i < random_bits(3, k, 0) % 20000; ++i) x = x * 0.999 + 1;
}

TYPED_TEST(Executors, SameBitsOnAnyNumberOfThreads) {
  const Moments serial = statistics_of(first_indices(500));
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    Ensemble ensemble;
    run_replicas(TypeParam(threads), {0, 500}, ensemble, [](ReplicaIndex k) {
      dawdle(k);
      return values_of(k);
    });
    EXPECT_EQ(ensemble.statistics(), serial) << threads;
    EXPECT_EQ(ensemble.tree().size(), 500U);
  }
}

// The workers of a run in segments: every job once, no two calls at a time as the same worker, whatever the number of
// jobs; an exception is thrown again.
TYPED_TEST(Executors, WorkersDoEveryJobOnce) {
  for (const unsigned threads : {2U, 3U, 8U})
    for (const std::size_t jobs : {1U, 2U, 3U, 7U, 100U}) {
      const TypeParam executor(threads);
      std::vector<std::atomic<int>> made(jobs), busy(threads);
      std::atomic<int> clashes = 0;
      workers(executor).run(jobs, [&](std::size_t job, std::size_t worker) {
        if (busy.at(worker)++ > 0) ++clashes;
        dawdle(job);
        ++made.at(job);
        --busy[worker];
      });
      EXPECT_EQ(clashes, 0);
      for (const auto& times : made) EXPECT_EQ(times, 1) << threads << " threads, " << jobs << " jobs";
      const auto fail = [](std::size_t job, std::size_t) {
        if (job == 0) throw std::domain_error("");
      };
      EXPECT_THROW(workers(executor).run(jobs, fail), std::domain_error);
    }
}

TYPED_TEST(Executors, ReplicasThatThrowAreRecordedAndHarmNoOther) {
  const auto fails = [](ReplicaIndex k) { return k % 7 == 3; };
  std::vector<ReplicaIndex> good;
  for (ReplicaIndex k = 0; k < 200; ++k)
    if (!fails(k)) good.push_back(k);
  for (const unsigned threads : {1U, 3U}) {
    Ensemble ensemble;
    run_replicas(TypeParam(threads), {0, 200}, ensemble, [&](ReplicaIndex k) {
      if (k == 3) throw 5;  // not even an exception with a message
      if (fails(k)) throw std::runtime_error("particles " + std::to_string(k) + " coincide");
      return values_of(k);
    });
    EXPECT_EQ(ensemble.statistics(), statistics_of(good));
    EXPECT_EQ(ensemble.tree().size(), 200U) << "those that failed are not run again";
    EXPECT_EQ(ensemble.tree().nodes().size(), 3U) << "128 + 64 + 8: nodes grow over failed replicas";
    const auto failures = ensemble.failures();
    EXPECT_EQ(failures.size(), 200 - good.size());
    EXPECT_EQ(failures.at(10), "particles 10 coincide");
    EXPECT_FALSE(failures.at(3).empty());
  }
}

TYPED_TEST(Executors, CancelledAndContinuedIsTheSameAsInOneGo) {
  const Moments in_one_go = statistics_of(first_indices(300));
  Ensemble ensemble;
  std::atomic<int> started = 0;
  for (int stop = 40; ensemble.tree().size() < 300; stop += 40) {
    run_replicas(
        TypeParam(3), {0, 300}, ensemble,
        [&](ReplicaIndex k) {
          ++started;
          dawdle(k);
          if (started >= stop && k % 2 == 1) throw ReplicaAbandoned();  // a run that checked the signal itself
          return values_of(k);
        },
        [&] { return started >= stop; });
    EXPECT_LE(started, stop + 3) << "no more are begun than run at the time";
    started = stop;
  }
  EXPECT_EQ(ensemble.statistics(), in_one_go);
  EXPECT_TRUE(ensemble.failures().empty()) << "what was cut short has not failed";
}

TYPED_TEST(Executors, WhatTheResultStoreThrowsEndsTheEnsemble) {
  ReplicaQueue queue({{0, 100000}});
  std::atomic<int> done = 0;
  EXPECT_THROW(run_jobs(
                   TypeParam(2), [&] { return queue(); }, [](ReplicaIndex k) { return k; },
                   [&](ReplicaIndex, ReplicaIndex) {
                     if (++done >= 10) throw std::runtime_error("disk full");
                   },
                   [](ReplicaIndex, const std::string&) {}),
               std::runtime_error);
  EXPECT_LE(done, 12);
}

TYPED_TEST(Executors, UseAsManyThreadsAsAskedFor) {
  // Every replica waits until the fourth has begun: with fewer than four threads this would never end, so it gives up,
  // after five minutes: longer than any machine keeps a thread waiting.
  std::atomic<int> begun = 0;
  Ensemble ensemble;
  run_replicas(TypeParam(4), {0, 4}, ensemble, [&](ReplicaIndex) {
    ++begun;
    for (int waited = 0; begun < 4 && waited < 300000; ++waited)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (begun < 4) throw std::runtime_error("waited in vain");
    return std::vector<double>{1};
  });
  EXPECT_TRUE(ensemble.failures().empty());
}

TYPED_TEST(Executors, EnsembleWithinAReplicaIsOnItsOwn) {
  Ensemble outer;
  run_replicas(TypeParam(2), {0, 4}, outer, [](ReplicaIndex k) {
    Ensemble inner;
    run_replicas(TypeParam(2), {0, 20}, inner, [k](ReplicaIndex j) {
      if (j % 2 == k % 2) throw std::runtime_error("inner");
      return values_of(j);
    });
    return std::vector<double>{static_cast<double>(inner.failures().size())};
  });
  EXPECT_EQ(outer.statistics().mean, (std::vector<double>{10}));
  EXPECT_TRUE(outer.failures().empty());
}

TYPED_TEST(Executors, MemoryGrowsWithThreadsNotWithReplicas) {
  // With T replicas running, those done are split into at most T + 1 ranges of less than 2 log2 n nodes each. One
  // replica that takes as long as all others together is the worst that one thread can do.
  for (const std::uint64_t n : {256U, 4096U, 65536U}) {
    constexpr unsigned threads = 3;
    Ensemble ensemble;
    std::atomic<std::uint64_t> begun = 0;
    std::atomic<std::size_t> most = 0;
    run_replicas(TypeParam(threads), {0, n}, ensemble, [&](ReplicaIndex k) {
      ++begun;
      if (k == 5)
        while (begun < n) std::this_thread::yield();
      std::size_t seen = most, held = k % 16 == 0 ? ensemble.tree().nodes().size() : 0;
      while (held > seen && !most.compare_exchange_weak(seen, held)) {
      }
      return std::vector<double>{1};
    });
    EXPECT_LE(most, (threads + 1) * 2 * static_cast<std::size_t>(std::bit_width(n))) << n;
    EXPECT_EQ(ensemble.tree().nodes().size(), 1U);
  }
}

}  // namespace cradle::test::ensemble_test
