#include "twin/benches/turntable_autocollimator/procedure.h"

#include <map>

#include "twin/core/errors.h"
#include "twin/core/stream.h"

namespace twinbench::procedure {
namespace {

std::vector<int> GridTeeth(int teeth, int positions) {
  std::vector<int> stops;
  for (int k = 0; k < positions; ++k) stops.push_back(k * (teeth / positions));
  return stops;
}

/// Adds readings in the order in which they are taken.
class TurntableReadings {
 public:
  explicit TurntableReadings(const Scenario& scenario)
      : bench_(TurntableOf(scenario)), s_(bench_.turntable_procedure), dwell_(scenario.seed, "procedure.dwell") {}

  std::vector<Reading> Make();

  void AddCircles() {
    for (int setup = 0; setup < s_.SetUps(); ++setup) {
      setup_ = setup;
      for (const int direction : s_.passes) bench_.HasPolygon() ? AddFaces(direction) : AddGrid(direction);
    }
  }

  void AddSweep() {
    for (int k = 0; k < s_.sweep_points; ++k)
      AddStop(Phase::kCalibration, 1, k, 0, s_.sweep_rad * (2.0 * k / (s_.sweep_points - 1) - 1.0));
    ++pass_;
  }

  void AddChecks() {
    const std::vector<int> stops = CheckTeeth(bench_.multitooth.teeth, s_.positions, s_.verification_positions);
    for (const int direction : s_.verification_passes) AddPass(Phase::kVerification, stops, direction);
  }

 private:
  void AddGrid(int direction) {
    AddPass(Phase::kFullCircle, GridTeeth(bench_.multitooth.teeth, s_.positions), direction);
  }

  /// All stops of one pass, given in teeth.
  void AddPass(Phase phase, const std::vector<int>& stops, int direction) {
    for (std::size_t k = 0; k < stops.size(); ++k) {
      const std::size_t position = direction > 0 ? k : stops.size() - 1 - k;
      AddStop(phase, direction, static_cast<int>(position), stops[position], 0.0);
    }
    ++pass_;
  }

  /// Turntable at a tooth plus `offset_rad`, multi-tooth table back by the tooth.
  void AddStop(Phase phase, int direction, int position, int tooth, double offset_rad) {
    const double tooth_rad = 2.0 * units::kPi / bench_.multitooth.teeth;
    const int shift = s_.Of(s_.shifts, setup_);
    Add(phase, direction, position, tooth * tooth_rad + offset_rad, (shift - tooth) * tooth_rad);
  }

  void AddFaces(int direction) {
    for (int k = 0; k < s_.positions; ++k) {
      const int position = direction > 0 ? k : s_.positions - 1 - k, face = bench_.FaceAt(position);
      Add(Phase::kFullCircle, direction, position, bench_.FaceAngle_rad(setup_, face), -face * bench_.Pitch_rad());
    }
    ++pass_;
  }

  void Add(Phase phase, int direction, int position, double turntable_rad, double multitooth_rad) {
    Reading stop;
    stop.reading = static_cast<int>(readings_.size());
    stop.setup = setup_;
    stop.pass = pass_;
    stop.phase = phase;
    stop.direction = direction;
    stop.position = position;
    stop.target_rad = turntable_rad;
    stop.reference_rad = multitooth_rad;
    stop.dwell_s = s_.dwell_s[static_cast<std::size_t>(dwell_.Uniform() * static_cast<double>(s_.dwell_s.size()))];
    readings_.push_back(stop);
  }

  const TurntableSettings& bench_;
  const TurntableProcedureSettings& s_;
  Stream dwell_;
  std::vector<Reading> readings_;
  int setup_ = 0, pass_ = 0;
};

struct TurntablePhase {
  void (TurntableReadings::*add)();
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
      {"calibration", {&TurntableReadings::AddSweep, SweepReadings}},
      {"full_circle", {&TurntableReadings::AddCircles, TurntableCircleReadings}},
      {"verification", {&TurntableReadings::AddChecks, CheckReadings}}};
  const auto found = phases.find(name);
  Require(found != phases.end(), "turntable_procedure.phases holds a phase that does not exist");
  return found->second;
}

std::vector<Reading> TurntableReadings::Make() {
  for (const std::string& phase : s_.phases) (this->*PhaseNamed(phase).add)();
  return std::move(readings_);
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

std::vector<Reading> TurntableSchedule(const Scenario& scenario) {
  return TurntableReadings(scenario).Make();
}

}  // namespace twinbench::procedure
