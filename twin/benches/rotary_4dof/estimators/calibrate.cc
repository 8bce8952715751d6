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
  Matrix3 turn;  // by the autocollimator
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
    const Eigen::AngleAxisd yaw(r.autocollimator_yaw_rad / gain, Vector3::UnitZ()),
        tilt(r.autocollimator_tilt_rad / gain, Vector3::UnitX());
    sweep.points.push_back({(yaw * tilt).toRotationMatrix(), OnSurface(r.mean_V, geometry),
                            variance_m2 + autocollimator_m2,
                            autocollimator_m2.cwiseQuotient(variance_m2 + autocollimator_m2)});
  }
  return sweep;
}

/// What the channels of a point show, by the unknowns.
struct Shown {
  Vector4 at_m;
  Block jacobian = Block::Zero();
};

/// How the grating is mounted, and how the channels show a spot.
class Model {
 public:
  Model(const Unknowns& x, const BenchGeometry& geometry)
      : x_(x),
        geometry_(geometry),
        mount_(MotionRotation(x.tail<kDofs>())),
        mount_axes_(MotionAxes(x.tail<kDofs>(), mount_)) {
    for (int c = 0; c < kChannels; ++c)
      shows_.col(c) = ShownSpots(Vector4::Unit(c), Vector4::Ones(), x.segment<2>(4));
  }
  Shown At(const SweepPoint& point) const {
    const Spots spots = SpotsAt(point.turn * mount_, x_[kUnknowns - 1], geometry_);
    const Vector4 turned_m = shows_ * spots.at_m, gain = x_.head<4>();
    Shown shown{turned_m.cwiseProduct(gain)};
    shown.jacobian.leftCols<4>() = turned_m.asDiagonal();
    for (int p = 0; p < 2; ++p) {
      shown.jacobian.block<2, 1>(2 * p, 4 + p) << gain[2 * p] * turned_m[2 * p + 1],
          -gain[2 * p + 1] * turned_m[2 * p];
    }
    Matrix4 axes = mount_axes_;
    axes.topRows<3>() = point.turn * mount_axes_.topRows<3>();
    shown.jacobian.rightCols<kDofs>() = gain.asDiagonal() * shows_ * spots.slopes * axes;
    return shown;
  }

 private:
  const Unknowns& x_;
  const BenchGeometry& geometry_;
  Matrix3 mount_;
  Matrix4 mount_axes_;
  Matrix4 shows_;  // of a spot, with gains of 1
};

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
  const Model model(fit.x, geometry);
  for (const SweepPoint& point : sweep.points) {
    const auto [shown_m, jacobian] = model.At(point);
    const Vector4 weight = point.variance_m2.cwiseInverse();
    normal += jacobian.transpose() * weight.asDiagonal() * jacobian;
    fit.of_autocollimator +=
        jacobian.transpose() * weight.cwiseProduct(point.of_autocollimator).asDiagonal() * jacobian;
    right += jacobian.transpose() * weight.asDiagonal() * (point.shown_m - shown_m);
  }
  const Eigen::LDLT<Normal> ldlt(normal);
  fit.x += ldlt.solve(right);
  fit.cov = ldlt.solve(Normal::Identity());
}

void AddResiduals(const Sweep& sweep, const BenchGeometry& geometry, SweepFit& fit) {
  const Model model(fit.x, geometry);
  for (const SweepPoint& point : sweep.points) {
    const Vector4 squares_m2 = (point.shown_m - model.At(point).at_m).cwiseAbs2();
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

/// Ghosts move by several times as much as the spot, and by other motions otherwise than by those of the sweeps, along y.
void AddGhosts(const std::array<double, 2>& light, Calibration& c) {
  constexpr double kTimesAsFar = 3.0;
  for (int psd = 0; psd < 2; ++psd) {
    const int y = 2 * psd + 1;
    const double before = c.cov(y, y);
    c.cov(y, y) += std::pow(kTimesAsFar * light[static_cast<std::size_t>(psd)], 2);
    const double left = before / c.cov(y, y);
    c.of_prior[y] = 1.0 - left * (1.0 - c.of_prior[y]);
    c.of_autocollimator[y] *= left;
  }
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
  AddGhosts(geometry.ghost_light, calibration);
  calibration.published_l1_m = PublishedDistance(readings, geometry);
  return calibration;
}

}  // namespace twinbench::measure
