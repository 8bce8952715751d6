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
  return Altered(RotaryScenario(), {"seed=23",
                                    "procedure.positions=6",
                                    "procedure.shifts=[0, 1]",
                                    "procedure.passes=[1, -1]",
                                    "procedure.sweep_points=3",
                                    "procedure.dwell_s=[1, 2, 7]",
                                    "procedure.remount_s=60",
                                    "environment.drift_K_h=2",
                                    "environment.random_walk_K_sqrt_h=0.1",
                                    "laser.pointing_yaw_per_kelvin_urad=10",
                                    "reference.seating.ex_arcsec=20",
                                    "reference.seating.ez_arcsec=20",
                                    "amplifier.hum_mV=10",
                                    "target.repeatability.ex_arcsec=1",
                                    "target.random.ex_arcsec=8",
                                    "target.random.ey_arcsec=8",
                                    "target.random.ez_arcsec=8",
                                    "target.random.dx_um=2",
                                    "target.random.dy_um=2",
                                    "target.random.dz_um=1"});
}

}  // namespace twinbench::test

namespace twinbench::sim {

inline Scenario Quiet() { return Altered(test::RotaryScenario(), {"noise_free=true"}); }

/// With noise, but none of the amplifier.
inline Scenario OnlyTheLightsNoise() { return Altered(test::RotaryScenario(), {"amplifier.noise_mV=0"}); }

}  // namespace twinbench::sim
