#pragma once

#include <functional>

#include "twin/core/scenario.h"
#include "twin/procedure/machine_options.h"
#include "twin/procedure/options.h"

namespace twinbench {

/// What MachineOptions::prove asks of a real bench; none where nothing at rest follows its axes in small steps, or
/// so in large ones that its readings prove themselves.
///
/// turntable_autocollimator: the turntable goes a twentieth of the autocollimator's range, x with it, y stands.
/// rotary_4dof: the tables go so that the spots move by a hundredth of the converter's range; which way is learned
/// from the first step, and that of the autocollimator's angles is known. Of a reading without volts what shows
/// them is asked first. freeform_five_axis: A and B go until the spot has moved by two fifths of its size, each
/// coordinate its own way. encoder_comparison: the shaft goes 5 deg beside the first reading of a mounting, from
/// where on reference, device and axis are compared with each other. circular_motion at rest: the machine goes 0.2
/// mm off its circle, with both axes, and bar or grid with it.
///
/// And what ProofByClosing asks.
///
/// @param bench, scenario, options  Must outlive what is returned.
std::function<void(const Reading&)> ProofBySteps(MachineBench& bench, const Scenario& scenario,
                                                 const procedure::MachineOptions& options);
std::function<void(const Reading&)> ProofBySteps(RotaryBench& bench, const Scenario& scenario,
                                                 const procedure::Options& options);

/// The way of a proof without its judgement: effects of a twin are there on purpose.
std::function<void(const Reading&)> WayOf(const std::function<void(const Reading&)>& proof);

}  // namespace twinbench
