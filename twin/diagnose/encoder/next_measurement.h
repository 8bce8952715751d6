#pragma once

#include <string>

namespace twinbench::diagnose::encoder {

/// What would split two causes of an angle device that a run cannot tell apart, in words; never empty.
std::string NextMeasurement(const std::string& effect, const std::string& rival);

}  // namespace twinbench::diagnose::encoder
