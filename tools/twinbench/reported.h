#pragma once

#include <string>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::tools {

/// What a page is made of: the folder of a run or of an investigation, diagnosis.json, what `plan --json` has written, or the table of
/// a campaign.
/// @param source  Its path.
/// @param score   score.json of a run; empty: that of the folder, if it is there.
/// @param output  Where the page will be: an investigation's leads from there to the pages of its runs, if they are there.
/// @throws InputError if it is none of these.
report::Page PageOf(const std::string& source, const std::string& score, const std::string& output);

/// The folders of the runs of an investigation, in their order; none of anything else.
std::vector<std::string> RunsOfInvestigation(const std::string& source);

/// Where the page goes unless somebody says otherwise: into the folder, or beside the file.
std::string UsualPagePath(const std::string& source);

}  // namespace twinbench::tools
