#include "twin/benches/turntable_autocollimator/twin/world.h"

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/table_stack.h"
#include "twin/core/device_fault.h"

namespace twinbench::sim {
namespace {

using mechanics::Axis;

}  // namespace

TurntableWorld::TurntableWorld(const Scenario& nominal)
    : path_(nominal),
      environment_(actual().environment, actual().RunSeed()),
      axes_(StackOfBench(actual()), queue_),
      noise_(actual().RunSeed(), "autocollimator.noise") {}

void TurntableWorld::StartMove(double to_rad) {
  if (axes_.StartMove(Axis::kTarget, to_rad)) path_.stand().BeginTurntableStop();
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
  queue_.RunUntil(queue_.Now() + FromSeconds(TurntableOf(actual()).multitooth.index_time_s));
  path_.stand().Seat(tooth);
}

void TurntableWorld::Mount(int setup, double tilt_rad, double azimuth_rad, double eccentricity_m, int shift_teeth) {
  if (!axes_.ComeToRest())
    throw DeviceFault(FaultKind::kRefused, "fixture", "nothing can be mounted while the turntable moves");
  const double shift_rad = shift_teeth * 2.0 * units::kPi / TurntableOf(actual()).multitooth.teeth;
  path_.stand().Mount(tilt_rad, azimuth_rad, eccentricity_m, shift_rad);
  path_.stand().Seat(shift_teeth);
  mounted_ = queue_.Now();
  setup_ = setup;
}

TurntableMoment TurntableWorld::Moment(int reading) {
  return {queue_.Now(), mounted_, axes_.LastArrival(), setup_, reading, axes_.Direction(Axis::kTarget)};
}

Eigen::Vector2d TurntableWorld::Noise_rad() {
  const double noise_rad = TurntableOf(actual()).autocollimator.noise_rad;
  if (noise_rad == 0.0) return Eigen::Vector2d::Zero();
  const double x_rad = noise_rad * noise_.Normal();
  return {x_rad, noise_rad * noise_.Normal()};
}

AutocollimatorReading TurntableWorld::Look() {
  const TurntableMoment moment = Moment(next_reading_++);
  return path_.Look(moment, axes_.Look(), environment_.AboveReference_K(moment.now), Noise_rad());
}

}  // namespace twinbench::sim
