#include "twin/procedure/sequencer.h"

#include "twin/core/errors.h"

namespace twinbench::procedure {

Sequencer::Sequencer(RotaryBench& bench, const Scenario& scenario, ReadingSink& sink,
                     const ProgressCallback& progress)
    : bench_(bench),
      scenario_(scenario),
      sink_(sink),
      progress_(progress),
      dwell_(scenario.seed, "procedure.dwell"),
      planned_(PlannedReadings(scenario.procedure)) {}

void Sequencer::Mount(int setup, int shift_steps) {
  shift_rad_ = shift_steps * step_rad();
  GoTo(0.0);
  const bool reclamp = settings().clamping == "reclamp";
  bench_.fixture.Mount(setup, reclamp ? shift_rad_ : 0.0, reclamp ? 0.0 : -shift_rad_);
  bench_.clock.Wait(FromSeconds(settings().remount_s));
}

void Sequencer::GoTo(double target_rad) {
  target_rad_ = target_rad;
  bench_.target.StartMove(target_rad);
  bench_.reference.StartMove(shift_rad_ - target_rad);
  bench_.target.WaitSettled();
  bench_.reference.WaitSettled();
}

void Sequencer::Take(Reading stop, bool with_autocollimator) {
  TakeAfter(std::move(stop), DrawDwell_s(), with_autocollimator);
}

void Sequencer::TakeAfter(Reading stop, double dwell_s, bool with_autocollimator) {
  bench_.clock.Wait(FromSeconds(dwell_s));
  stop.reading = next_reading_++;
  stop.dwell_s = dwell_s;
  stop.target_rad = target_rad_;
  stop.reference_rad = shift_rad_ - target_rad_;
  stop.temperature_degC = bench_.thermometer.Read_degC();
  if (with_autocollimator) {
    const AutocollimatorReading angles = bench_.autocollimator.Read();
    stop.autocollimator_yaw_rad = angles.yaw_rad;
    stop.autocollimator_tilt_rad = angles.tilt_rad;
  }
  const Acquisition block = bench_.adc.Acquire(scenario_.adc.samples, settings().keep_raw);
  stop.time = block.start;
  stop.status = block.status;
  stop.n_samples = block.n_samples;
  if (block.status == ReadingStatus::kOk) {
    for (int c = 0; c < kChannels; ++c) {
      stop.mean_V[c] = block.channel[c].mean_V;
      stop.std_V[c] = block.channel[c].std_V;
    }
  }
  sink_.Append(stop, block);
  if (progress_) progress_({next_reading_, planned_, stop.phase, bench_.clock.Now()});
}

double Sequencer::DrawDwell_s() {
  const std::vector<double>& choices = settings().dwell_s;
  Require(!choices.empty(), "procedure.dwell_s is empty");
  return choices[static_cast<std::size_t>(dwell_.Uniform() * static_cast<double>(choices.size()))];
}

}  // namespace twinbench::procedure
