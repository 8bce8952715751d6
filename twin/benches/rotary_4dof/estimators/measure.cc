#include "twin/benches/rotary_4dof/estimators/measure.h"

#include <Eigen/LU>
#include <cmath>

#include "twin/benches/rotary_4dof/estimators/grating_model.h"
#include "twin/benches/rotary_4dof/estimators/published_motion.h"

namespace twinbench::measure {
namespace {

/// Motion values and what they change by per metre of spot coordinate.
struct Estimate {
  Vector4 motion = Vector4::Constant(kNaN);
  Matrix4 d_spots = Matrix4::Constant(kNaN);  // d motion / d spots
};

Estimate Rigorous(const Vector4& spots_m, const BenchGeometry& geometry) {
  const MotionFit fit = SolveMotion(spots_m, geometry);
  return {fit.motion, fit.jacobian.inverse()};
}

double PublishedL1(const BenchGeometry& geometry, const Calibration& calibration) {
  return calibration.published_l1_m.value_or(0.5 * (geometry.psd_distance_m[0] + geometry.psd_distance_m[1]));
}

Estimate Published(const Vector4& spots_m, const BenchGeometry& geometry, double l1_m) {
  constexpr double kStep_m = 1e-7;
  Estimate estimate{PublishedMotion(spots_m, l1_m, geometry), {}};
  for (int c = 0; c < kChannels; ++c) {
    const Vector4 step_m = kStep_m * Vector4::Unit(c);
    estimate.d_spots.col(c) =
        (PublishedMotion(spots_m + step_m, l1_m, geometry) - PublishedMotion(spots_m - step_m, l1_m, geometry)) /
        (2.0 * kStep_m);
  }
  return estimate;
}

Motion Labelled(const Reading& r) {
  Motion m;
  m.reading = r.reading;
  m.setup = r.setup;
  m.pass = r.pass;
  m.direction = r.direction;
  m.position = r.position;
  m.phase = r.phase;
  m.time = r.time;
  m.target_rad = r.target_rad;
  m.reference_rad = r.reference_rad;
  return m;
}

Motion& Reject(Motion& motion, ReadingStatus status, const char* reason) {
  motion.status = status;
  motion.reason = reason;
  return motion;
}

void Fill(Motion& motion, const Estimate& estimate, const std::optional<Vector4>& variance_m2) {
  motion.status = ReadingStatus::kOk;
  motion.reason.clear();
  motion.SetValues(estimate.motion);
  motion.covariance_known = variance_m2.has_value();
  if (variance_m2) motion.cov = estimate.d_spots * variance_m2->asDiagonal() * estimate.d_spots.transpose();
}

void FillSystematic(Motion& motion, const Matrix46& d_calibration, const Matrix6& cov) {
  motion.d_calibration = d_calibration;
  motion.cov_systematic = d_calibration * cov * d_calibration.transpose();
}

/// The uncalibrated detectors of the paper: gains 1, rolls 0.
Calibration Untouched() {
  return {};
}

Motion MeasureOne(const Reading& reading, const BenchGeometry& geometry, const Calibration& calibration,
                  Estimator estimator) {
  Motion motion = Labelled(reading);
  if (reading.status != ReadingStatus::kOk) return Reject(motion, reading.status, "the reading carries no numbers");
  const bool rigorous = estimator == Estimator::kRigorous;
  const Calibration detectors = rigorous ? calibration : Untouched();
  const Vector4 spots_m = SpotsFromVoltages(reading.mean_V, geometry, detectors);
  if (!spots_m.allFinite()) return Reject(motion, ReadingStatus::kMissing, "a voltage is not available");
  const Estimate estimate =
      rigorous ? Rigorous(spots_m, geometry) : Published(spots_m, geometry, PublishedL1(geometry, calibration));
  if (!estimate.motion.allFinite()) {
    return Reject(motion, ReadingStatus::kMissing, "no motion of the grating gives these spots");
  }
  std::optional<Vector4> variance_m2 = SpotVariances(reading, geometry);
  if (variance_m2) *variance_m2 += HumVariances_m2(reading.n_samples, geometry);
  Fill(motion, estimate, variance_m2);
  const Matrix46 d_calibration = estimate.d_spots * SpotCalibrationJacobian(spots_m, detectors);
  FillSystematic(motion, rigorous ? d_calibration : Matrix46::Zero(), detectors.cov);
  return motion;
}

}  // namespace

std::vector<Motion> Measure(const std::vector<Reading>& readings, const BenchGeometry& geometry,
                            const Calibration& calibration, Estimator estimator) {
  std::vector<Motion> motions;
  motions.reserve(readings.size());
  for (const Reading& r : readings) motions.push_back(MeasureOne(r, geometry, calibration, estimator));
  if (estimator == Estimator::kPublished) RemoveShiftConstants(motions);
  return motions;
}

}  // namespace twinbench::measure
