#include "twin/benches/turntable_autocollimator/twin/world.h"

#include <cmath>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/table_stack.h"
#include "twin/core/device_fault.h"

namespace twinbench::sim {
namespace {

using mechanics::Axis;

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
      axes_(TurntableStack(actual()), queue_),
      noise_(actual().RunSeed(), "autocollimator.noise"),
      null_noise_(actual().RunSeed(), "autocollimator.null"),
      encoder_noise_(actual().RunSeed(), "encoder.noise") {}

void TurntableWorld::StartMove(double to_rad) {
  if (axes_.StartMove(Axis::kTarget, to_rad)) path_.stand().BeginTurntableStop();
}

/// Drawn once a reading, however often the encoder is looked at.
double TurntableWorld::EncoderNoise_rad() {
  const double noise_rad = TurntableOf(actual()).encoder.noise_rad;
  if (noise_rad == 0.0) return 0.0;
  for (; encoder_noises_ <= next_reading_; ++encoder_noises_) encoder_noise_rad_ = noise_rad * encoder_noise_.Normal();
  return encoder_noise_rad_;
}

AxisState TurntableWorld::TurntableState() {
  AxisState state;
  state.commanded = axes_.Commanded_rad(Axis::kTarget);
  state.encoder =
      Rounded(axes_.Look().target_encoder_rad + EncoderNoise_rad(), TurntableOf(actual()).encoder.step_rad);
  state.moving = axes_.Moving(Axis::kTarget);
  state.in_position = axes_.InPosition(Axis::kTarget);
  return state;
}

void TurntableWorld::IndexTo(int tooth) {
  queue_.RunUntil(queue_.Now() + FromSeconds(TurntableOf(actual()).multitooth.index_time_s));
  path_.stand().Seat(tooth);
}

void TurntableWorld::Mount(int setup) {
  if (!axes_.ComeToRest())
    throw DeviceFault(FaultKind::kRefused, "fixture", "nothing can be mounted while the turntable moves");
  const TurntableSettings& own = TurntableOf(actual());
  const TurntableProcedureSettings& s = own.turntable_procedure;
  const int shift_teeth = s.Of(s.shifts, setup);
  const double shift_rad = own.HasPolygon() ? own.FaceAngle_rad(setup, 0) : shift_teeth * own.Pitch_rad();
  path_.stand().Mount(s.Of(s.tilts_rad, setup), s.Of(s.tilt_azimuths_rad, setup), s.Of(s.eccentricities_m, setup),
                      shift_rad);
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

AutocollimatorReading TurntableWorld::Shown(Stream& noise, double noise_rad) {
  SeatFace();
  const TurntableMoment moment = Moment(next_reading_);
  return path_.Look(moment, axes_.Look(), environment_.AboveReference_K(moment.now), Noise_rad(noise, noise_rad));
}

/// The mean of its frames is what is seen in the middle of them.
AutocollimatorReading TurntableWorld::Look() {
  const Duration half = TurntableOf(actual()).collimator.HalfReading();
  queue_.RunUntil(queue_.Now() + half);
  read_at_ = queue_.Now();
  const AutocollimatorReading shown = Shown(noise_, TurntableOf(actual()).ReadingNoise_rad());
  queue_.RunUntil(queue_.Now() + half);
  ++next_reading_;
  return shown;
}

AutocollimatorReading TurntableWorld::LookOnTheWay() {
  return Shown(null_noise_, TurntableOf(actual()).autocollimator.noise_rad);
}

}  // namespace twinbench::sim
