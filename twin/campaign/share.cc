#include "twin/campaign/share.h"

namespace twinbench::campaign {

std::optional<std::int64_t> PendingTrials::Take() {
  // Close may set the count back to the end after others have passed it; both are the end.
  const std::size_t mine = next_.fetch_add(1);
  return mine < trials_.size() ? std::optional(trials_[mine]) : std::nullopt;
}

TrialThreads::TrialThreads(int threads, PendingTrials& pending, Run run) : pending_(pending) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this, run] { Work(run); });
}

TrialThreads::~TrialThreads() {
  pending_.Close();
}

void TrialThreads::Work(const Run& run) {
  try {
    while (const auto trial = pending_.Take()) {
      TrialRow row = run(*trial);
      const std::lock_guard lock(mutex_);
      rows_.push_back(std::move(row));
      ready_.notify_one();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    ready_.notify_one();
  }
}

std::optional<TrialRow> TrialThreads::NextRow(std::chrono::microseconds patience) {
  std::unique_lock lock(mutex_);
  ready_.wait_for(lock, patience, [this] { return failure_ || !rows_.empty(); });
  if (failure_) std::rethrow_exception(failure_);
  if (rows_.empty()) return std::nullopt;
  TrialRow row = std::move(rows_.front());
  rows_.pop_front();
  return row;
}

}  // namespace twinbench::campaign
