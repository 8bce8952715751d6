#pragma once

#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::test {

/// The reference rotary bench: every key at its default, but tables that stand where they are sent at once. Tests
/// of bodies ask for bodies.
inline Scenario RotaryScenario() {
  Scenario scenario;
  scenario.bench = kRotaryBench;
  RotaryOf(scenario).mechanics.fidelity = "kinematic";
  return scenario;
}

/// A short run of a bench on which everything changes: noise, drift, seating, repeatability, hum. Whatever state of
/// it is not restored after a fault shows in the readings.
inline Scenario RestlessBench() {
  Scenario scenario = RotaryScenario();
  scenario.seed = 23;
  RotaryOf(scenario).procedure.positions = 6;
  RotaryOf(scenario).procedure.shifts = {0, 1};
  RotaryOf(scenario).procedure.passes = {1, -1};
  RotaryOf(scenario).procedure.sweep_points = 3;
  RotaryOf(scenario).procedure.dwell_s = {1.0, 2.0, 7.0};
  RotaryOf(scenario).procedure.remount_s = 60.0;
  scenario.environment.drift_K_h = 2.0;
  scenario.environment.random_walk_K_sqrt_h = 0.1;
  RotaryOf(scenario).laser.pointing_yaw_per_kelvin_rad = 1e-5;
  RotaryOf(scenario).reference.seating_sd[2] = 20.0 * units::arcsec;
  RotaryOf(scenario).reference.seating_sd[0] = 20.0 * units::arcsec;
  RotaryOf(scenario).amplifier.hum_V = 0.01;
  RotaryOf(scenario).target.repeatability_sd[0] = 1.0 * units::arcsec;
  RotaryOf(scenario).target.random_rms = {4e-5, 4e-5, 4e-5, 2e-6, 2e-6, 1e-6};
  return scenario;
}

}  // namespace twinbench::test

namespace twinbench::sim {

inline Scenario Quiet() {
  Scenario scenario = test::RotaryScenario();
  scenario.noise_free = true;
  return scenario;
}

/// With noise, but none of the amplifier.
inline Scenario OnlyTheLightsNoise() {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).amplifier.noise_V = 0.0;
  return scenario;
}

}  // namespace twinbench::sim
