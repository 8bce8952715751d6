#pragma once

#include <Eigen/Core>
#include <array>

#include "twin/core/scenario.h"
#include "twin/measure/geometry.h"
#include "twin/measure/motion.h"

/// The believed optics of the rotary bench with every parameter that a cause may alter.
namespace twinbench::diagnose::rotary {

using measure::Vector4;

/// PSDs stay where the nominal order meets them; what deviates is listed here.
struct OpticalBench {
  measure::BenchGeometry nominal;
  bool published = false;  // true: equations 1-12 of Jywe et al. (2007), which know no deviations of the light

  double wavelength_error_m = 0.0;
  double incidence_rad = 0.0;     // laser stands aside and still hits the nominal spot; positive from +x
  double laser_distance_m = 0.2;  // exit to nominal spot: the lever of its pointing
  double laser_yaw_rad = 0.0;     // pointing about z ...
  double laser_pitch_rad = 0.0;   // ... and upwards
  std::array<double, 2> distance_error_m{};
  std::array<double, 2> roll_rad{};  // right-handed towards the light
  std::array<double, 2> cubic_per_m2{};
  std::array<double, 2> stray_fraction{};
  std::array<double, 4> gain_error{};
};

/// The bench that a scenario describes, without its [[effect]] blocks.
OpticalBench BelievedBench(const Scenario& scenario);

/// What the four channels show, referred to the PSDs' surfaces by their stated sensitivity [m].
///
/// @param motion  Pose of the grating [ez, ex, ey (rad), dy (m)] at the nominal spot.
/// @return NaN where an order does not reach its PSD.
Vector4 ShownSpots(const OpticalBench& bench, const Vector4& motion);

/// d shown / d wavelength at rest, by central differences.
Vector4 ShownByWavelength(const OpticalBench& bench);

/// d shown / d motion by central differences.
Eigen::Matrix4d ShownJacobian(const OpticalBench& bench, const Vector4& motion);

}  // namespace twinbench::diagnose::rotary
