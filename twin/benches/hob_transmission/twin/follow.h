#pragma once

#include "twin/model/follow.h"

namespace twinbench::sim {

/// The hobbing machine's twin on the course of a record. Predictions are two [rad]: what table encoder - ratio x
/// hob encoder should have been with the hob's encoder where the record has it, and what the interferometer should
/// have seen (NaN without one).
///
/// Free, so zero until given at the point "transmission": orders 1 to transmission.free_orders of the transmission
/// error. The chain is quasi-static, as the kinematic train is where the wheel drags the table. Left out: inertia,
/// so what servo and torsion do to harmonics in the fidelity "bullet" (at the line of the worm, at 50 r/min of the
/// hob, 0.2 % of it), and what is left of a play that a ramp did not cross.
std::unique_ptr<model::Follow> FollowHob(const Scenario& scenario, const std::vector<Reading>& record);

}  // namespace twinbench::sim
