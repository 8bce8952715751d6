#include "twin/benches/turntable_autocollimator/twin/world.h"

#include <cmath>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/table_stack.h"
#include "twin/core/device_fault.h"

namespace twinbench::sim {
namespace {

using mechanics::Axis;

constexpr Duration kPatience = std::chrono::seconds(60);

double Rounded(double value, double step) {
  return step > 0.0 ? std::round(value / step) * step : value;
}

Eigen::Vector2d Noise_rad(Stream& stream, double noise_rad) {
  if (noise_rad == 0.0) return Eigen::Vector2d::Zero();
  const double x_rad = noise_rad * stream.Normal();
  return {x_rad, noise_rad * stream.Normal()};
}

}  // namespace

TurntableWorld::TurntableWorld(const Scenario& nominal)
    : path_(nominal),
      environment_(actual().environment, actual().RunSeed()),
      axes_(StackOfBench(actual()), queue_),
      noise_(actual().RunSeed(), "autocollimator.noise"),
      null_noise_(actual().RunSeed(), "autocollimator.null"),
      encoder_noise_(actual().RunSeed(), "encoder.noise") {}

void TurntableWorld::StartMove(double to_rad) {
  if (axes_.StartMove(Axis::kTarget, to_rad)) path_.stand().BeginTurntableStop();
}

TableState TurntableWorld::TurntableState() {
  TableState state;
  state.commanded_rad = axes_.Commanded_rad(Axis::kTarget);
  const TurntableEncoderSettings& encoder = TurntableOf(actual()).encoder;
  double noise_rad = 0.0;
  if (encoder.noise_rad > 0.0) noise_rad = encoder.noise_rad * encoder_noise_.Normal();
  state.encoder_rad = Rounded(axes_.Look().target_encoder_rad + noise_rad, encoder.step_rad);
  state.moving = axes_.Moving(Axis::kTarget);
  state.in_position = axes_.InPosition(Axis::kTarget);
  return state;
}

void TurntableWorld::IndexTo(int tooth) {
  queue_.RunUntil(queue_.Now() + FromSeconds(TurntableOf(actual()).multitooth.index_time_s));
  path_.stand().Seat(tooth);
}

void TurntableWorld::Mount(int setup, double tilt_rad, double azimuth_rad, double eccentricity_m, int shift_teeth) {
  if (!axes_.ComeToRest())
    throw DeviceFault(FaultKind::kRefused, "fixture", "nothing can be mounted while the turntable moves");
  const TurntableSettings& own = TurntableOf(actual());
  const double shift_rad = own.HasPolygon() ? own.FaceAngle_rad(setup, 0) : shift_teeth * own.Pitch_rad();
  path_.stand().Mount(tilt_rad, azimuth_rad, eccentricity_m, shift_rad);
  path_.stand().Seat(shift_teeth);
  mounted_ = queue_.Now();
  setup_ = setup;
}

TurntableMoment TurntableWorld::Moment(int reading) {
  return {queue_.Now(), mounted_, axes_.LastArrival(), setup_, reading, axes_.Direction(Axis::kTarget)};
}

void TurntableWorld::SeatFace() {
  if (TurntableOf(actual()).HasPolygon()) path_.stand().SeatFace(axes_.Look().target_rad);
}

AutocollimatorReading TurntableWorld::Shown(Stream& noise) {
  SeatFace();
  const TurntableMoment moment = Moment(next_reading_);
  return path_.Look(moment, axes_.Look(), environment_.AboveReference_K(moment.now),
                    Noise_rad(noise, TurntableOf(actual()).autocollimator.noise_rad));
}

AutocollimatorReading TurntableWorld::Look() {
  const AutocollimatorReading shown = Shown(noise_);
  ++next_reading_;
  return shown;
}

bool TurntableWorld::Turn(double to_rad) {
  StartMove(to_rad);
  return axes_.Settles(Axis::kTarget, kPatience);
}

bool TurntableWorld::Null(int direction) {
  constexpr int kMostMoves = 6;  // a table that comes back no better than the deadband is not chased for ever
  constexpr double kFromBehind_rad = 60.0 * units::arcsec;
  for (int moves = 0;; ++moves) {
    const AutocollimatorReading shown = Shown(null_noise_);
    if (shown.status != ReadingStatus::kOk) return false;
    if (std::abs(shown.yaw_rad) <= TurntableOf(actual()).collimator.deadband_rad) return true;
    if (moves == kMostMoves) return false;
    const double to_rad = axes_.Commanded_rad(Axis::kTarget) - shown.yaw_rad;
    if (direction * shown.yaw_rad > 0.0 && !Turn(to_rad - direction * kFromBehind_rad)) return false;
    if (!Turn(to_rad)) return false;
  }
}

}  // namespace twinbench::sim
