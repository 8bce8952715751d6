#pragma once

#include <string>

#include "twin/diagnose/diagnose.h"

/// How far the readings are from the scenario at all, before anybody asks why.
namespace twinbench::diagnose {

struct Disagreement {
  double before = 0.0, after = 0.0;  // rms of what is left, in units of the noise: without the causes and with them
  bool is_plausible = true;          // false: no cause found makes these readings of this scenario
  std::string line;                  // what is to be said of it; empty if nothing
};

/// Readings that are many times their noise away from the scenario, and stay there whatever was found, are another
/// bench's, another scenario's, or in other units: what is said of their causes cannot be trusted.
Disagreement DisagreementOf(const DiagnosisRun& found);

}  // namespace twinbench::diagnose
