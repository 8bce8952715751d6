#include "twin/benches/turntable_autocollimator/procedure.h"

#include <map>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/errors.h"
#include "twin/core/stream.h"

namespace twinbench::procedure {
namespace {

/// The angle that is meant where a controller with this compensation shows `shown_rad`.
double MeantAngle_rad(const std::optional<CompensationTable>& compensation, double shown_rad) {
  if (!compensation) return shown_rad;
  constexpr int kRounds = 4;  // corrections change by less than a thousandth of the angle
  double meant_rad = shown_rad;
  for (int round = 0; round < kRounds; ++round) meant_rad = shown_rad - compensation->At(meant_rad);
  return meant_rad;
}

/// The steps that all phases share.
class TurntableRun {
 public:
  TurntableRun(NullingTurntableBench& bench, const Scenario& scenario, ReadingSink& sink,
               const ProgressCallback& progress)
      : bench_(bench),
        scenario_(scenario),
        sink_(sink),
        progress_(progress),
        dwell_(scenario.seed, "procedure.dwell"),
        planned_(PlannedReadings(settings())) {}

  const TurntableProcedureSettings& settings() const { return TurntableOf(scenario_).turntable_procedure; }
  bool has_polygon() const { return TurntableOf(scenario_).HasPolygon(); }
  int teeth() const { return TurntableOf(scenario_).multitooth.teeth; }
  double tooth_rad() const { return 2.0 * units::kPi / teeth(); }

  void Mount(int setup) {
    if (setup == setup_) return;
    if (setup_ >= 0) bench_.clock.Wait(FromSeconds(settings().remount_s));
    const TurntableProcedureSettings& s = settings();
    setup_ = setup;
    shift_ = s.Of(s.shifts, setup);
    Turn(0.0);
    bench_.fixture.Mount(setup, s.Of(s.tilts_rad, setup), s.Of(s.tilt_azimuths_rad, setup),
                         s.Of(s.eccentricities_m, setup), shift_);
  }
  void MountIfNothingIs() {
    if (setup_ < 0) Mount(0);
  }

  /// All stops of one pass, given in teeth, from behind.
  void Pass(Phase phase, const std::vector<int>& stops, int direction) {
    const double step_rad = 2.0 * units::kPi / settings().positions;
    const int first = direction > 0 ? stops.front() : stops.back();
    Turn(first * tooth_rad() - direction * settings().run_up_steps * step_rad);
    for (std::size_t k = 0; k < stops.size(); ++k) {
      const std::size_t position = direction > 0 ? k : stops.size() - 1 - k;
      Stop(phase, direction, static_cast<int>(position), stops[position], 0.0);
    }
    ++pass_;
  }

  /// Turntable at a tooth plus `offset_rad`, multi-tooth table back by the tooth; one reading.
  void Stop(Phase phase, int direction, int position, int tooth, double offset_rad) {
    Send(tooth * tooth_rad() + offset_rad);
    bench_.multitooth.IndexTo(shift_ - tooth);
    bench_.turntable.WaitSettled();
    Reading stop;
    stop.phase = phase;
    stop.direction = direction;
    stop.position = position;
    stop.target_rad = tooth * tooth_rad() + offset_rad;
    stop.reference_rad = (shift_ - tooth) * tooth_rad();
    Take(stop);
  }

  /// The faces of a pass are nulled one after the other, and the encoder is read.
  void NullFaces(int direction) {
    const TurntableSettings& s = TurntableOf(scenario_);
    const int positions = settings().positions;
    const int first = direction > 0 ? 0 : positions - 1;
    const double step_rad = 2.0 * units::kPi / positions;
    Turn(s.FaceAngle_rad(setup_, s.FaceAt(first)) - direction * settings().run_up_steps * step_rad);
    for (int k = 0; k < positions; ++k) NullFace(direction, direction > 0 ? k : first - k);
    ++pass_;
  }

  void NullFace(int direction, int position) {
    const TurntableSettings& s = TurntableOf(scenario_);
    const int face = s.FaceAt(position);
    Turn(s.FaceAngle_rad(setup_, face));
    bench_.servo.Null(direction);
    Reading stop;
    stop.phase = Phase::kFullCircle;
    stop.direction = direction;
    stop.position = position;
    stop.target_rad = MeantAngle_rad(s.turntable.compensation, bench_.turntable.EncoderAngle_rad());
    stop.reference_rad = -face * s.Pitch_rad();
    Take(stop);
  }

  void EndPass() { ++pass_; }
  void Turn(double angle_rad) {
    Send(angle_rad);
    bench_.turntable.WaitSettled();
  }

 private:
  /// The reading keeps the angle that is meant; the controller is told what brings the table there.
  void Send(double angle_rad) {
    bench_.turntable.StartMove(CommandedAngle_rad(TurntableOf(scenario_).turntable.compensation, angle_rad));
  }

  void Take(Reading stop) {
    const std::vector<double>& dwells_s = settings().dwell_s;
    stop.dwell_s = dwells_s[static_cast<std::size_t>(dwell_.Uniform() * static_cast<double>(dwells_s.size()))];
    bench_.clock.Wait(FromSeconds(stop.dwell_s));
    stop.reading = next_reading_++;
    stop.time = bench_.clock.Now();
    stop.setup = setup_;
    stop.pass = pass_;
    const AutocollimatorReading shown = bench_.autocollimator.Read();
    stop.status = shown.status;
    stop.autocollimator_yaw_rad = shown.yaw_rad;
    stop.autocollimator_tilt_rad = shown.tilt_rad;
    stop.temperature_degC = bench_.thermometer.Read_degC();
    sink_.Append(stop, {});
    if (progress_) progress_({next_reading_, planned_, stop.phase, stop.time});
  }

  NullingTurntableBench& bench_;
  const Scenario& scenario_;
  ReadingSink& sink_;
  const ProgressCallback& progress_;
  Stream dwell_;
  int planned_;
  int setup_ = -1, shift_ = 0, pass_ = 0, next_reading_ = 0;
};

std::vector<int> GridTeeth(int teeth, int positions) {
  std::vector<int> stops;
  for (int k = 0; k < positions; ++k) stops.push_back(k * (teeth / positions));
  return stops;
}

void NullPolygon(TurntableRun& run) {
  for (int setup = 0; setup < run.settings().SetUps(); ++setup) {
    run.Mount(setup);
    for (const int direction : run.settings().passes) run.NullFaces(direction);
  }
}

void MeasureFullCircle(TurntableRun& run) {
  if (run.has_polygon()) return NullPolygon(run);
  const std::vector<int> stops = GridTeeth(run.teeth(), run.settings().positions);
  for (int setup = 0; setup < run.settings().SetUps(); ++setup) {
    run.Mount(setup);
    for (const int direction : run.settings().passes) run.Pass(Phase::kFullCircle, stops, direction);
  }
}

void SweepTurntable(TurntableRun& run) {
  run.MountIfNothingIs();
  const int points = run.settings().sweep_points;
  const double sweep_rad = run.settings().sweep_rad;
  run.Turn(-2.0 * sweep_rad);
  for (int k = 0; k < points; ++k)
    run.Stop(Phase::kCalibration, 1, k, 0, sweep_rad * (2.0 * k / (points - 1) - 1.0));
  run.EndPass();
}

void VerifyBetweenPositions(TurntableRun& run) {
  run.MountIfNothingIs();
  const TurntableProcedureSettings& s = run.settings();
  const std::vector<int> stops = CheckTeeth(run.teeth(), s.positions, s.verification_positions);
  for (const int direction : s.verification_passes) run.Pass(Phase::kVerification, stops, direction);
}

struct TurntablePhase {
  void (*carry_out)(TurntableRun&);
  int (*readings)(const TurntableProcedureSettings&);
};

int TurntableCircleReadings(const TurntableProcedureSettings& s) {
  return s.SetUps() * s.positions * static_cast<int>(s.passes.size());
}
int SweepReadings(const TurntableProcedureSettings& s) {
  return s.sweep_points;
}
int CheckReadings(const TurntableProcedureSettings& s) {
  return s.verification_positions * static_cast<int>(s.verification_passes.size());
}

const TurntablePhase& PhaseNamed(const std::string& name) {
  static const std::map<std::string, TurntablePhase> phases = {
      {"calibration", {SweepTurntable, SweepReadings}},
      {"full_circle", {MeasureFullCircle, TurntableCircleReadings}},
      {"verification", {VerifyBetweenPositions, CheckReadings}}};
  const auto found = phases.find(name);
  Require(found != phases.end(), "turntable_procedure.phases holds a phase that does not exist");
  return found->second;
}

}  // namespace

std::vector<int> CheckTeeth(int teeth, int positions, int count) {
  std::vector<int> between;
  for (int tooth = 0; tooth < teeth; ++tooth) {
    if (tooth % (teeth / positions) != 0) between.push_back(tooth);
  }
  std::vector<int> chosen;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    chosen.push_back(between.at(k * between.size() / static_cast<std::size_t>(count)));
  return chosen;
}

int PlannedReadings(const TurntableProcedureSettings& procedure) {
  int readings = 0;
  for (const std::string& phase : procedure.phases) readings += PhaseNamed(phase).readings(procedure);
  return readings;
}

void CarryOut(NullingTurntableBench& bench, const Scenario& scenario, ReadingSink& sink,
              const ProgressCallback& progress) {
  TurntableRun run(bench, scenario, sink, progress);
  for (const std::string& phase : TurntableOf(scenario).turntable_procedure.phases)
    PhaseNamed(phase).carry_out(run);
}

}  // namespace twinbench::procedure
