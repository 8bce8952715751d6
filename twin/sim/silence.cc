#include "twin/sim/silence.h"

namespace twinbench::sim {

void Silence(TableSettings& table) {
  table.seating_sd = {};
  table.repeatability_sd = {};
}

void Silence(EnvironmentSettings& environment) {
  environment.sensor_noise_K = 0.0;
  environment.random_walk_K_sqrt_h = 0.0;
}

void Silence(MechanicsSettings& mechanics) {
  mechanics.asynchronous_radial_m = mechanics.asynchronous_axial_m = mechanics.asynchronous_tilt_rad = {};
  mechanics.vibration = "none";
}

}  // namespace twinbench::sim
