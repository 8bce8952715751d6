#include "twin/benches/encoder_comparison/procedure.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

class ComparisonDrive {
 public:
  ComparisonDrive(MachineSequencer& sequencer, const EncoderProcedureSettings& settings)
      : sequencer_(sequencer), s_(settings), heads_(static_cast<int>(settings.heads_rad.size())) {
    RequireOneRotaryAxis(sequencer.axes(), "the shaft");
    if (heads_ > 1 && !sequencer.IsSimulated())
      throw DeviceFault(FaultKind::kRefused, "instruments", "they show one head of the device, and the scenario has several");
  }

  void CarryOut() {
    sequencer_.ThroughPasses([this](int first, int end) {
      const int mounting = At(first).setup / heads_;
      if (sequencer_.NeedsMounting(mounting)) sequencer_.Mount(mounting, InWords(mounting));
      s_.kind == "sweep" ? Sweep(first, end) : Stops(first, end);
    });
  }

 private:
  const Reading& At(int reading) const { return sequencer_.plan()[static_cast<std::size_t>(reading)]; }

  std::string InWords(int mounting) const {
    return fmt::format("the device at {:.6g} deg where the reference shows 0",
                       s_.mounting_rad[static_cast<std::size_t>(mounting)] / units::deg);
  }

  void Stops(int first, int end) {
    if (!BeginsThere(first)) sequencer_.MoveTo({At(first).reference_rad - At(first).direction * 0.5 * units::turn / s_.stops});
    for (int k = first; k < end; ++k) Stop(k);
  }

  /// A twin stands at its first stop at Time 0, come from behind.
  bool BeginsThere(int reading) const { return reading == 0 && sequencer_.IsSimulated(); }

  /// All heads are read where the shaft stands.
  void Stop(int reading) {
    const bool is_there = reading % heads_ != 0 || BeginsThere(reading);
    if (!is_there) sequencer_.MoveTo({At(reading).reference_rad});
    sequencer_.TakeAtRest(reading, FromSeconds(is_there ? 0.0 : 0.5 * s_.stop_interval_s));
  }

  int BeginOfPass(int reading) const {
    while (reading > 0 && At(reading - 1).pass == At(reading).pass) --reading;
    return reading;
  }

  /// With its sign.
  double SpeedOf_rad_s(int pass) const {
    const auto directions = s_.passes.size(), at = static_cast<std::size_t>(pass);
    return s_.passes[at % directions] * s_.speeds_rad_s[at / directions % s_.speeds_rad_s.size()];
  }

  /// A twin stands where the pass before it ended, and begins when that is planned. A real shaft is brought there where it
  /// stands further off than it needs to reach its speed.
  Time Begun(int begin, double speed_rad_s) {
    if (sequencer_.IsSimulated()) {
      sequencer_.PauseUntil(At(begin).time);
      return At(begin).time;
    }
    const double run_up_rad = 0.5 * std::abs(speed_rad_s) * s_.ramp_s;
    if (std::abs(sequencer_.Where()[0] - At(begin).reference_rad) > run_up_rad)
      sequencer_.MoveTo({At(begin).reference_rad});
    return sequencer_.Now();
  }

  /// The whole way of a pass; the readings [first, end) of it are taken.
  void Sweep(int first, int end) {
    const int begin = BeginOfPass(first);
    const double speed_rad_s = SpeedOf_rad_s(At(begin).pass);
    const Duration ramp = FromSeconds(s_.ramp_s);
    const Time begun = Begun(begin, speed_rad_s);
    const Time slows = begun + FromSeconds(s_.ramp_s + s_.turns * units::turn / std::abs(speed_rad_s));
    const auto due = [&](int k) { return begun + (At(k).time - At(begin).time); };
    int k = begin;
    const auto take_until = [&](Time last) {
      for (; k < end && due(k) <= last; ++k) {
        if (k >= first) InMotion(k, due(k));
      }
      sequencer_.PauseUntil(last);
    };
    take_until(begun);
    sequencer_.StartTurning(kShaft, speed_rad_s, ramp);
    take_until(slows);
    sequencer_.StartTurning(kShaft, 0.0, ramp);
    take_until(std::max(slows + ramp, due(end - 1)));
  }

  void InMotion(int reading, Time due) {
    const bool as_planned = sequencer_.IsSimulated();
    sequencer_.TakeInMotion(reading, due, FromSeconds(s_.interval_s), [as_planned](Reading& r) {
      if (!as_planned) r.velocity_rad_s = kNaN;
    });
  }

  static constexpr std::size_t kShaft = 0;

  MachineSequencer& sequencer_;
  const EncoderProcedureSettings& s_;
  int heads_;
};

}  // namespace

void RequireDriven(const Scenario& scenario) {
  if (EncoderOf(scenario).encoder_procedure.kind == "coast")
    throw InputError("encoder_procedure.kind", "\"coast\" cannot be driven: no command lets go of the spindle's drive",
                     "\"stops\" or \"sweep\"; times that other software took are read by a bench file of kind = \"program\", "
                     "or evaluated as they are (twinbench separate)");
}

void DriveComparison(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                     const ProgressCallback& progress, const MachineOptions& options) {
  RequireDriven(scenario);
  const EncoderProcedureSettings& settings = EncoderOf(scenario).encoder_procedure;
  const MachinePlan plan{AngleSchedule(settings), scenario.bench};
  const auto way = [&](MachineSequencer& sequencer) { ComparisonDrive(sequencer, settings).CarryOut(); };
  CarryOutPlan(bench, plan, way, sink, progress, options);
}

}  // namespace twinbench::procedure
