#include "twin/benches/encoder_comparison/procedure/drive.h"

#include <fmt/format.h>

#include "twin/benches/encoder_comparison/procedure.h"
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
      if (!BeginsThere(first)) sequencer_.MoveTo({At(first).reference_rad - At(first).direction * 0.5 * units::turn / s_.stops});
      for (int k = first; k < end; ++k) Stop(k);
    });
  }

 private:
  const Reading& At(int reading) const { return sequencer_.plan()[static_cast<std::size_t>(reading)]; }

  std::string InWords(int mounting) const {
    return fmt::format("the device at {:.6g} deg where the reference shows 0",
                       s_.mounting_rad[static_cast<std::size_t>(mounting)] / units::deg);
  }

  /// A twin stands at its first stop at Time 0, come from behind.
  bool BeginsThere(int reading) const { return reading == 0 && sequencer_.IsSimulated(); }

  /// All heads are read where the shaft stands.
  void Stop(int reading) {
    const bool is_there = reading % heads_ != 0 || BeginsThere(reading);
    if (!is_there) sequencer_.MoveTo({At(reading).reference_rad});
    sequencer_.TakeAtRest(reading, FromSeconds(is_there ? 0.0 : 0.5 * s_.stop_interval_s));
  }

  MachineSequencer& sequencer_;
  const EncoderProcedureSettings& s_;
  int heads_;
};

}  // namespace

void RequireStops(const Scenario& scenario) {
  const std::string& kind = EncoderOf(scenario).encoder_procedure.kind;
  if (kind != "stops")
    throw InputError("encoder_procedure.kind", "a comparison in motion (\"" + kind + "\") cannot be driven",
                     "kind = \"stops\"");
}

void DriveComparison(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                     const ProgressCallback& progress, const MachineOptions& options) {
  RequireStops(scenario);
  const EncoderProcedureSettings& settings = EncoderOf(scenario).encoder_procedure;
  const MachinePlan plan{AngleSchedule(settings), scenario.bench};
  const auto way = [&](MachineSequencer& sequencer) { ComparisonDrive(sequencer, settings).CarryOut(); };
  CarryOutPlan(bench, plan, way, sink, progress, options);
}

}  // namespace twinbench::procedure
