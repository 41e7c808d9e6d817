// Work on several threads: each piece once, exceptions, which thread.

#include "numerics/parallel.hpp"

#include <sched.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace monograin::parallel_test {
namespace {

TEST(Parallel, DoesEachPieceOnceOnHoweverManyThreads) {
  for (const std::size_t threads : {1U, 2U, 7U}) {
    for (const std::size_t count : {0U, 1U, 3U, 1000U}) {
      std::vector<std::atomic<int>> times(count);
      for_each_index(count, threads, [&](std::size_t i, std::size_t thread) {
        EXPECT_LT(thread, threads);
        ++times[i];
      });
      for (const std::atomic<int>& each : times) EXPECT_EQ(each, 1) << count << " on " << threads;
    }
  }
}

TEST(Parallel, HasTheCallerTakePartAsNumberZero) {
  const auto caller = std::this_thread::get_id();
  for_each_index(
      100, 4, [&](std::size_t, std::size_t thread) { EXPECT_EQ(thread == 0, std::this_thread::get_id() == caller); });
}

TEST(Parallel, ThrowsTheFirstExceptionAgainAndBeginsNothingAfterIt) {
  for (const std::size_t threads : {1U, 3U}) {
    std::atomic<std::size_t> begun = 0;
    const auto work = [&](std::size_t i, std::size_t) {
      ++begun;
      if (i == 5) throw std::runtime_error("five");
    };
    EXPECT_THROW(for_each_index(1'000'000, threads, work), std::runtime_error);
    EXPECT_LT(begun, 1'000'000U);
  }
}

TEST(Parallel, UsesEveryCoreUnlessANumberIsGiven) {
  EXPECT_GE(thread_count(0), 1U);
  EXPECT_EQ(thread_count(3), 3U);
}

TEST(Parallel, UsesTheCoresThatItIsConfinedTo) {
  std::jthread([] {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(thread_count(0), 1U);
  }).join();
}

}  // namespace
}  // namespace monograin::parallel_test
