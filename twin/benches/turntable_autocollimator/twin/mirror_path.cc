#include "twin/benches/turntable_autocollimator/twin/mirror_path.h"

#include <algorithm>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/sim/actual_bench.h"

namespace twinbench::sim {
namespace {

std::vector<std::unique_ptr<TurntableEffect>> TurntableEffectsOf(const Scenario& nominal) {
  std::vector<std::unique_ptr<TurntableEffect>> effects;
  for (const EffectSettings& effect : BeyondKeys(nominal)) effects.push_back(MakeTurntableEffect(effect, nominal));
  return effects;
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

optics::AutocollimatorOptics OpticsOf(const Scenario& actual, double field_share, optics::Fidelity fidelity) {
  const CollimatorSettings& c = TurntableOf(actual).collimator;
  const double range_rad = TurntableOf(actual).autocollimator.range_rad;
  optics::AutocollimatorParameters p;
  p.fidelity = fidelity;
  p.X_LA = AutocollimatorPose(c.distance_m);
  p.nominal_focal_length_m = c.focal_length_m;
  p.focal_length_m = c.focal_length_m * (1.0 + TurntableOf(actual).autocollimator.gain_error);
  p.aperture_radius_m = 0.5 * c.aperture_m;
  // At the edge the field angle is twice the mirror's: error = range * distortion * (2 range)^2.
  p.distortion_per_rad2 = c.error_at_edge_rad / (4.0 * range_rad * range_rad * range_rad);
  p.roll_rad = c.roll_rad;
  p.pixel_pitch_m = c.pixel_pitch_m;
  p.interpolation_error_px = c.interpolation_error_px;
  p.half_field_rad = field_share * range_rad;
  constexpr double kLowLight = 0.2;  // of the light: a camera's exposure has no more room
  p.low_light_fraction = kLowLight;
  const MirrorSettings& m = TurntableOf(actual).mirror;
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

void SilenceTurntable(TurntableSettings& own) {
  own.autocollimator.noise_rad = 0.0;
  own.encoder.noise_rad = 0.0;
  Silence(own.turntable);
  Silence(own.multitooth_table);
}

}  // namespace

optics::AutocollimatorImage ImagesOnce::Of(int reading, const Key& key,
                                           const std::function<optics::AutocollimatorImage()>& look) {
  constexpr std::size_t kMost = 6;
  const std::scoped_lock lock(mutex_);
  auto& seen = seen_[reading];
  const auto found = std::ranges::find(seen, key, &std::pair<Key, optics::AutocollimatorImage>::first);
  if (found != seen.end()) {
    seen.splice(seen.begin(), seen, found);
  } else {
    seen.emplace_front(key, look());
    if (seen.size() > kMost) seen.pop_back();
  }
  return seen.front().second;
}

MirrorPath::MirrorPath(const Scenario& nominal, double field_share, optics::Fidelity fidelity,
                       std::shared_ptr<ImagesOnce> images)
    : effects_(TurntableEffectsOf(nominal)),
      actual_(ActualBenchOf(nominal, effects_, SilenceTurntable)),
      stand_(actual_),
      optics_(OpticsOf(actual_, field_share, fidelity)),
      empirical_x_(actual_.empiricals, "x"),
      empirical_y_(actual_.empiricals, "y"),
      images_(std::move(images)) {}

optics::AutocollimatorImage MirrorPath::See(int reading, const Pose& X_LM) {
  if (!images_) return optics_.Look(X_LM);
  const CollimatorSettings& c = TurntableOf(actual_).collimator;
  const AutocollimatorSettings& a = TurntableOf(actual_).autocollimator;
  const MirrorSettings& m = TurntableOf(actual_).mirror;
  ImagesOnce::Key key;
  key << X_LM.matrix().topRows<3>().reshaped(), c.distance_m, c.focal_length_m, c.aperture_m, c.error_at_edge_rad,
      c.roll_rad, c.pixel_pitch_m, c.interpolation_error_px, a.range_rad, a.gain_error, m.width_m, m.height_m,
      m.flatness_m, m.radius_m;
  return images_->Of(reading, key, [&] { return optics_.Look(X_LM); });
}

Eigen::Vector2d MirrorPath::Zero_rad(double above_K) const {
  const CollimatorSettings& c = TurntableOf(actual_).collimator;
  return above_K * Eigen::Vector2d(c.x_per_kelvin_rad, c.y_per_kelvin_rad);
}

AutocollimatorReading MirrorPath::Look(TurntableMoment moment, const mechanics::StackState& axes, double above_K,
                                       const Eigen::Vector2d& noise_rad, const TurntableExtra& extra) {
  moment.turntable_rad = axes.target_rad;
  moment.multitooth_rad = stand_.Seated_rad();
  moment.above_K = above_K;
  double yaw_rad = extra.yaw_rad;
  for (const auto& effect : effects_) yaw_rad += effect->Yaw_rad(moment);
  const auto image =
      See(moment.reading, stand_.MirrorPose(axes.target_rad, yaw_rad, axes.target_bearing, extra.mirror));
  if (image.status != optics::AutocollimatorStatus::kOk) return {kNaN, kNaN, StatusOf(image.status)};
  const Eigen::Vector2d seen_rad = Eigen::Vector2d(image.x_rad, image.y_rad) + Zero_rad(above_K + extra.warmer_K);
  const double now_s = ToSeconds(moment.now);
  const Eigen::Vector2d empirical_rad(empirical_x_.At(moment.reading, now_s),
                                      empirical_y_.At(moment.reading, now_s));
  Eigen::Vector2d shown_rad = seen_rad + noise_rad + empirical_rad + extra.shown_rad;
  for (const auto& effect : effects_) shown_rad += effect->ReadingError_rad(moment, seen_rad);
  return {shown_rad.x(), shown_rad.y(), ReadingStatus::kOk};
}

}  // namespace twinbench::sim
