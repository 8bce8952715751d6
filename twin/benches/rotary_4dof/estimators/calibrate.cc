#include "twin/benches/rotary_4dof/estimators/calibrate.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "twin/benches/rotary_4dof/estimators/grating_model.h"
#include "twin/benches/rotary_4dof/estimators/published_motion.h"

namespace twinbench::measure {
namespace {

constexpr int kUnknowns = kCalibrationParameters + kDofs;  // gains, rolls, mounting constants
constexpr int kMostGaussNewtonSteps = 8;
constexpr double kAssumedNoise_m = 0.3e-6;  // only its constancy matters: it is rescaled by residuals
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Block = Eigen::Matrix<double, kChannels, kUnknowns>;

/// One reading of the sweeps, referred to the PSDs' surfaces.
struct SweepPoint {
  double yaw_rad;
  double tilt_rad;
  Vector4 shown_m;
  Vector4 variance_m2;
  Vector4 of_autocollimator;  // share of it
};

bool IsUsable(const Reading& reading) {
  if (reading.phase != Phase::kCalibration || reading.status != ReadingStatus::kOk) return false;
  for (const double V : reading.mean_V) {
    if (!std::isfinite(V)) return false;
  }
  return std::isfinite(reading.autocollimator_yaw_rad) && std::isfinite(reading.autocollimator_tilt_rad);
}

/// The autocollimator's noise as spot noise; first-order lengths l1 (1 + 1/cos) and l1 (1 + cos) are ample for
/// that.
Vector4 AutocollimatorVariances(const BenchGeometry& geometry) {
  const double cos_theta = std::sqrt(1.0 - std::pow(geometry.SinTheta(), 2));
  const double u_rad = geometry.autocollimator_noise_rad;
  Vector4 lever_m;
  for (int p = 0; p < 2; ++p) {
    const double l1_m = geometry.psd_distance_m[static_cast<std::size_t>(p)];
    lever_m.segment<2>(2 * p) << l1_m * (1.0 + 1.0 / cos_theta), l1_m * (1.0 + cos_theta);
  }
  return (lever_m * u_rad).cwiseAbs2();
}

struct Sweep {
  std::vector<SweepPoint> points;
  bool noise_known = true;
};

Sweep CollectSweep(const std::vector<Reading>& readings, const BenchGeometry& geometry) {
  Sweep sweep;
  const Vector4 autocollimator_m2 = AutocollimatorVariances(geometry);
  for (const Reading& r : readings) {
    if (!IsUsable(r)) continue;
    const auto noise_m2 = SpotVariances(r, geometry);
    sweep.noise_known = sweep.noise_known && noise_m2.has_value();
    const Vector4 variance_m2 = noise_m2.value_or(Vector4::Constant(kAssumedNoise_m * kAssumedNoise_m));
    const double gain = geometry.autocollimator_gain;
    sweep.points.push_back({r.autocollimator_yaw_rad / gain, r.autocollimator_tilt_rad / gain,
                            OnSurface(r.mean_V, geometry), variance_m2 + autocollimator_m2,
                            autocollimator_m2.cwiseQuotient(variance_m2 + autocollimator_m2)});
  }
  return sweep;
}

/// By the way from the unknowns to the shown spots: only the mounting constants move the spots.
class Shown {
 public:
  Shown(const SweepPoint& point, const BenchGeometry& geometry)
      : geometry_(geometry),
        turn_((Eigen::AngleAxisd(point.yaw_rad, Vector3::UnitZ()) * Eigen::AngleAxisd(point.tilt_rad, Vector3::UnitX()))
                  .toRotationMatrix()) {}
  Vector4 Spots_m(const Unknowns& x) const {
    const Vector4 mount = x.tail<kDofs>();
    return PredictSpots(turn_ * MotionRotation(mount), mount[3], geometry_);
  }
  static Vector4 At(const Vector4& spots_m, const Unknowns& x) { return ShownSpots(spots_m, x.head<4>(), x.segment<2>(4)); }

 private:
  const BenchGeometry& geometry_;
  Matrix3 turn_;
};

Vector4 Predict(const Unknowns& x, const SweepPoint& point, const BenchGeometry& geometry) {
  return Shown::At(Shown(point, geometry).Spots_m(x), x);
}

Block PredictJacobian(const Unknowns& x, const SweepPoint& point, const BenchGeometry& geometry) {
  constexpr double kStep = 1e-5;
  const Shown shown(point, geometry);
  const Vector4 spots_m = shown.Spots_m(x);
  Block jacobian;
  for (int i = 0; i < kUnknowns; ++i) {
    const Unknowns step = kStep * Unknowns::Unit(i), above = x + step, below = x - step;
    const bool moves = i >= kCalibrationParameters;
    jacobian.col(i) = (Shown::At(moves ? shown.Spots_m(above) : spots_m, above) -
                       Shown::At(moves ? shown.Spots_m(below) : spots_m, below)) /
                      (2.0 * kStep);
  }
  return jacobian;
}

Unknowns PriorValues() {
  Unknowns x = Unknowns::Zero();
  x.head<4>().setOnes();
  return x;
}

/// Information of the prior: gains and rolls; the mounting constants have none.
Normal PriorInformation(double scale) {
  Normal information = Normal::Zero();
  information.diagonal().head<kCalibrationParameters>() =
      scale * Calibration::PriorCovariance().diagonal().cwiseInverse();
  return information;
}

struct SweepFit {
  Unknowns x = PriorValues();
  Normal cov = Normal::Zero();
  Normal of_autocollimator = Normal::Zero();  // of the normal matrix, what its noise would make alone
  Vector4 squares_m2 = Vector4::Zero();
  double chi2 = 0.0;
};

/// One Gauss-Newton step, or, at the end, the residuals and the covariance.
void Step(const Sweep& sweep, const BenchGeometry& geometry, SweepFit& fit) {
  Normal normal = PriorInformation(1.0);
  Unknowns right = normal * (PriorValues() - fit.x);
  fit.of_autocollimator.setZero();
  for (const SweepPoint& point : sweep.points) {
    const Block jacobian = PredictJacobian(fit.x, point, geometry);
    const Vector4 weight = point.variance_m2.cwiseInverse();
    normal += jacobian.transpose() * weight.asDiagonal() * jacobian;
    fit.of_autocollimator += jacobian.transpose() * weight.cwiseProduct(point.of_autocollimator).asDiagonal() * jacobian;
    right += jacobian.transpose() * weight.asDiagonal() * (point.shown_m - Predict(fit.x, point, geometry));
  }
  const Eigen::LDLT<Normal> ldlt(normal);
  fit.x += ldlt.solve(right);
  fit.cov = ldlt.solve(Normal::Identity());
}

void AddResiduals(const Sweep& sweep, const BenchGeometry& geometry, SweepFit& fit) {
  for (const SweepPoint& point : sweep.points) {
    const Vector4 squares_m2 = (point.shown_m - Predict(fit.x, point, geometry)).cwiseAbs2();
    fit.squares_m2 += squares_m2;
    fit.chi2 += squares_m2.cwiseQuotient(point.variance_m2).sum();
  }
}

SweepFit FitSweep(const Sweep& sweep, const BenchGeometry& geometry) {
  SweepFit fit;
  for (int i = 0; i < kMostGaussNewtonSteps; ++i) {
    const Unknowns before = fit.x;
    Step(sweep, geometry, fit);
    if ((fit.x - before).cwiseAbs().maxCoeff() < 1e-12) break;
  }
  AddResiduals(sweep, geometry, fit);
  return fit;
}

/// Diagonal of N^-1 (part of N) N^-1 over that of N^-1, for gains and rolls.
CalibrationVector ShareOfCovariance(const Normal& part, const Normal& cov) {
  return (cov * part * cov).diagonal().cwiseQuotient(cov.diagonal()).head<kCalibrationParameters>();
}

Calibration Summary(const Sweep& sweep, const SweepFit& fit) {
  Calibration c;
  c.measured = true;
  c.readings = static_cast<int>(sweep.points.size());
  c.dof = kChannels * c.readings - kUnknowns;
  c.gain = fit.x.head<4>();
  c.roll_rad = fit.x.segment<2>(4);
  c.mount = fit.x.tail<kDofs>();
  c.residual_rms_m = (fit.squares_m2 / static_cast<double>(c.readings)).cwiseSqrt();
  const double scale = sweep.noise_known || c.dof < 1 ? 1.0 : fit.chi2 / c.dof;
  c.cov = scale * fit.cov.topLeftCorner<kCalibrationParameters, kCalibrationParameters>();
  c.of_prior = ShareOfCovariance(PriorInformation(1.0), fit.cov);
  c.of_autocollimator = ShareOfCovariance(fit.of_autocollimator, fit.cov);
  if (sweep.noise_known) c.chi2 = fit.chi2;
  if (!sweep.noise_known)
    c.notes.push_back("calibration: noise of the readings not known, scaled by the residuals");
  return c;
}

}  // namespace

Matrix6 Calibration::PriorCovariance() {
  Eigen::Matrix<double, kCalibrationParameters, 1> u;
  u << Eigen::Vector4d::Constant(kPriorGain), Eigen::Vector2d::Constant(kPriorRoll_rad);
  return u.cwiseAbs2().asDiagonal();
}

Calibration Calibrate(const std::vector<Reading>& readings, const BenchGeometry& geometry) {
  const Sweep sweep = CollectSweep(readings, geometry);
  Calibration calibration;
  if (sweep.points.size() >= 3) {
    calibration = Summary(sweep, FitSweep(sweep, geometry));
  } else {
    calibration.notes.push_back(
        "no calibration readings: gains are 1 ± 2 %, rolls 0 ± 20 mrad; both y channels reversed would fit as "
        "well, and ex, ey and dy hold as the wires do");
  }
  calibration.published_l1_m = PublishedDistance(readings, geometry);
  return calibration;
}

}  // namespace twinbench::measure
