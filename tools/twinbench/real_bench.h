#pragma once

#include <optional>
#include <string>

#include "twin/core/scenario.h"

namespace twinbench {
class Simulation;
}

namespace twinbench::tools {

/// Whether what a bench file of this kind opened is a real bench, whose readings are proved: no twin, served or
/// own, and no recording.
bool IsRealBench(const std::string& kind, const Simulation* simulation);

/// What a scenario takes on a real bench whose axes are as fast as the twin's, by its clock, with the steps that
/// prove readings; none where no controllers can stand for the bench, or the twin cannot carry the scenario out.
std::optional<double> MinutesOnRealBench(const Scenario& scenario);

/// ", 95 with the short steps that prove the readings of a real bench"; "" where they take less than half a minute.
std::string WithProofs(double minutes, const std::optional<double>& on_real_bench);

}  // namespace twinbench::tools
