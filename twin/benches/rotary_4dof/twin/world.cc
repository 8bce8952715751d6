#include "twin/benches/rotary_4dof/twin/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/table_stack.h"
#include "twin/core/device_fault.h"

namespace twinbench::sim {

using mechanics::Axis;

World::World(const Scenario& nominal)
    : path_(nominal),
      environment_(actual().environment, actual().RunSeed()),
      air_(RotaryOf(actual()), actual().RunSeed()),
      axes_(RotaryTableStack(actual()), queue_) {}

void World::StartMove(Axis axis, double to_rad) {
  if (!axes_.StartMove(axis, to_rad)) return;
  axis == Axis::kTarget ? path_.stand().BeginTargetStop() : path_.stand().BeginReferenceStop();
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
  if (!axes_.ComeToRest())
    throw DeviceFault(FaultKind::kRefused, "fixture", "nothing can be mounted while a table moves");
  const bool reseats = RotaryOf(actual()).procedure.clamping == "reseat";
  axes_.Mount(path_.stand().Mount(path_.effects().Actual({clamp_rad, reseat_rad, reseats})));
  fixture_.Now([&] {
    mounted_ = queue_.Now();
    setup_ = setup;
  });
}

Moment World::Look(const mechanics::StackState& axes) {
  Moment moment;
  moment.now = queue_.Now();
  moment.mounted = mounted_;
  moment.departed = {axes_.Departure(Axis::kTarget), axes_.Departure(Axis::kReference)};
  moment.travelled_rad = {axes_.Travelled_rad(Axis::kTarget), axes_.Travelled_rad(Axis::kReference)};
  moment.arrived = axes_.LastArrival();
  moment.temperature_K = environment_.AboveReference_K(moment.now);
  moment.target_rad = axes.target_rad;
  moment.reference_rad = axes.reference_rad;
  moment.target_direction = axes_.Direction(Axis::kTarget);
  moment.reference_direction = axes_.Direction(Axis::kReference);
  moment.setup = setup_;
  moment.reading = next_reading_;
  path_.effects().Advance(moment);
  return moment;
}

Pose World::GratingPose() {
  const mechanics::StackState axes = axes_.Look();
  return path_.GratingPose(Look(axes), axes);
}

void World::WriteIrradiance(const std::string& path) {
  const mechanics::StackState axes = axes_.Look();
  const Moment moment = Look(axes);
  path_.light().WriteIrradiance(path, path_.GratingPose(moment, axes), path_.LightAt(moment));
}

/// Period or time constant of the fastest thing that may go on during a block.
double World::Shortest_s() {
  return std::min(
      {path_.effects().Shortest_s(), path_.electronics().Shortest_s(), air_.Shortest_s(), axes_.Shortest_s()});
}

/// Where the light falls behind moving air.
Spots World::SpotsNow(const Moment& moment, const mechanics::StackState& axes) {
  LightState light = path_.LightAt(moment);
  air_.Turn(moment.now, light);
  Spots spots = path_.light().Trace(path_.GratingPose(moment, axes), light);
  air_.Move(moment.now, spots);
  return spots;
}

BlockCourse::Voltages World::SignalOf(const Spots& spots, const Moment& moment) {
  std::array<double, kChannels> signal_V = path_.effects().Shown_V(moment, path_.electronics().Amplify(spots.uv_m));
  path_.effects().AlterSignal(moment, signal_V);
  path_.electronics().AddFlicker(moment.now, signal_V);
  return signal_V;
}

/// What reaches the converter now.
Spots World::AddKnot(BlockCourse& course) {
  const mechanics::StackState axes = axes_.Look();
  const Moment moment = Look(axes);
  Spots spots = SpotsNow(moment, axes);
  const BlockCourse::Voltages signal_V = SignalOf(spots, moment);
  // Where light goes that is turned out of all measure no detector stands.
  if (spots.status == ReadingStatus::kOk && !std::ranges::all_of(signal_V, [](double v) { return std::isfinite(v); }))
    spots.status = ReadingStatus::kNoLight;
  course.Add(signal_V);
  return spots;
}

/// What was at the low pass before a block that begins now: light, floor and effects as they were at the time, the
/// tables where they stand. Nothing while a servo works, whose past is gone, or where there was no light.
std::optional<BlockCourse> World::Before() {
  constexpr double kMostKnots = 4096.0;  // of a pole so slow that it sees no more of the fastest than its mean
  if (path_.electronics().Memory_s() == 0.0 || axes_.IsRestless()) return std::nullopt;
  const double shortest_s = Shortest_s();
  const Duration memory =
      FromSeconds(std::min(path_.electronics().Memory_s(), kMostKnots / BlockCourse::kKnotsAPeriod * shortest_s));
  const int steps = StepsOf(memory, shortest_s, static_cast<int>(kMostKnots));
  const Time begin = queue_.Now();
  Moment moment = Look(axes_.Look());
  BlockCourse before(memory / steps);
  for (int k = steps; k >= 0; --k) {
    moment.now = begin - k * (memory / steps);
    const Spots spots = SpotsNow(moment, axes_.LookBack(moment.now));
    if (spots.status != ReadingStatus::kOk) return std::nullopt;
    before.Add(SignalOf(spots, moment));
  }
  return before;
}

Acquisition World::Acquire(int n_samples, bool keep_raw) {
  const Time start = queue_.Now();
  const Duration block = BlockTime(RotaryOf(actual()).adc, n_samples);
  const int steps = StepsOf(block, Shortest_s(), kChannels * n_samples);
  Followed followed{Before(), BlockCourse(block / steps, steps + 1), {}};
  ScopedEvents knots(adc_);
  for (int k = 0; k <= steps; ++k) {
    knots.At(start + k * (block / steps), [&, k] {
      const Spots spots = AddKnot(followed.course);
      Spots& seen = followed.seen;
      if (k == 0 || (seen.status == ReadingStatus::kOk && spots.status != ReadingStatus::kOk)) seen = spots;
    });
  }
  adc_.RunUntil(start + block);
  return Converted(std::move(followed), start, n_samples, keep_raw);
}

Acquisition World::Converted(Followed block, Time start, int n_samples, bool keep_raw) {
  Acquisition acquired;
  if (block.seen.status == ReadingStatus::kOk) {
    Electronics& electronics = path_.electronics();
    acquired = electronics.Convert(std::move(block.course), block.before, electronics.LightNoiseOf(block.seen),
                                   start, next_reading_, n_samples, keep_raw);
    path_.effects().AlterReadout(acquired);
  } else {
    acquired.start = start;
    acquired.status = block.seen.status;
  }
  ++next_reading_;
  return acquired;
}

}  // namespace twinbench::sim
