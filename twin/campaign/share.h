#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "twin/campaign/trial.h"

namespace twinbench::campaign {

/// The trials that are still to be done. Whoever is free takes the next one.
class PendingTrials {
 public:
  explicit PendingTrials(std::vector<std::int64_t> trials) : trials_(std::move(trials)) {}

  /// Nothing once all were taken, or after Close.
  std::optional<std::int64_t> Take();
  /// No others are taken. @return how many have been.
  std::size_t Close() { return std::min(next_.exchange(trials_.size()), trials_.size()); }
  std::size_t Total() const { return trials_.size(); }

 private:
  const std::vector<std::int64_t> trials_;
  std::atomic<std::size_t> next_{0};
};

/// Threads of this process that take trials and hand their rows over to one reader.
class TrialThreads {
 public:
  using Run = std::function<TrialRow(std::int64_t trial)>;

  TrialThreads(int threads, PendingTrials& pending, Run run);
  /// Trials that have begun are finished first; no others are taken.
  ~TrialThreads();

  /// The next row that is ready, or nothing after so long.
  /// @throws What a thread threw.
  std::optional<TrialRow> NextRow(std::chrono::microseconds patience);

 private:
  void Work(const Run& run);

  PendingTrials& pending_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::deque<TrialRow> rows_;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

}  // namespace twinbench::campaign
