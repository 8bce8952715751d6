#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "twin/campaign/campaign.h"
#include "twin/campaign/summary.h"

/// The table of a campaign, for the command and for Python.
namespace twinbench::tools {

/// Made anew; with `resume` gone on with, if it is there.
/// @throws InputError if it is there without `resume`, or is of another study.
campaign::Table OpenTable(const std::string& path, const campaign::Study& study, bool resume);

/// {"trials", "lost", "verdicts", "results": {name: {"count", "mean", "sd", "rms_u", "scored", "rms_error", "bias", "coverage95"}}, "worst"}.
nlohmann::json SummaryJson(const campaign::Summary& summary);

}  // namespace twinbench::tools
