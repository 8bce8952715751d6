#pragma once

#include <string>
#include <vector>

#include "tests/hidden/bench_runs.h"

/// What no diagnosis can tell apart or see at all, so that a case does not ask for it.
namespace twinbench::hidden {

/// Effects that the readings of a case cannot tell from this one, itself included.
///
/// @param drawn  The bench of the case.
std::vector<std::string> AlikeOf(const EffectSettings& effect, const Scenario& drawn, const SignatureScale& scale);

/// A place of `convention` that only relabels the positions: free errors of both tables are the same under other
/// labels.
bool OnlyRelabels(const std::string& where);

}  // namespace twinbench::hidden
