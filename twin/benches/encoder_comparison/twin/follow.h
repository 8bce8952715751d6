#pragma once

#include "twin/model/follow.h"

namespace twinbench::sim {

/// The angle comparison's twin on the course of a record; the prediction is the device's angle where the reference
/// showed what it did [rad], counted on over turns. Points: "shaft" (under both), "device" (of what it shows).
std::unique_ptr<model::Follow> FollowEncoder(const Scenario& scenario, const std::vector<Reading>& record);

}  // namespace twinbench::sim
