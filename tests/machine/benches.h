#pragma once

#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/names.h"
#include "twin/core/scenario.h"

/// Short runs of the benches with a machine, with effects that remember.
namespace twinbench::test {

/// Two set-ups, each with sweeps both ways at one feed and a few stops: 2 * (2 * 12 + 2 * 4) = 64 readings.
inline Scenario ShortCircles() {
  Scenario scenario = ParseScenario(R"(bench = "circular_motion"
seed = 7
[machine]
squareness_arcsec = 12.0
backlash_x_um = 3.0
[circular_procedure]
setups = [ { instrument = "bar", radius_mm = 110.230 }, { instrument = "grid", radius_mm = 90.0 } ]
feeds_mm_min = [1000.0]
points = 12
stops = 4
[environment]
swing_mK = 500.0
swing_period_s = 3000.0
[[effect]]
name = "drift"
where = "x"
drift_um_K = 5.0
lag_s = 900.0
)",
                                    "short_circles.toml", "");
  return scenario;
}

/// Two mounts of six poses, there and back: 24 readings.
inline Scenario ShortFreeform() {
  return ParseScenario(R"(bench = "freeform_five_axis"
seed = 9
[freeform_procedure]
mounts = [ { }, { z_mm = 60.0, yaw_deg = 90.0 } ]
poses = 6
[[effect]]
name = "backlash"
where = "x"
half_um = 2.0
)",
                       "short_freeform.toml", "");
}

/// Two set-ups of the multi-tooth table, with a sweep before and checks behind: 5 + 2 * 2 * 6 + 4 = 33 readings.
inline Scenario ShortTurntable() {
  return ParseScenario(R"(bench = "turntable_autocollimator"
seed = 7
[turntable_procedure]
phases = ["calibration", "full_circle", "verification"]
positions = 6
tilts_arcsec = [60.0, 100.0]
shifts_teeth = [0, 75]
dwell_s = [1.0, 4.0]
sweep_points = 5
verification_positions = 4
[[effect]]
name = "mount_creep"
where = "x"
[[effect]]
name = "multitooth_seating"
)",
                       "short_turntable.toml", "");
}

/// Two clampings of a polygon whose faces are nulled, by a turntable with a servo and an encoder with noise: 24 readings.
inline Scenario ShortPolygon() {
  return ParseScenario(R"(bench = "turntable_autocollimator"
seed = 9
[polygon]
faces = 12
face_rms_arcsec = 2.0
[encoder]
noise_arcsec = 0.02
step_arcsec = 0.001
[mechanics]
fidelity = "linear"
[turntable_procedure]
phases = ["full_circle"]
positions = 6
polygon_offsets_deg = [0.0, 45.0]
[[effect]]
name = "backlash"
width_arcsec = 1.0
)",
                       "short_polygon.toml", "");
}

/// Two mountings of a device that lags in its play, read at stops there and back: 2 * 2 * 12 = 48 readings.
inline Scenario ShortStops() {
  return ParseScenario(R"(bench = "encoder_comparison"
seed = 5
[encoder_procedure]
kind = "stops"
turns = 1.0
stops_per_turn = 12
passes = [1, -1]
mounting_deg = [0.0, 180.0]
[[effect]]
name = "backlash"
width_deg = 0.001
[[effect]]
name = "drift"
)",
                       "short_stops.toml", "");
}

/// Two mountings of a device that is read late and drifts, in motion there and back at two speeds: 2 * 2 * (8 + 11) = 76
/// readings.
inline Scenario ShortSweep() {
  return ParseScenario(R"(bench = "encoder_comparison"
seed = 6
[device]
graduation_arcsec = 3.0
[encoder_procedure]
kind = "sweep"
turns = 0.25
passes = [1, -1]
speeds_deg_s = [36.0, 18.0]
interval_s = 0.8
mounting_deg = [0.0, 180.0]
[[effect]]
name = "latency"
[[effect]]
name = "drift"
)",
                       "short_sweep.toml", "");
}

/// Two places of the head, a turn there and back at one speed, and stops for the interferometer: 2 * 2 * 12 + 2 * 8 = 64
/// readings.
inline Scenario ShortHob() {
  return ParseScenario(R"(bench = "hob_transmission"
seed = 3
[interferometer]
stops = 8
[hob_procedure]
heads_deg = [0.0, 180.0]
turns = 1
samples_per_turn = 12
rest_s = 7.0
)",
                       "short_hob.toml", "");
}

}  // namespace twinbench::test
