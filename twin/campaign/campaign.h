#pragma once

#include <functional>

#include "twin/campaign/design.h"
#include "twin/campaign/ranks.h"
#include "twin/campaign/table.h"

namespace twinbench::campaign {

struct CampaignProgress {
  std::int64_t done, planned, lost;  // of this call
  const TrialRow* row = nullptr;     // that has come last
};

/// Carries out every trial that is not yet in the table; rows are written in the order in which they come.
/// @param ranks           The other processes that take part; this one is the first of them, and works too.
/// @param stop_requested  Asked ten times a second: once it says so, trials that have begun are finished and kept, and no others begin.
/// @return whether every trial is in the table.
bool RunCampaign(const Study& study, Table& table, int threads, Ranks& ranks, const std::function<void(const CampaignProgress&)>& progress,
                 const std::function<bool()>& stop_requested = {});

}  // namespace twinbench::campaign
