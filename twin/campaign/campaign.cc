#include "twin/campaign/campaign.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "twin/campaign/trial.h"

namespace twinbench::campaign {
namespace {

/// The trials that are still to be done. Whoever is free takes the next one.
class PendingTrials {
 public:
  explicit PendingTrials(std::vector<std::int64_t> trials) : trials_(std::move(trials)) {}

  /// Nothing once all were taken, or after Close.
  std::optional<std::int64_t> Take() {
    // Close may set the count back to the end after others have passed it; both are the end.
    const std::size_t mine = next_.fetch_add(1);
    return mine < trials_.size() ? std::optional(trials_[mine]) : std::nullopt;
  }
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

  TrialThreads(int threads, PendingTrials& pending, Run run) : pending_(pending) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this, run] { Work(run); });
  }
  /// Trials that have begun are finished first; no others are taken.
  ~TrialThreads() { pending_.Close(); }

  /// The next row that is ready, or nothing after so long.
  /// @throws What a thread threw.
  std::optional<TrialRow> NextRow(std::chrono::microseconds patience) {
    std::unique_lock lock(mutex_);
    ready_.wait_for(lock, patience, [this] { return failure_ || !rows_.empty(); });
    if (failure_) std::rethrow_exception(failure_);
    if (rows_.empty()) return std::nullopt;
    TrialRow row = std::move(rows_.front());
    rows_.pop_front();
    return row;
  }

 private:
  void Work(const Run& run) {
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

  PendingTrials& pending_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::deque<TrialRow> rows_;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

using namespace std::chrono_literals;

std::vector<std::int64_t> NotDone(const Design& design, const Table& table) {
  const std::vector<std::int64_t> done = table.Done();
  std::vector<std::int64_t> pending;
  for (std::int64_t trial = 0; trial < design.Trials(); ++trial) {
    if (!std::ranges::binary_search(done, trial)) pending.push_back(trial);
  }
  return pending;
}

}  // namespace

bool RunCampaign(const Study& study, Table& table, int threads, Ranks& ranks, const std::function<void(const CampaignProgress&)>& progress,
                 const std::function<bool()>& stop_requested) {
  const Design design(study);
  PendingTrials pending(NotDone(design, table));
  CampaignProgress so_far{0, static_cast<std::int64_t>(pending.Total()), 0};
  const auto write = [&](const TrialRow& row) {
    table.Write(row, design.SeedOf(row.trial), design.ValuesOf(row.trial));
    ++so_far.done;
    so_far.lost += row.failure.empty() ? 0 : 1;
    so_far.row = &row;
    progress(so_far);
  };
  TrialThreads workers(threads, pending, [&](std::int64_t trial) { return RunTrial(study, design, trial); });
  // Others wait for an answer while this thread waits for its own workers: the waits are short.
  const auto patience = ranks.Others() > 0 ? 500us : 100000us;
  std::int64_t to_come = so_far.planned;
  bool is_stopped = false;
  while (so_far.done < to_come || ranks.Busy()) {
    if (!is_stopped && stop_requested && stop_requested()) {
      is_stopped = true;
      to_come = static_cast<std::int64_t>(pending.Close());
    }
    ranks.Serve([&] { return pending.Take(); }, write);
    if (const auto row = workers.NextRow(patience)) write(*row);
  }
  return so_far.done == so_far.planned;
}

}  // namespace twinbench::campaign
