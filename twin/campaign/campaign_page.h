#pragma once

#include "twin/campaign/table.h"
#include "twin/report/page/figure.h"

namespace twinbench::campaign {

/// The sections of a campaign's page: whether the stated uncertainties hold, distributions of results, results against the varied keys.
std::vector<report::PageSection> CampaignSections(const Table& table);

/// Whether U = k u covers the errors in 95 % of trials: of the result that is furthest from it, in what chance leaves open.
/// @return one without a value where no error is known.
report::PageTile CoverageTile(const Table& table);

}  // namespace twinbench::campaign
