#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace roadbook {

/// Runs body(i) for i in [0, count) on `num_threads` threads (0: all cores). Items start in
/// ascending order. Each must write to its own memory, so that the result does not depend on the
/// number of threads. When all threads have stopped, the exception of the lowest item is rethrown.
void parallel_for(std::size_t count, int num_threads, const std::function<void(std::size_t)>& body);

/// The same for small items: a thread takes some hundred neighbours at a time.
template <typename Body>
void parallel_for_small(std::size_t count, int num_threads, const Body& body) {
  constexpr std::size_t kBlock = 256;
  parallel_for((count + kBlock - 1) / kBlock, num_threads, [&](std::size_t block) {
    const std::size_t end = std::min(count, (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) body(i);
  });
}

/// Returns `requested`, or the number of cores if `requested` is 0.
[[nodiscard]] int thread_count(int requested);

}  // namespace roadbook
