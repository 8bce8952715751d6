#pragma once

#include <functional>

#include "twin/core/scenario.h"
#include "twin/procedure/machine_options.h"
#include "twin/procedure/options.h"

namespace twinbench {

/// What ProofBySteps asks besides: where a pass that went the other way has come back to the begin of an earlier
/// one, the axes come to that place once more from the side from which they came then, by the run-up of the
/// procedure, as procedure::Closing says. Of rotary_4dof also that the two spots are not exchanged against the pass
/// before.
///
/// encoder_comparison: what the device shows, less what the reference does. A polygon: x, less where the turntable
/// stands. rotary_4dof: volts; coming back may change them by three times the stated hum and 1/2000 of the
/// converter's range.
///
/// @param bench, scenario, options  Must outlive what is returned.
std::function<void(const Reading&)> ProofByClosing(MachineBench& bench, const Scenario& scenario,
                                                   const procedure::MachineOptions& options);
/// @param show  A reading with what converter and autocollimator show now.
std::function<void(const Reading&)> ProofByClosing(RotaryBench& bench, const Scenario& scenario,
                                                   const procedure::Options& options,
                                                   const std::function<Reading(const Reading&)>& show);

}  // namespace twinbench
