#include "optics/autocollimator.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "optics/collimator_pupil.h"
#include "optics/returned_beam.h"

namespace twinbench::optics {
namespace {

// Surfaces of the scene, in the order they are added.
constexpr int kMirror = 0;
constexpr int kObjective = 1;

void Require(bool good, const char* what) {
  if (!good) throw std::invalid_argument(std::string("autocollimator: ") + what);
}

bool IsPositive(double value) {
  return value > 0.0 && std::isfinite(value);
}

bool IsPose(const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d& r = X.linear();
  const double off = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return off < 1e-9 && r.determinant() > 0.0 && X.translation().allFinite();  // 1e-9 rad is 0.0002 arcsec
}

void ValidateLens(const AutocollimatorParameters& p) {
  Require(IsPositive(p.focal_length_m), "focal_length_m must be positive");
  Require(IsPositive(p.nominal_focal_length_m), "nominal_focal_length_m must be positive");
  Require(IsPositive(p.aperture_radius_m), "aperture_radius_m must be positive");
  Require(std::abs(p.defocus_m) < 0.1 * p.focal_length_m, "defocus_m must be below a tenth of focal_length_m");
  Require(std::isfinite(p.distortion_per_rad2), "distortion_per_rad2 must be finite");
  Require(p.pupil_rings >= 1 && p.pupil_rings <= 1000, "pupil_rings must be from 1 to 1000");
}

void ValidateCamera(const AutocollimatorParameters& p) {
  Require(std::isfinite(p.roll_rad), "roll_rad must be finite");
  Require(IsPositive(p.pixel_pitch_m), "pixel_pitch_m must be positive");
  // From 1 / (2 pi) on the read position would run backwards within a pixel.
  Require(std::abs(p.interpolation_error_px) < 0.5 * std::numbers::inv_pi,
          "interpolation_error_px must be below 1 / (2 pi)");
  Require(IsPositive(p.half_field_rad), "half_field_rad must be set and positive");
  Require(p.low_light_fraction >= 0.0 && p.low_light_fraction <= 1.0,
          "low_light_fraction must be set, from 0 to 1");
}

/// The light of a reticle on the axis as it leaves the objective: parallel but for the defocus.
RayBatch CollimatedBeam(const AutocollimatorParameters& p) {
  const double slope_per_m = 1.0 / (p.focal_length_m + p.defocus_m) - 1.0 / p.focal_length_m;
  RayBatch beam;
  for (const Eigen::Vector2d& at : EqualAreaDisc(p.aperture_radius_m, p.pupil_rings)) {
    const Eigen::Vector2d slope = slope_per_m * at;
    beam.Add({{at.x(), at.y(), 0.0}, Eigen::Vector3d(slope.x(), slope.y(), 1.0).normalized()});
  }
  return beam;
}

/// What finding the centre between pixels does to one coordinate.
double Interpolated(const AutocollimatorParameters& p, double u_m) {
  const double phase = 2.0 * std::numbers::pi * u_m / p.pixel_pitch_m;
  return u_m + p.interpolation_error_px * p.pixel_pitch_m * std::sin(phase);
}

/// Angles that the instrument shows for an image at `image_m` (x to the right, y up).
Eigen::Vector2d Reading(const AutocollimatorParameters& p, const Eigen::Vector2d& image_m) {
  const Eigen::Vector2d on_camera = Eigen::Rotation2Dd(-p.roll_rad) * image_m;
  const Eigen::Vector2d read_m(Interpolated(p, on_camera.x()), Interpolated(p, on_camera.y()));
  return read_m / (2.0 * p.nominal_focal_length_m);
}

}  // namespace

AutocollimatorOptics::AutocollimatorOptics(const AutocollimatorParameters& parameters, const Surface& mirror)
    : parameters_(parameters), X_MS_(mirror.X_WS) {
  Require(IsPose(parameters_.X_LA), "X_LA must be a right-handed rotation and a finite translation");
  ValidateLens(parameters_);
  ValidateCamera(parameters_);
  scene_.AddSurface(mirror);
  const double reach_m = Reach(parameters_.aperture_radius_m, parameters_.pupil_rings);
  scene_.AddSurface(CircularPlane(Eigen::Isometry3d::Identity(), reach_m));
  outgoing_ = CollimatedBeam(parameters_);
}

void AutocollimatorOptics::Intersect(const RayBatch& rays) {
  if (parameters_.fidelity == Fidelity::kTraced) {
    scene_.Intersect(rays, hits_);
  } else {
    scene_.IntersectAnalytic(rays, hits_);
  }
}

AutocollimatorImage AutocollimatorOptics::ReadCamera() const {
  const AutocollimatorParameters& p = parameters_;
  const ImagingLens lens{p.focal_length_m, p.defocus_m, p.distortion_per_rad2,
                         EdgeOfDisc(p.aperture_radius_m, p.pupil_rings)};
  const CameraSums sums = SumOnCamera(lens, kObjective, returning_, hits_);
  AutocollimatorImage image;
  image.returned_fraction = sums.light / static_cast<double>(outgoing_.size());
  if (!(sums.light > 0.0) || image.returned_fraction < p.low_light_fraction) return image;
  const Eigen::Vector2d reading = Reading(p, Eigen::Vector2d(sums.x_m, sums.y_m) / sums.light);
  image.status = AutocollimatorStatus::kOutOfRange;
  if (reading.cwiseAbs().maxCoeff() > p.half_field_rad) return image;
  image.status = AutocollimatorStatus::kOk;
  image.x_rad = reading.x();
  image.y_rad = reading.y();
  return image;
}

AutocollimatorImage AutocollimatorOptics::Look(const Eigen::Isometry3d& X_LM) {
  Require(IsPose(X_LM), "X_LM must be a right-handed rotation and a finite translation");
  scene_.SetSurfacePose(kMirror, parameters_.X_LA.inverse() * X_LM * X_MS_);
  if (parameters_.fidelity == Fidelity::kTraced) scene_.Commit();
  Intersect(outgoing_);
  ReflectFrom(MakeFrame(scene_.surfaces()[kMirror]), kMirror, outgoing_, hits_, returning_);
  Intersect(returning_);
  return ReadCamera();
}

}  // namespace twinbench::optics
