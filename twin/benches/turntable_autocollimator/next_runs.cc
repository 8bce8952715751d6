#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::turntable {
namespace {

using plan::NextRun;

const std::string kCirclePhase = "turntable_procedure.phases=[\"full_circle\"]";
const std::string kSweepPhase = "turntable_procedure.phases=[\"calibration\"]";
/// No whole number of pixels apart.
const std::string kSweepPoints = "turntable_procedure.sweep_points=41";

std::string Listed(const std::string& key, const std::vector<double>& values, double unit) {
  std::vector<double> shown;
  for (const double value : values) shown.push_back(value / unit);
  return fmt::format("turntable_procedure.{}=[{:.9g}]", key, fmt::join(shown, ", "));
}

NextRun OtherTilts(const TurntableProcedureSettings& p) {
  std::vector<double> tilts = p.tilts_rad;
  for (double& tilt : tilts) tilt = -1.7 * tilt;
  return {"other-tilts",
          "the circle with the multi-tooth table's axis tilted otherwise",
          {kCirclePhase, Listed("tilts_arcsec", tilts, units::arcsec)},
          plan::kOtherKind};
}

NextRun OffCentre(const TurntableProcedureSettings& p) {
  std::vector<double> eccentricities = p.eccentricities_m;
  for (double& e : eccentricities) e += 1.0 * units::mm;
  return {"off-centre",
          "the circle with the multi-tooth table a millimetre off the axis",
          {kCirclePhase, Listed("eccentricities_um", eccentricities, units::um)},
          plan::kOtherKind};
}

NextRun LongerReadings(const CollimatorSettings& c) {
  const int frames = plan::kTimesTheReadings * c.frames;
  return plan::LongerReadings(fmt::format("the same measuring positions, each reading the mean of {} frames", frames),
                              "autocollimator.frames", frames);
}

/// Circles with a polygon: there is nothing to sweep it against, and no teeth to shift.
std::vector<NextRun> PolygonRuns(const Scenario& scenario) {
  const TurntableProcedureSettings& p = TurntableOf(scenario).turntable_procedure;
  constexpr double kOffCentre_m = 0.3 * units::mm, kAside_rad = 1.7 * units::deg;
  std::vector<double> tilts = p.tilts_rad, eccentricities = p.eccentricities_m, offsets = p.polygon_offsets_rad;
  for (double& tilt : tilts) tilt += 60.0 * units::arcsec;
  for (double& e : eccentricities) e += kOffCentre_m;
  for (double& offset : offsets) offset = std::fmod(offset + kAside_rad, units::turn);
  return {
      {"other-offsets",
       "the polygon clamped between the places where it was",
       {Listed("polygon_offsets_deg", offsets, units::deg)},
       plan::kSameKind},
      {"other-tilts",
       "the circle with the polygon tilted by another minute of arc",
       {Listed("tilts_arcsec", tilts, units::arcsec)},
       plan::kOtherKind},
      {"off-centre",
       "the circle with the polygon 0.3 mm further off the axis",
       {Listed("eccentricities_um", eccentricities, units::um)},
       plan::kOtherKind},
      {"both-ways",
       "the circle with passes + - - +",
       {"turntable_procedure.passes=[1, -1, -1, 1]"},
       plan::kSameKind},
      {"dwells",
       "the circle with dwells from 0.5 to 20 s",
       {"turntable_procedure.dwell_s=[0.5, 2, 8, 20]"},
       plan::kOtherKind},
      {"warm",
       "the circle at a temperature 2 K higher",
       {fmt::format("environment.temperature_degC={}", scenario.environment.temperature_degC + 2.0)},
       plan::kOtherKind},
      {"warming", "the circle while the temperature rises by 2 K per hour", {"environment.drift_K_h=2"}, plan::kOtherKind},
      LongerReadings(TurntableOf(scenario).collimator)};
}

}  // namespace

std::vector<NextRun> NextRunsOf(const Scenario& scenario) {
  const TurntableSettings& own = TurntableOf(scenario);
  const TurntableProcedureSettings& p = own.turntable_procedure;
  if (own.HasPolygon()) return PolygonRuns(scenario);
  constexpr double kOfTheRange = 0.8, kCoarse = 2.0;
  const double wide_arcsec = kOfTheRange * own.autocollimator.range_rad / units::arcsec;
  const double warmer_degC = scenario.environment.temperature_degC + 2.0;
  return {{"sweep",
           "the turntable alone swept through the readings' range, the multi-tooth table seated",
           {kSweepPhase, kSweepPoints},
           plan::kSameKind},
          {"wide-sweep",
           "the same sweep over most of the autocollimator's range",
           {kSweepPhase, kSweepPoints, fmt::format("turntable_procedure.sweep_arcsec={:.6g}", wide_arcsec)},
           plan::kOtherKind},
          OtherTilts(p),
          OffCentre(p),
          {"both-ways",
           "the circle with passes + - - +",
           {kCirclePhase, "turntable_procedure.passes=[1, -1, -1, 1]"},
           plan::kSameKind},
          {"dwells",
           "the circle with dwells from 0.5 to 20 s",
           {kCirclePhase, "turntable_procedure.dwell_s=[0.5, 2, 8, 20]"},
           plan::kOtherKind},
          {"shifts",
           "the circle with the multi-tooth table at three places",
           {kCirclePhase,
            fmt::format("turntable_procedure.shifts_teeth=[0, {}, {}]", own.multitooth.teeth / 5,
                        own.multitooth.teeth * 2 / 3),
            Listed("tilts_arcsec", {p.tilts_rad.front()}, units::arcsec),
            Listed("eccentricities_um", {p.eccentricities_m.front()}, units::um),
            "turntable_procedure.tilt_azimuths_deg=[0]"},
           plan::kSameKind},
          {"half-the-stops",
           "every other measuring position of the circle",
           {kCirclePhase, fmt::format("turntable_procedure.positions={:.0f}", p.positions / kCoarse)},
           plan::kSameKind},
          {"warm",
           "the circle at a temperature 2 K higher",
           {kCirclePhase, fmt::format("environment.temperature_degC={}", warmer_degC)},
           plan::kOtherKind},
          {"warming",
           "the circle while the temperature rises by 2 K per hour",
           {kCirclePhase, "environment.drift_K_h=2"},
           plan::kOtherKind},
          LongerReadings(own.collimator)};
}

}  // namespace twinbench::benches::turntable
