#pragma once

#include "twin/campaign/summary.h"
#include "twin/campaign/table.h"
#include "twin/report/page/figure.h"

namespace twinbench::campaign {

/// The sections of a campaign's page, by its table and what that comes to: whether the stated uncertainties hold, distributions of results, results against the varied keys.
std::vector<report::PageSection> CampaignSections(const Table& table, const Summary& summary);

/// Whether U = k u covers the errors in 95 % of trials: of the result that is furthest from it, in what chance leaves open.
/// @return one without a value where no error is known.
report::PageTile CoverageTile(const Summary& summary);

}  // namespace twinbench::campaign
