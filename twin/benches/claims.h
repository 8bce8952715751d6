#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario.h"

namespace twinbench {

/// How well a scenario's results say where an axis stood.
struct Claim {
  std::string axis;  // "target", "reference", "turntable", "shaft", "x" to "b" of the five-axis machine
  double u = 0.0;    // standard uncertainty of a result at one stop [rad], of a linear axis [m]
  std::string less;  // what of the scenario claims less: for an axis that does not settle to so little
};

/// What the results of a scenario claim of its axes, from the noise of a reading that it states and how often it goes to each
/// stop. None where results do not go by where an axis was sent: of hob_transmission and of a polygon, whose encoders are read;
/// of circular_motion, where how far the machine stands from its command is what is measured; and of a scenario without noise.
///
/// rotary_4dof: both PSDs see a yaw e of the grating as a spot that moves by l (1 + 1/cos theta) e (grating equation at normal
/// incidence, l its distance, theta the angle of the order); each stop is read once a pass and set-up, and of S set-ups the
/// separation of two tables leaves S - 1.
/// encoder_comparison at stops: the device's noise, once a pass and turn.
/// turntable_autocollimator with a multi-tooth table: the stated uncertainty of a tooth and the autocollimator's noise.
/// freeform_five_axis: what the probe's noise lets both readings at a pose say of one axis (PlaceNoise).
std::vector<Claim> ClaimsOf(const Scenario& scenario);

}  // namespace twinbench
