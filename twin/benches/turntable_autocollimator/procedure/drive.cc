#include "twin/benches/turntable_autocollimator/procedure.h"

#include <fmt/format.h>

#include <cmath>

namespace twinbench::procedure {
namespace {

/// A table that comes back no better than the deadband is not chased for ever.
constexpr int kMostNullMoves = 6;
constexpr double kNullFromBehind_rad = 60.0 * units::arcsec;

/// The angle that is meant where a controller with this compensation shows `shown_rad`.
double MeantAngle_rad(const std::optional<CompensationTable>& compensation, double shown_rad) {
  if (!compensation) return shown_rad;
  constexpr int kRounds = 4;  // corrections change by less than a thousandth of the angle
  double meant_rad = shown_rad;
  for (int round = 0; round < kRounds; ++round) meant_rad = shown_rad - compensation->At(meant_rad);
  return meant_rad;
}

class TurntableDrive {
 public:
  TurntableDrive(MachineSequencer& sequencer, const TurntableSettings& bench)
      : sequencer_(sequencer), bench_(bench), s_(bench.turntable_procedure) {
    RequireOneRotaryAxis(sequencer.axes(), "the turntable");
  }

  void CarryOut() {
    sequencer_.ThroughPasses([this](int first, int end) {
      if (sequencer_.NeedsMounting(At(first).setup)) Mount(At(first).setup);
      Turn(BeforePass_rad(At(first)));
      for (int k = first; k < end; ++k) bench_.HasPolygon() ? NullFace(k) : Stop(k);
    });
  }

 private:
  const Reading& At(int reading) const { return sequencer_.plan()[static_cast<std::size_t>(reading)]; }

  /// Readings keep the angle that is meant; the controller is told what brings the table there.
  double Told_rad(double angle_rad) const { return CommandedAngle_rad(bench_.turntable.compensation, angle_rad); }
  void Turn(double angle_rad) { sequencer_.MoveTo({Told_rad(angle_rad)}); }

  std::string InWords(int setup) const {
    const double tilt_rad = s_.Of(s_.tilts_rad, setup), azimuth_rad = s_.Of(s_.tilt_azimuths_rad, setup);
    const double eccentricity_m = s_.Of(s_.eccentricities_m, setup);
    const std::string how =
        fmt::format("its axis leaning by {:.6g} arcsec towards {:.6g} deg and {:.6g} um off the turntable's",
                    tilt_rad / units::arcsec, azimuth_rad / units::deg, eccentricity_m / units::um);
    if (bench_.HasPolygon())
      return fmt::format("the polygon, {}; its face 0 is seen with the turntable at {:.6g} deg", how,
                         bench_.FaceAngle_rad(setup, 0) / units::deg);
    return fmt::format("the multi-tooth table, {}; the mirror is seen with the turntable at 0 and the table at tooth {}",
                       how, s_.Of(s_.shifts, setup));
  }

  void Mount(int setup) {
    if (sequencer_.HasMounted()) sequencer_.LetHandsWork(FromSeconds(s_.remount_s));
    Turn(0.0);
    sequencer_.Mount(setup, InWords(setup));
  }

  double BeforePass_rad(const Reading& first) const {
    if (first.phase == Phase::kCalibration) return -2.0 * s_.sweep_rad;
    const double step_rad = 2.0 * units::kPi / s_.positions;
    return first.target_rad - first.direction * s_.run_up_steps * step_rad;
  }

  void Stop(int reading) {
    const Reading& stop = At(reading);
    const int tooth = static_cast<int>(std::lround(stop.reference_rad / bench_.Pitch_rad()));
    sequencer_.MoveAndIndex({Told_rad(stop.target_rad)}, tooth, stop.reference_rad);
    sequencer_.TakeAtRest(reading, FromSeconds(stop.dwell_s));
  }

  void NullFace(int reading) {
    const Reading& stop = At(reading);
    Null(Told_rad(stop.target_rad), stop.direction);
    const double shown_rad = MeantAngle_rad(bench_.turntable.compensation, sequencer_.Where()[0]);
    sequencer_.TakeAtRest(reading, FromSeconds(stop.dwell_s), [&](Reading& r) { r.target_rad = shown_rad; });
  }

  /// Turns the table until x is within the deadband, and comes to that place from behind in `direction`.
  void Null(double told_rad, int direction) {
    sequencer_.MoveTo({told_rad});
    for (int moves = 0;; ++moves) {
      const Reading shown = sequencer_.Look();
      const double x_rad = shown.autocollimator_yaw_rad;
      const bool is_seen = shown.status == ReadingStatus::kOk && std::isfinite(x_rad);
      if (!is_seen || std::abs(x_rad) <= bench_.collimator.deadband_rad || moves == kMostNullMoves) return;
      told_rad -= x_rad;
      if (direction * x_rad > 0.0) sequencer_.MoveTo({told_rad - direction * kNullFromBehind_rad});
      sequencer_.MoveTo({told_rad});
    }
  }

  MachineSequencer& sequencer_;
  const TurntableSettings& bench_;
  const TurntableProcedureSettings& s_;
};

}  // namespace

void DriveTurntable(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                    const ProgressCallback& progress, const MachineOptions& options) {
  const MachinePlan plan{TurntableSchedule(scenario), scenario.bench};
  const auto way = [&](MachineSequencer& sequencer) { TurntableDrive(sequencer, TurntableOf(scenario)).CarryOut(); };
  CarryOutPlan(bench, plan, way, sink, progress, options);
}

}  // namespace twinbench::procedure
