#include "twin/sim/world.h"

#include "twin/core/device_fault.h"

namespace twinbench::sim {

using mechanics::Axis;

World::World(const Scenario& nominal)
    : effects_(nominal),
      actual_(effects_.ActualBench(nominal)),
      environment_(actual_.environment, actual_.seed),
      axes_(actual_, queue_),
      stand_(actual_),
      light_(actual_, nominal.laser.wavelength_m),
      electronics_(actual_, effects_.Sampling()) {}

void World::StartMove(Axis axis, double to_rad) {
  if (!axes_.StartMove(axis, to_rad)) return;
  axis == Axis::kTarget ? stand_.BeginTargetStop() : stand_.BeginReferenceStop();
}

TableState World::StateOf(Axis axis) {
  const mechanics::StackState axes = axes_.Look();
  TableState state;
  state.commanded_rad = axes_.Commanded_rad(axis);
  state.encoder_rad = axis == Axis::kTarget ? axes.target_encoder_rad : axes.reference_encoder_rad;
  state.moving = axes_.Moving(axis);
  state.in_position = axes_.InPosition(axis);
  return state;
}

void World::Mount(int setup, double clamp_rad, double reseat_rad) {
  if (!axes_.AtRest())
    throw DeviceFault(FaultKind::kRefused, "fixture", "nothing can be mounted while a table moves");
  const bool reseats = actual_.procedure.clamping == "reseat";
  axes_.Mount(stand_.Mount(effects_.Actual({clamp_rad, reseat_rad, reseats})));
  mounted_ = queue_.Now();
  setup_ = setup;
}

Moment World::Look(const mechanics::StackState& axes) {
  Moment moment;
  moment.now = queue_.Now();
  moment.mounted = mounted_;
  moment.arrived = axes_.LastArrival();
  moment.temperature_K = environment_.AboveReference_K(moment.now);
  moment.target_rad = axes.target_rad;
  moment.reference_rad = axes.reference_rad;
  moment.target_direction = axes_.Direction(Axis::kTarget);
  moment.reference_direction = axes_.Direction(Axis::kReference);
  moment.setup = setup_;
  moment.reading = next_reading_;
  effects_.Advance(moment);
  return moment;
}

Pose World::GratingPose(const Moment& moment, const mechanics::StackState& axes) const {
  std::array<double, 2> labels_rad = {moment.target_rad, moment.reference_rad};
  effects_.AlterLabels(labels_rad[0], labels_rad[1]);
  return stand_.GratingPose(moment, effects_.Pose(moment), labels_rad,
                            {axes.target_bearing, axes.reference_bearing});
}

Pose World::GratingPose() {
  const mechanics::StackState axes = axes_.Look();
  return GratingPose(Look(axes), axes);
}

LightState World::LookAtLight(const Moment& moment) const {
  LightState light = light_.Nominal(moment.temperature_K);
  effects_.AlterLight(moment, light);
  return light;
}

void World::WriteIrradiance(const std::string& path) {
  const mechanics::StackState axes = axes_.Look();
  const Moment moment = Look(axes);
  light_.WriteIrradiance(path, GratingPose(moment, axes), LookAtLight(moment));
}

Acquisition World::Acquire(int n_samples, bool keep_raw) {
  const mechanics::StackState axes = axes_.Look();
  const Moment moment = Look(axes);
  const Spots spots = light_.Trace(GratingPose(moment, axes), LookAtLight(moment));

  Acquisition block;
  if (spots.status == ReadingStatus::kOk) {
    std::array<double, kChannels> signal_V = electronics_.Amplify(spots.uv_m);
    effects_.AlterSignal(moment, signal_V);
    block = electronics_.Convert(signal_V, moment.now, next_reading_, n_samples, keep_raw);
    effects_.AlterReadout(block);
  } else {
    block.start = moment.now;
    block.status = spots.status;
  }
  ++next_reading_;
  queue_.RunUntil(moment.now + electronics_.BlockTime(n_samples));
  return block;
}

}  // namespace twinbench::sim
