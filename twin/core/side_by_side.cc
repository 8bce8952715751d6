#include "twin/core/side_by_side.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace twinbench {

int ProcessorCount() {
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void SideBySide(int count, int threads, const std::function<void(int)>& work) {
  std::atomic<int> next = 0;
  std::mutex of_failure;
  std::exception_ptr failure;
  const auto work_on = [&] {
    try {
      for (int k = next++; k < count; k = next++) work(k);
    } catch (...) {
      next = count;
      const std::lock_guard lock(of_failure);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int k = 1; k < std::min(threads, count); ++k) others.emplace_back(work_on);
    work_on();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace twinbench
