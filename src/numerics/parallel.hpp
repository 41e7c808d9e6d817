/// Independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace monograin {

/// Number of threads to use.
/// @param wanted  0: one for each core that this process may use
/// @return at least 1
[[nodiscard]] std::size_t thread_count(int wanted) noexcept;

/// Calls work(i, thread) for every i below count; threads take the next i as they become free. The calling thread takes
/// part, as number 0.
///
/// The first exception is thrown again once all threads have ended; after it no further i is begun.
/// @param threads  largest number of threads; there are fewer if the system gives no more
void for_each_index(std::size_t count, std::size_t threads,
                    const std::function<void(std::size_t i, std::size_t thread)>& work);

}  // namespace monograin
