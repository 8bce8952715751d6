#pragma once

#include <string>

namespace twinbench::diagnose::hob {

/// What would split two causes in a transmission chain that a run cannot tell apart, in words; never empty.
std::string NextMeasurement(const std::string& effect, const std::string& rival);

}  // namespace twinbench::diagnose::hob
