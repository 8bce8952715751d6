#pragma once

#include "twin/core/bench.h"
#include "twin/investigate/means.h"

namespace twinbench::tools {

/// What an investigation asks of this bench.
/// @param may_offer  Which of the bench's runs.
investigate::Means MeansOf(const Bench& bench, const std::function<bool(const plan::NextRun&)>& may_offer);

}  // namespace twinbench::tools
