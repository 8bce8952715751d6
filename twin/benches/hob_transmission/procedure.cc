#include "twin/benches/hob_transmission/procedure.h"

#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

class HobRun {
 public:
  HobRun(HobBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress)
      : bench_(bench),
        scenario_(scenario),
        sink_(sink),
        progress_(progress),
        planned_(PlannedReadings(HobOf(scenario))) {}

  const HobProcedureSettings& settings() const { return HobOf(scenario_).hob_procedure; }

  void Mount(int setup) {
    if (setup > 0) bench_.clock.Wait(FromSeconds(settings().remount_s));
    setup_ = setup;
    head_rad_ = settings().heads_rad[static_cast<std::size_t>(setup)];
    bench_.fixture.Mount(setup, head_rad_);
  }

  /// Whole turns at one speed in one direction.
  void Pass(double hob_speed_rad_s, int direction) {
    bench_.drive.Run(direction * hob_speed_rad_s, FromSeconds(settings().ramp_s));
    bench_.clock.Wait(FromSeconds(settings().ramp_s));
    const int samples = settings().turns * settings().samples_per_turn;
    bench_.counters.Arm(HobOf(scenario_).table_encoder.lines / settings().samples_per_turn, samples);
    Collect(direction, samples);
    bench_.drive.Run(0.0, FromSeconds(settings().ramp_s));
    bench_.clock.Wait(FromSeconds(settings().ramp_s + settings().rest_s));
    ++pass_;
  }

  /// One turn from stop to stop; both encoders and the interferometer are read at rest.
  void Stops(int direction) {
    const int stops = HobOf(scenario_).interferometer.stops;
    const double hob_step_rad = units::turn / stops / HobOf(scenario_).transmission.Ratio();
    for (int position = 0; position < stops; ++position) {
      // Up over one ramp and down over the next: the mean speed is half of that on top.
      bench_.drive.Run(direction * hob_step_rad / settings().ramp_s, FromSeconds(settings().ramp_s));
      bench_.clock.Wait(FromSeconds(settings().ramp_s));
      bench_.drive.Run(0.0, FromSeconds(settings().ramp_s));
      bench_.clock.Wait(FromSeconds(settings().ramp_s + settings().rest_s));
      Append({ReadingOf(bench_.counters.Latch(), direction, position)});
    }
    ++pass_;
  }

 private:
  void Collect(int direction, int wanted) {
    int position = 0, looks_in_vain = 0;
    while (position < wanted) {
      bench_.clock.Wait(FromSeconds(settings().poll_s));
      const CounterSamples look = bench_.counters.Read();
      std::vector<Reading> readings;
      for (const CounterSample& sample : look.samples) readings.push_back(ReadingOf(sample, direction, position++));
      Append(readings);
      if (look.overrun)
        throw DeviceFault(FaultKind::kOverrun, "counters",
                          "the FIFO ran full; empty it more often (poll_s) or keep fewer edges (samples_per_turn)");
      looks_in_vain = look.samples.empty() ? looks_in_vain + 1 : 0;
      RequireEdges(looks_in_vain);
    }
  }

  void Append(const std::vector<Reading>& readings) {
    sink_.AppendAll(readings);
    if (progress_ && !readings.empty())
      progress_({next_reading_, planned_, Phase::kFullCircle, readings.back().time});
  }

  /// A chain that stands still would keep the program waiting for ever.
  void RequireEdges(int looks_in_vain) const {
    constexpr double kPatience_s = 60.0;
    if (looks_in_vain * settings().poll_s > kPatience_s)
      throw DeviceFault(FaultKind::kStalled, "counters", "no edge of the table's encoder for a minute");
  }

  Reading ReadingOf(const CounterSample& sample, int direction, int position) {
    Reading reading;
    reading.reading = next_reading_++;
    reading.time = sample.time;
    reading.setup = setup_;
    reading.pass = pass_;
    reading.direction = direction;
    reading.position = position;
    reading.measured_rad = sample.table_encoder_rad;
    reading.reference_rad = sample.hob_encoder_rad;
    reading.head_rad = head_rad_;
    reading.velocity_rad_s = sample.velocity_rad_s;
    reading.interferometer_rad = sample.interferometer_rad;
    return reading;
  }

  HobBench& bench_;
  const Scenario& scenario_;
  ReadingSink& sink_;
  const ProgressCallback& progress_;
  int planned_;
  int setup_ = 0, pass_ = 0, next_reading_ = 0;
  double head_rad_ = 0.0;
};

}  // namespace

int PlannedReadings(const HobSettings& bench) {
  const HobProcedureSettings& s = bench.hob_procedure;
  const std::size_t passes = s.heads_rad.size() * s.hob_speeds_rad_s.size() * s.passes.size();
  const int at_rest =
      bench.interferometer.used ? static_cast<int>(s.passes.size()) * bench.interferometer.stops : 0;
  return static_cast<int>(passes) * s.turns * s.samples_per_turn + at_rest;
}

void CarryOut(HobBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress) {
  HobRun run(bench, scenario, sink, progress);
  const HobProcedureSettings& s = HobOf(scenario).hob_procedure;
  const InterferometerSettings& interferometer = HobOf(scenario).interferometer;
  for (std::size_t setup = 0; setup < s.heads_rad.size(); ++setup) {
    run.Mount(static_cast<int>(setup));
    for (const double speed_rad_s : s.hob_speeds_rad_s) {
      for (const int direction : s.passes) run.Pass(speed_rad_s, direction);
    }
    if (setup != 0 || !interferometer.used || !interferometer.IsReadAtRest()) continue;
    for (const int direction : s.passes) run.Stops(direction);
  }
}

}  // namespace twinbench::procedure
