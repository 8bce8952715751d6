#pragma once

#include <vector>

#include "twin/core/scenario.h"
#include "twin/plausible/check.h"
#include "twin/plausible/expected.h"

namespace twinbench {

/// What the scenario of a bench claims of its columns, from the noise and the steps of its instruments and from what is made to
/// differ on purpose; noise that the readings bring themselves goes before what is stated. Numbers of an instrument that is only as
/// good as its steps are left out: steps repeat themselves.
///
/// rotary_4dof: in calibration a yaw e moves a spot by l (1 + 1/cos theta) e (grating equation at normal incidence, l its distance,
/// theta the angle of the order). encoder_comparison: the device shows the reference's angle. hob_transmission: the hob turns teeth
/// over starts for one turn of the table. circular_motion: encoder and grid show the commanded point. freeform_five_axis: the
/// estimators' model of an ideal machine. turntable_autocollimator: the tilt of a set-up is once a turn in y.
std::vector<plausible::Expected> ExpectedOf(const Scenario& scenario, const std::vector<Reading>& readings);

/// plausible::Check with all that the scenario claims: what every command asks of readings before anything is made of them.
std::vector<plausible::Finding> DoubtsAbout(const std::vector<Reading>& readings, const Scenario& scenario);

}  // namespace twinbench
