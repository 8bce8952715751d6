#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/diagnosis.h"

namespace twinbench::report {

/// The answer in one line of at most 98 letters: "Named: backlash, width 0.0120 +- 0.0003 deg (97 %) in 720
/// readings of run.csv"; "Tie: a or b (48 % each) in ..."; "Unknown: ..."; "Agrees: nothing found in ... (p =
/// 0.4)".
/// @param source  The file or folder; only its name is told if it is long, and not how many readings it holds where
///                causes need the room.
/// @param share  What each cause explains (Shown::share): what explains most is named first.
std::string VerdictLine(const diagnose::Diagnosis& diagnosis, const std::string& source, const std::vector<double>& share = {});

}  // namespace twinbench::report
