#include "twin/sim/turntable/world.h"

#include "twin/core/device_fault.h"
#include "twin/sim/silence.h"

namespace twinbench::sim {
namespace {

using mechanics::Axis;

std::vector<std::unique_ptr<TurntableEffect>> TurntableEffectsOf(const Scenario& nominal) {
  std::vector<std::unique_ptr<TurntableEffect>> effects;
  for (const EffectSettings& effect : nominal.effects) effects.push_back(MakeTurntableEffect(effect, nominal));
  return effects;
}

Scenario ActualBench(const Scenario& nominal, const std::vector<std::unique_ptr<TurntableEffect>>& effects) {
  Scenario actual = nominal;
  for (const auto& effect : effects) effect->AlterBench(actual);
  if (actual.noise_free) Silence(actual);
  return actual;
}

/// Looks along -y of L, up is up.
Pose AutocollimatorPose(double distance_m) {
  Pose X_LA = Pose::Identity();
  X_LA.linear().col(0) = Vector3::UnitX();
  X_LA.linear().col(1) = Vector3::UnitZ();
  X_LA.linear().col(2) = -Vector3::UnitY();
  X_LA.translation() = distance_m * Vector3::UnitY();
  return X_LA;
}

optics::AutocollimatorOptics OpticsOf(const Scenario& actual) {
  const CollimatorSettings& c = actual.collimator;
  const double range_rad = actual.autocollimator.range_rad;
  optics::AutocollimatorParameters p;
  p.X_LA = AutocollimatorPose(c.distance_m);
  p.nominal_focal_length_m = c.focal_length_m;
  p.focal_length_m = c.focal_length_m * (1.0 + actual.autocollimator.gain_error);
  p.aperture_radius_m = 0.5 * c.aperture_m;
  // At the edge the field angle is twice the mirror's: error = range * distortion * (2 range)^2.
  p.distortion_per_rad2 = c.error_at_edge_rad / (4.0 * range_rad * range_rad * range_rad);
  p.roll_rad = c.roll_rad;
  p.pixel_pitch_m = c.pixel_pitch_m;
  p.interpolation_error_px = c.interpolation_error_px;
  p.half_field_rad = range_rad;
  constexpr double kLowLight = 0.2;  // of the light: a camera's exposure has no more room
  p.low_light_fraction = kLowLight;
  const MirrorSettings& m = actual.mirror;
  optics::Surface mirror;
  mirror.half_x_m = 0.5 * m.width_m;
  mirror.half_y_m = 0.5 * m.height_m;
  mirror.curvature_per_m = 8.0 * m.flatness_m / (m.width_m * m.width_m);
  mirror.conic = -1.0;
  return {p, mirror};
}

ReadingStatus StatusOf(optics::AutocollimatorStatus status) {
  switch (status) {
    case optics::AutocollimatorStatus::kOk:
      return ReadingStatus::kOk;
    case optics::AutocollimatorStatus::kOutOfRange:
      return ReadingStatus::kClippedSpot;
    case optics::AutocollimatorStatus::kNoLight:
      return ReadingStatus::kNoLight;
  }
  return ReadingStatus::kMissing;
}

}  // namespace

TurntableWorld::TurntableWorld(const Scenario& nominal)
    : effects_(TurntableEffectsOf(nominal)),
      actual_(ActualBench(nominal, effects_)),
      environment_(actual_.environment, actual_.seed),
      axes_(actual_, queue_),
      stand_(actual_),
      optics_(OpticsOf(actual_)),
      noise_(actual_.seed, "autocollimator.noise"),
      empirical_x_(actual_.empiricals, "x"),
      empirical_y_(actual_.empiricals, "y") {}

void TurntableWorld::StartMove(double to_rad) {
  if (axes_.StartMove(Axis::kTarget, to_rad)) stand_.BeginTurntableStop();
}

TableState TurntableWorld::TurntableState() {
  TableState state;
  state.commanded_rad = axes_.Commanded_rad(Axis::kTarget);
  state.encoder_rad = axes_.Look().target_encoder_rad;
  state.moving = axes_.Moving(Axis::kTarget);
  state.in_position = axes_.InPosition(Axis::kTarget);
  return state;
}

void TurntableWorld::IndexTo(int tooth) {
  queue_.RunUntil(queue_.Now() + FromSeconds(actual_.multitooth.index_time_s));
  stand_.Seat(tooth);
}

void TurntableWorld::Mount(int setup, double tilt_rad, double azimuth_rad, double eccentricity_m, int shift_teeth) {
  if (!axes_.AtRest())
    throw DeviceFault(FaultKind::kRefused, "fixture", "nothing can be mounted while the turntable moves");
  const double shift_rad = shift_teeth * 2.0 * units::kPi / actual_.multitooth.teeth;
  stand_.Mount(tilt_rad, azimuth_rad, eccentricity_m, shift_rad);
  stand_.Seat(shift_teeth);
  mounted_ = queue_.Now();
  setup_ = setup;
}

TurntableMoment TurntableWorld::Moment(int reading) {
  return {queue_.Now(), mounted_, axes_.LastArrival(), setup_, reading, axes_.Direction(Axis::kTarget)};
}

Eigen::Vector2d TurntableWorld::Zero_rad() {
  const CollimatorSettings& c = actual_.collimator;
  return environment_.AboveReference_K(queue_.Now()) * Eigen::Vector2d(c.x_per_kelvin_rad, c.y_per_kelvin_rad);
}

Eigen::Vector2d TurntableWorld::Noise_rad() {
  const double noise_rad = actual_.autocollimator.noise_rad;
  if (noise_rad == 0.0) return Eigen::Vector2d::Zero();
  const double x_rad = noise_rad * noise_.Normal();
  return {x_rad, noise_rad * noise_.Normal()};
}

AutocollimatorReading TurntableWorld::Look() {
  const TurntableMoment moment = Moment(next_reading_++);
  const mechanics::StackState axes = axes_.Look();
  double yaw_rad = 0.0;
  for (const auto& effect : effects_) yaw_rad += effect->Yaw_rad(moment);
  const Eigen::Vector2d noise_rad = Noise_rad();  // drawn whether the image is there or not
  const auto image = optics_.Look(stand_.MirrorPose(axes.target_rad, yaw_rad, axes.target_bearing));
  if (image.status != optics::AutocollimatorStatus::kOk) return {kNaN, kNaN, StatusOf(image.status)};
  const Eigen::Vector2d seen_rad = Eigen::Vector2d(image.x_rad, image.y_rad) + Zero_rad();
  const Eigen::Vector2d empirical_rad(empirical_x_.At_rad(moment.reading), empirical_y_.At_rad(moment.reading));
  Eigen::Vector2d shown_rad = seen_rad + noise_rad + empirical_rad;
  for (const auto& effect : effects_) shown_rad += effect->ReadingError_rad(moment, seen_rad);
  return {shown_rad.x(), shown_rad.y(), ReadingStatus::kOk};
}

}  // namespace twinbench::sim
