#include "twin/campaign/campaign.h"

#include <algorithm>

#include "twin/campaign/share.h"

namespace twinbench::campaign {
namespace {

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
