#pragma once

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace twinbench::test {

/// Does work(0) to work(count - 1), so many at a time.
inline void InParallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> workers;
  for (int t = 0; t < threads; ++t) {
    workers.emplace_back([&] {
      for (std::size_t k = next++; k < count; k = next++) work(k);
    });
  }
}

}  // namespace twinbench::test
