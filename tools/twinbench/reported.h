#pragma once

#include <string>

#include "twin/report/page/figure.h"

namespace twinbench::tools {

/// What a page is made of: the folder of a run or of an investigation, diagnosis.json, what `plan --json` has written, or the table of
/// a campaign.
/// @param source  Its path.
/// @param score   score.json of a run; empty: that of the folder, if it is there.
/// @throws InputError if it is none of these.
report::Page PageOf(const std::string& source, const std::string& score);

/// Where the page goes unless somebody says otherwise: into the folder, or beside the file.
std::string UsualPagePath(const std::string& source);

}  // namespace twinbench::tools
