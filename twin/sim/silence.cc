#include "twin/sim/silence.h"

namespace twinbench::sim {
namespace {

void SilenceTable(TableSettings& table) {
  table.seating_sd = {};
  table.repeatability_sd = {};
}

}  // namespace

void Silence(Scenario& scenario) {
  scenario.amplifier.noise_V = 0.0;
  scenario.autocollimator.noise_rad = 0.0;
  scenario.environment.sensor_noise_K = 0.0;
  scenario.environment.random_walk_K_sqrt_h = 0.0;
  scenario.table_encoder.noise_rad = 0.0;
  scenario.hob_encoder.noise_rad = 0.0;
  scenario.interferometer.noise_rad = 0.0;
  SilenceTable(scenario.target);
  SilenceTable(scenario.reference);
}

}  // namespace twinbench::sim
