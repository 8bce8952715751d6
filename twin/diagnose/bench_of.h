#pragma once

#include <string>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// The bench whose channels these are.
std::string BenchOf(const LinearRun& run);

}  // namespace twinbench::diagnose
