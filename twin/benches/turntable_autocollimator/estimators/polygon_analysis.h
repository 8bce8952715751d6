#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/polygon_closure.h"
#include "twin/core/estimator.h"

/// From readings of the turntable bench with a polygon to all that is reported of them.
namespace twinbench::separate::turntable {

/// What a scenario states that scatters a reading, as a standard deviation.
struct StatedScatter {
  std::string source;  // "encoder.noise_arcsec"
  std::string part;    // of a budget: "noise", "quantisation", "repeatability"
  double u_rad = 0.0;
};

struct PolygonAnalysis {
  Estimator estimator = Estimator::kRigorous;
  int used = 0, left_out = 0;  // readings
  int clampings = 0;
  std::optional<PolygonClosure> closure;
  double method_bias_rad = 0.0;  // published: difference from the rigorous curve, rms; part of the uncertainties
  std::vector<StatedScatter> stated;
  // Variances that the scatter of the readings makes, without that difference and orders above: of the curves, and of the
  // coefficients of `encoder`.
  Eigen::VectorXd turntable_rad2, polygon_rad2, coefficients_rad2;
  std::string not_separated;  // why there is no closure

  double Stated_rad() const;  // of all sources together
};

/// @param estimator  kRigorous: ClosePolygon. kPublished: ClosePolygonByMeans, with its own bias in what it states.
/// @throws InputError as FaceReadings and ClosePolygon.
PolygonAnalysis AnalysePolygon(const std::vector<Reading>& readings, const Scenario& scenario, Estimator estimator);

}  // namespace twinbench::separate::turntable
