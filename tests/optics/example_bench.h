#pragma once

#include "optics/bench.h"

namespace twinbench::optics {

inline constexpr double kDegree = std::numbers::pi / 180.0;
inline constexpr double kArcsec = kDegree / 3600.0;

inline PsdParameters ExamplePsd() {
  PsdParameters psd;
  psd.distance_m = 0.120;
  psd.width_m = 10e-3;
  psd.height_m = 10e-3;
  return psd;
}

/// A detector's window; its faces are parallel unless a wedge is given.
inline Window Glass(double wedge_rad = 0.0) {
  return {.thickness_m = 1e-3, .index = 1.5145, .gap_m = 1e-3, .reflectance = 0.042, .wedge_rad = wedge_rad};
}

/// The reference rotary bench: 650 nm, 600 lines/mm, detectors at 120 mm.
inline RotaryOpticsParameters ExampleBench() {
  RotaryOpticsParameters p;
  p.nominal_wavelength_m = 650e-9;
  p.laser_position_m = {0.0, 0.2, 0.0};
  p.grating = {.lines_per_m = 600e3, .width_m = 25e-3, .height_m = 25e-3, .reflectance = 1.0,
               .table = {{0.0, {-2, {0.1, 0.339, 0.1, 0.339, 0.1}}}}, .form = {}};
  p.psd_a = p.psd_b = ExamplePsd();
  return p;
}

inline SourceState ExampleSource() {
  return {.wavelength_m = 650e-9, .yaw_rad = 0.0, .pitch_rad = 0.0, .power_W = 5e-3};
}

}  // namespace twinbench::optics
