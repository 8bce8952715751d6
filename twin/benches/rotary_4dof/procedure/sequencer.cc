#include "twin/benches/rotary_4dof/procedure/sequencer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/device_fault.h"
#include "twin/procedure/attempts.h"
#include "twin/procedure/plausible.h"
#include "twin/procedure/stood.h"
#include "twin/procedure/watch.h"

namespace twinbench::procedure {

Sequencer::Sequencer(Journal& journal, const Scenario& scenario, ReadingSink& sink, const Options& options,
                     const ProgressCallback& progress, RunState& state)
    : journal_(journal),
      scenario_(scenario),
      sink_(sink),
      options_(options),
      progress_(progress),
      state_(state),
      live_devices_(journal.Bench()),
      dwell_(scenario.seed, "procedure.dwell"),
      planned_(PlannedReadings(RotaryOf(scenario).procedure)) {}

void Sequencer::Begin() {
  if (state_.disturbed && !quiet()) GoLive();
}

void Sequencer::Mount(int setup, int shift_steps) {
  shift_rad_ = shift_steps * step_rad();
  GoTo(0.0);
  // On a real bench a mounting outlives the fault that came after it; a second one would seat differently.
  if (state_.mounted_for == next_reading_) return;
  const bool reclamp = settings().clamping == "reclamp";
  const double clamp_rad = reclamp ? shift_rad_ : 0.0, reseat_rad = reclamp ? 0.0 : -shift_rad_;
  bench().fixture.Mount(setup, clamp_rad, reseat_rad);
  if (!quiet()) NoteMounting(setup, clamp_rad, reseat_rad);
  if (!options_.hand_ends_mounting) WaitFor(bench(), FromSeconds(settings().remount_s), options_);
  if (!quiet() && !bench().simulation) state_.mounted_for = next_reading_;
}

void Sequencer::NoteMounting(int setup, double clamp_rad, double reseat_rad) {
  if (!options_.log) return;
  options_.log->AppendEvent(
      bench().clock.Now(), "fixture",
      fmt::format("mounting {}{}: grating clamped at {:.6g} deg, body seated at {:.6g} deg", setup,
                  options_.hand_ends_mounting ? kMountedByHand : "", clamp_rad / units::deg, reseat_rad / units::deg));
}

void Sequencer::GoTo(double target_rad) {
  target_rad_ = target_rad;
  Send(bench(), target_rad);
}

Sequencer::Sent Sequencer::SentTo(double target_rad) const {
  const RotarySettings& own = RotaryOf(scenario_);
  return {CommandedAngle_rad(own.target.compensation, target_rad),
          CommandedAngle_rad(own.reference.compensation, shift_rad_ - target_rad)};
}

void Sequencer::Send(RotaryBench& bench, double target_rad) {
  const Sent sent = SentTo(target_rad);
  MoveBoth(bench, sent.target_rad, sent.reference_rad, options_, sent_rad_);
  sent_rad_ = {sent.target_rad, sent.reference_rad};
}

void Sequencer::Tilt(double yaw_rad, double tilt_rad) {
  yaw_rad_ = yaw_rad;
  tilt_rad_ = tilt_rad;
  has_tilted_ = true;
  bench().goniometer.MoveTo(yaw_rad, tilt_rad);
}

void Sequencer::Take(Reading stop, bool with_autocollimator) {
  TakeAfter(std::move(stop), DrawDwell_s(), with_autocollimator);
}

void Sequencer::TakeAfter(Reading stop, double dwell_s, bool with_autocollimator) {
  stop.reading = next_reading_;
  if (quiet()) {
    last_ = stop;
    if (++next_reading_ == state_.kept) GoLive();
    return;
  }
  if (options_.log) options_.log->RequireRoom();
  const bool rests = stop.phase == Phase::kStability;  // its tables stay where they are between the first reading and the last
  if (options_.prove && rests && stop.position == 0) options_.prove(stop);
  const Acquisition block = Measure(stop, dwell_s, with_autocollimator);
  RequirePlausible(stop, last_, options_);
  if (options_.prove && (!rests || stop.position + 1 == StabilityReadings(settings()))) options_.prove(stop);
  sink_.Append(stop, block);
  journal_.Commit();
  last_ = stop;
  state_.last = stop;
  state_.kept = ++next_reading_;
  if (progress_) progress_({next_reading_, planned_, stop.phase, bench().clock.Now()});
  if (next_reading_ < planned_) HearOperator(options_);
}

Acquisition Sequencer::Measure(Reading& stop, double dwell_s, bool with_autocollimator) {
  WaitFor(bench(), FromSeconds(dwell_s), options_);
  stop.target_rad = target_rad_;
  stop.reference_rad = shift_rad_ - target_rad_;
  stop.dwell_s = dwell_s;
  stop.temperature_degC = bench().thermometer.Read_degC();
  if (with_autocollimator) {
    const AutocollimatorReading angles = bench().autocollimator.Read();
    stop.autocollimator_yaw_rad = angles.yaw_rad;
    stop.autocollimator_tilt_rad = angles.tilt_rad;
  }
  Acquisition block = TakeBlock(stop);
  if (block.status == ReadingStatus::kOverrun) {
    throw DeviceFault(
        FaultKind::kOverrun, "adc",
        fmt::format("its FIFO ran full after {} of {} scans", block.n_samples, RotaryOf(scenario_).adc.samples));
  }
  stop.time = block.start;
  stop.status = block.status;
  stop.n_samples = block.n_samples;
  if (block.status == ReadingStatus::kOk) {
    for (int c = 0; c < kChannels; ++c) {
      stop.mean_V[c] = block.channel[c].mean_V;
      stop.std_V[c] = block.channel[c].std_V;
    }
  }
  return block;
}

/// The tables' encoders are looked at about the block, as near to it as they can be asked.
Acquisition Sequencer::TakeBlock(Reading& stop) {
  const std::array<double, 2> before_rad = LookAtEncoders();
  const Time asked = bench().clock.Now();
  Acquisition block = bench().adc.Acquire(RotaryOf(scenario_).adc.samples, settings().keep_raw);
  RequireTimely(block, asked, bench().clock.Now());
  const std::array<double, 2> after_rad = LookAtEncoders();
  const Sent sent = SentTo(target_rad_);
  const std::array<Stood, 2> tables = {
      Stood{"target", true, sent.target_rad, before_rad[0], after_rad[0], options_.target.in_position_rad},
      Stood{"reference", true, sent.reference_rad, before_rad[1], after_rad[1], options_.reference.in_position_rad}};
  for (const Stood& table : tables) EnterInto(stop, table);
  for (const Stood& table : tables) RequireStood(table);
  return block;
}

std::array<double, 2> Sequencer::LookAtEncoders() {
  if (!options_.looks_at_encoders) return {kNaN, kNaN};
  const double target_rad = StoodAt("target", bench().target.State());
  return {target_rad, StoodAt("reference", bench().reference.State())};
}

double Sequencer::DrawDwell_s() {
  const std::vector<double>& choices = settings().dwell_s;
  Require(!choices.empty(), "procedure.dwell_s is empty");
  return choices[static_cast<std::size_t>(dwell_.Uniform() * static_cast<double>(choices.size()))];
}

void Sequencer::GoLive() {
  journal_.inner().simulation ? RepeatCalls() : ReturnToLastStop();
}

/// A simulation that answers otherwise each time is not the one that made the record; once it may be a fault that waited for its
/// moment, which starting again undoes.
void Sequencer::RepeatCalls() {
  for (int attempt = 1;; ++attempt) {
    const std::optional<DeviceFault> otherwise = RepeatOnce();
    if (!otherwise) return;
    if (attempt == options_.attempts)
      throw InputError("record", otherwise->what() + fmt::format(", in {} attempts", attempt),
                       "the bench, scenario, seed and version that made the record; if it is these, a fault strikes again and "
                       "again: look at the bench and go on with --resume");
    NoteFailure(options_.log, state_.kept, journal_.inner().clock.Now(), *otherwise);
  }
}

/// @return what was answered otherwise; nothing: all is as it was.
std::optional<DeviceFault> Sequencer::RepeatOnce() {
  RotaryBench& bench = journal_.inner();
  bench.simulation->Restart();
  bench.simulation->SetPaced(false);
  for (const DeviceCall& call : journal_.done()) {
    const std::string answer = Perform(bench, call.device, call.request).text;
    // What a controller says about its motion may depend on what it was asked before; what is measured may not.
    if ((answer == call.answer || call.request == "state") && bench.clock.Now() == call.time) continue;
    const bool is_arrival = call.request.starts_with("settles");
    return DeviceFault(is_arrival ? FaultKind::kNotInPosition : FaultKind::kImplausible, call.device,
                       fmt::format("answered \"{}\" to \"{}\" and not \"{}\" as before", answer, call.request, call.answer));
  }
  bench.simulation->SetPaced(true);
  return std::nullopt;
}

/// Finding an origin drives a table through ways that no procedure planned.
void Sequencer::HomeIfLost(RotaryTable& table, const char* name) {
  if (table.State().referenced) return;
  if (!options_.may_home)
    throw DeviceFault(FaultKind::kRefused, name,
                      "has lost its origin, and finding it moves the table: look whether it may turn, then agree with "
                      "--allow-homing");
  table.Home();
}

/// The encoders say where the tables really are. The last stop is approached from the side it was approached from.
void Sequencer::ReturnToLastStop() {
  RotaryBench& bench = journal_.inner();
  sent_rad_ = {kNaN, kNaN};
  HomeIfLost(bench.target, "target");
  HomeIfLost(bench.reference, "reference");
  const double at_rad = target_rad_, behind_rad = at_rad - last_.direction * settings().run_up_steps * step_rad();
  const Sent sent = SentTo(at_rad);
  const double off_rad = std::max(std::abs(bench.target.EncoderAngle_rad() - sent.target_rad),
                                  std::abs(bench.reference.EncoderAngle_rad() - sent.reference_rad));
  const double near_rad = std::min(options_.target.in_position_rad, options_.reference.in_position_rad);
  if (!(off_rad <= near_rad)) {
    Send(bench, behind_rad);
    Send(bench, at_rad);
  }
  if (has_tilted_) bench.goniometer.MoveTo(yaw_rad_, tilt_rad_);
  RequireAsBefore(bench);
}

/// A controller whose zero or unit is another than before the fault is told by the spots alone. What is read again is in no record.
void Sequencer::RequireAsBefore(RotaryBench& bench) {
  constexpr double kTimesNoise = 10.0, kTimesHum = 3.0;  // of which a short block has a part of a wave
  constexpr double kShareOfRange = 5e-4;                 // what coming to a stop again may change
  const bool was_mounted_since = state_.mounted_for == state_.kept;
  if (was_mounted_since && state_.moved)
    throw DeviceFault(FaultKind::kImplausible, "tables",
                      "were elsewhere before the first reading of a mounting: nothing tells whether their zeros and units are still the same");
  if (!state_.last || state_.last->status != ReadingStatus::kOk || was_mounted_since) return;
  const AdcSettings& adc = RotaryOf(scenario_).adc;
  const Acquisition block = bench.adc.Acquire(adc.samples, false);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double was_V = state_.last->mean_V[c], is_V = block.channel[c].mean_V;
    const double noise_V = state_.last->std_V[c] * std::sqrt(2.0 / state_.last->n_samples);
    const double hum_V = RotaryOf(scenario_).amplifier.hum_V;
    if (std::abs(is_V - was_V) <= kTimesNoise * noise_V + kTimesHum * hum_V + kShareOfRange * adc.range_V) continue;
    throw DeviceFault(FaultKind::kImplausible, kChannelNames[c],
                      fmt::format("showed {:.4g} V at reading {} and shows {:.4g} V at its place behind the fault: is a zero, a unit or the "
                                  "mounting another than before?",
                                  was_V, state_.last->reading, is_V));
  }
}

}  // namespace twinbench::procedure
