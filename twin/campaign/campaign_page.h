#pragma once

#include "twin/campaign/table.h"
#include "twin/report/page/figure.h"

namespace twinbench::campaign {

/// The sections of a campaign's page: whether the stated uncertainties hold, distributions of results, results against the varied keys.
std::vector<report::PageSection> CampaignSections(const Table& table);

}  // namespace twinbench::campaign
