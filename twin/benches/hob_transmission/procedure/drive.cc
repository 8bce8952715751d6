#include "twin/benches/hob_transmission/procedure.h"

#include <fmt/format.h>

namespace twinbench::procedure {
namespace {

constexpr std::size_t kHobAxis = 0;

class HobDrive {
 public:
  HobDrive(MachineSequencer& sequencer, const HobSettings& bench)
      : sequencer_(sequencer), bench_(bench), s_(bench.hob_procedure), ramp_(FromSeconds(s_.ramp_s)) {
    RequireOneRotaryAxis(sequencer.axes(), "the hob");
  }

  void CarryOut() {
    int first = 0;
    for (const HobPass& pass : HobPasses(bench_)) {
      const int end = first + pass.readings, from = sequencer_.From(first, end);
      first = end;
      if (from == end) continue;
      if (sequencer_.NeedsMounting(pass.setup)) Mount(pass.setup);
      pass.hob_speed_rad_s != 0.0 ? Run(pass, from, end) : Stop(pass, from, end);
    }
  }

 private:
  void Mount(int setup) {
    if (setup > 0) sequencer_.LetHandsWork(FromSeconds(s_.remount_s));
    sequencer_.Mount(setup, fmt::format("the table's ring and head so that its mark passes with the table at {:.6g} deg",
                                        s_.heads_rad[static_cast<std::size_t>(setup)] / units::deg));
  }

  /// Whole turns at one speed in one direction.
  void Run(const HobPass& pass, int first, int end) {
    sequencer_.Turn(kHobAxis, pass.hob_speed_rad_s, ramp_);
    sequencer_.Collect(first, end, bench_.table_encoder.lines / s_.samples_per_turn, FromSeconds(s_.poll_s));
    sequencer_.Turn(kHobAxis, 0.0, ramp_);
    sequencer_.Pause(FromSeconds(s_.rest_s));
  }

  /// From stop to stop; both encoders and the interferometer are read at rest.
  void Stop(const HobPass& pass, int first, int end) {
    const double hob_step_rad = units::turn / bench_.interferometer.stops / bench_.transmission.Ratio();
    for (int k = first; k < end; ++k) {
      // Up over one ramp and down over the next: the mean speed is half of that on top.
      sequencer_.Turn(kHobAxis, pass.direction * hob_step_rad / s_.ramp_s, ramp_);
      sequencer_.Turn(kHobAxis, 0.0, ramp_);
      sequencer_.TakeAtRest(k, FromSeconds(s_.rest_s));
    }
  }

  MachineSequencer& sequencer_;
  const HobSettings& bench_;
  const HobProcedureSettings& s_;
  Duration ramp_;
};

}  // namespace

void DriveHob(MachineBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress,
              const MachineOptions& options) {
  const MachinePlan plan{HobSchedule(HobOf(scenario)), scenario.bench};
  const auto way = [&](MachineSequencer& sequencer) { HobDrive(sequencer, HobOf(scenario)).CarryOut(); };
  CarryOutPlan(bench, plan, way, sink, progress, options);
}

}  // namespace twinbench::procedure
