#pragma once

namespace twinbench::sim {

/// What a simulated fixture says of a set-up that the scenario has not.
/// @throws DeviceFault kRefused unless 0 <= setup < setups.
void RequireSetup(int setup, int setups);

}  // namespace twinbench::sim
