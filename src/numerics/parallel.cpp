#include "numerics/parallel.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace monograin {

std::size_t thread_count(int wanted) noexcept {
  if (wanted > 0) return static_cast<std::size_t>(wanted);
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) == 0) return static_cast<std::size_t>(std::max(1, CPU_COUNT(&cores)));
  return std::max(1U, std::thread::hardware_concurrency());  // more cores than the set can hold
}

void for_each_index(std::size_t count, std::size_t threads,
                    const std::function<void(std::size_t i, std::size_t thread)>& work) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr first_exception;
  std::mutex mutex;
  const auto take = [&](std::size_t thread) {
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i, thread);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!first_exception) first_exception = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t thread = 1; thread < std::min(threads, count); ++thread) others.emplace_back(take, thread);
    } catch (const std::system_error&) {
      // The system gives no more threads: those that have started do the work.
    }
    take(0);
  }
  if (first_exception) std::rethrow_exception(first_exception);
}

}  // namespace monograin
