#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/harmonic_model.h"
#include "twin/benches/turntable_autocollimator/estimators/polygon_readings.h"

/// Results of a polygon's closure by angle.
namespace twinbench::separate::turntable {

/// Nominal angles of the turntable within a turn, ascending, each once.
std::vector<double> DistinctAngles(const std::vector<FaceReading>& readings);

/// A curve at these angles, its mean over them taken out. What is not modelled counts as independent from angle to angle.
AngleSeries CurveAt(const HarmonicModel& curve, const std::vector<double>& angles_rad);

struct FaceSeries {
  AngleSeries errors;     // by the own angle of the faces: face f of n stands at -f steps
  std::vector<int> face;  // their numbers
};

/// @param names  Numbers of the faces whose values and covariance these are.
/// @param faces  Of the polygon.
FaceSeries ByOwnAngle(const std::vector<int>& names, const Eigen::VectorXd& value_rad,
                      const Eigen::MatrixXd& cov_rad2, int faces);

}  // namespace twinbench::separate::turntable
