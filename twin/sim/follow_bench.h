#pragma once

#include "twin/model/follow.h"

namespace twinbench::sim {

/// Whether the bench's twin can follow a record.
bool CanFollow(const Scenario& scenario);

/// The twin of the scenario's bench on the course of a record.
/// @throws std::logic_error if it cannot.
std::unique_ptr<model::Follow> FollowBench(const Scenario& scenario, const std::vector<Reading>& record);

}  // namespace twinbench::sim
