#pragma once

#include <Eigen/Core>
#include <array>

#include "twin/benches/rotary_4dof/diagnosis/rotary_twin.h"
#include "twin/benches/rotary_4dof/estimators/design.h"

/// The free unknowns of the fit, in this order: table errors, mounting constants and seats as separate::Design
/// orders them (angles in rad, lengths in its length unit); the mounting constants of the calibration phase (ez,
/// ex, ey, dy); the calibrated parameters of the bench (SI).
namespace twinbench::diagnose::rotary {

/// Four gains, two rolls, two distances, wavelength, incidence.
inline constexpr int kCalibrated = 10;

int CalibrationMountColumn(const separate::Design& design);  // first of four
int CalibratedColumn(const separate::Design& design);        // first of kCalibrated
int UnknownsOf(const separate::Design& design);

/// One calibrated parameter of the bench, and how far it may be off [SI].
struct Calibrated {
  BenchConstant constant;
  double sd;
};
const std::array<Calibrated, kCalibrated>& CalibratedConstants();

/// 1 / sd^2 of every unknown.
Eigen::VectorXd PriorPrecision(const separate::Design& design);

}  // namespace twinbench::diagnose::rotary
