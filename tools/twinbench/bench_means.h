#pragma once

#include <functional>

#include "twin/core/bench.h"
#include "twin/investigate/means.h"

namespace twinbench::tools {

/// What an investigation asks of this bench.
/// @param may_offer  Which of the bench's runs.
/// @param how        Of each diagnosis.
investigate::Means MeansOf(const Bench& bench, const std::function<bool(const plan::NextRun&)>& may_offer,
                           const diagnose::DiagnoseOptions& how);

}  // namespace twinbench::tools
