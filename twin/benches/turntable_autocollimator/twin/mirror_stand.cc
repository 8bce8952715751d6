#include "twin/benches/turntable_autocollimator/twin/mirror_stand.h"

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/stream.h"

namespace twinbench::sim {
namespace {

Pose Turned(const Matrix3& rotation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  return pose;
}

/// Normal of the mirror along y, y_M along z.
Pose FacingAlongY(double radius_m) {
  Pose pose = Pose::Identity();
  pose.linear().col(0) = -Vector3::UnitX();
  pose.linear().col(1) = Vector3::UnitZ();
  pose.linear().col(2) = Vector3::UnitY();
  pose.translation() = radius_m * Vector3::UnitY();
  return pose;
}

/// Face f is tooth -f.
std::vector<double> FaceErrors(const PolygonSettings& settings, std::uint64_t seed) {
  Stream stream(seed, "polygon.faces");
  const auto faces = static_cast<std::size_t>(settings.faces);
  std::vector<double> errors_rad(faces);
  for (std::size_t face = 0; face < faces; ++face) {
    errors_rad[(faces - face) % faces] =
        TurntableProcedureSettings::Of(settings.face_errors_rad, static_cast<int>(face)) +
        settings.face_rms_rad * stream.Normal();
  }
  return errors_rad;
}

std::vector<double> Pyramid(const PolygonSettings& settings, std::uint64_t seed) {
  Stream stream(seed, "polygon.pyramid");
  std::vector<double> tilts_rad(static_cast<std::size_t>(settings.faces));
  for (double& tilt_rad : tilts_rad) tilt_rad = settings.pyramid_rms_rad * stream.Normal();
  return tilts_rad;
}

/// A polygon is one body: it has no errors but its faces'.
const TableSettings& SettingsOfUpper(const TurntableSettings& own) {
  static const TableSettings rigid;
  return own.HasPolygon() ? rigid : own.multitooth_table;
}

std::vector<double> ToothErrors(const MultitoothSettings& settings, std::uint64_t seed) {
  std::vector<double> errors_rad(static_cast<std::size_t>(settings.teeth), 0.0);
  if (settings.tooth_rms_rad == 0.0) return errors_rad;
  Stream stream(seed, "multitooth.teeth");
  for (double& error_rad : errors_rad) error_rad = settings.tooth_rms_rad * stream.Normal();
  return errors_rad;
}

}  // namespace

MirrorStand::MirrorStand(const Scenario& actual)
    : turntable_(TurntableOf(actual).turntable, actual, "turntable"),
      multitooth_(SettingsOfUpper(TurntableOf(actual)), actual, "multitooth"),
      tooth_rad_(TurntableOf(actual).HasPolygon() ? FaceErrors(TurntableOf(actual).polygon, actual.seed)
                                                  : ToothErrors(TurntableOf(actual).multitooth, actual.seed)),
      pyramid_rad_(Pyramid(TurntableOf(actual).polygon, actual.seed)),
      pitch_rad_(TurntableOf(actual).Pitch_rad()),
      mirror_radius_m_(TurntableOf(actual).mirror.radius_m) {}

void MirrorStand::Mount(double tilt_rad, double azimuth_rad, double eccentricity_m, double shift_rad) {
  const Vector3 towards(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
  X_TB_ = Pose::Identity();
  X_TB_.linear() = Eigen::AngleAxisd(tilt_rad, Vector3::UnitZ().cross(towards)).toRotationMatrix();
  X_TB_.translation() = eccentricity_m * towards;
  shift_rad_ = shift_rad;
  turntable_seat_ = turntable_.DrawSeating();
  X_RS_ = Turned(mechanics::RotationZ(-shift_rad)) * mechanics::ToPose(multitooth_.DrawSeating());
}

void MirrorStand::Seat(int tooth) {
  tooth_ = tooth;
  multitooth_.BeginStop();
}

void MirrorStand::SeatFace(double turntable_rad) {
  tooth_ = static_cast<int>(std::lround((shift_rad_ - turntable_rad) / pitch_rad_));
}

int MirrorStand::Wrapped(int tooth) const {
  const int teeth = static_cast<int>(tooth_rad_.size());
  return ((tooth % teeth) + teeth) % teeth;
}

Pose MirrorStand::MirrorPose(double turntable_rad, double yaw_rad, const mechanics::BearingPose& bearing,
                             const MirrorExtra& extra) const {
  const double multitooth_rad = tooth_ * pitch_rad_;
  mechanics::PoseError tooth_error = multitooth_.At(multitooth_rad) + extra.multitooth;
  tooth_error.ez_rad += tooth_rad_[static_cast<std::size_t>(Wrapped(tooth_))];
  const mechanics::PoseError turntable_error = turntable_.At(turntable_rad) + turntable_seat_ + extra.turntable;
  mechanics::PoseError mount = extra.mount;
  if (!pyramid_rad_.empty()) mount.ex_rad += pyramid_rad_[static_cast<std::size_t>(Wrapped(tooth_))];
  const Pose X_RM = X_RS_ * mechanics::ToPose(mount) * FacingAlongY(mirror_radius_m_);
  return mechanics::ToPose(bearing) * mechanics::ToPose(turntable_error) *
         Turned(mechanics::RotationZ(turntable_rad + yaw_rad)) * X_TB_ * mechanics::ToPose(extra.axis) *
         Turned(mechanics::RotationZ(multitooth_rad)) * mechanics::ToPose(tooth_error) * X_RM;
}

TableErrors MirrorStand::MultitoothErrors() const {
  TableErrors errors = multitooth_.Repeatable(static_cast<int>(tooth_rad_.size()));
  for (std::size_t k = 0; k < tooth_rad_.size(); ++k) errors[Component::kEz][k] += tooth_rad_[k];
  return errors;
}

}  // namespace twinbench::sim
