#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/plan/next_run.h"
#include "twin/plan/shift_sets.h"

namespace twinbench::benches::rotary {
namespace {

using plan::NextRun;

std::string Shifts(int positions, int count) {
  return fmt::format("procedure.shifts=[{}]", fmt::join(plan::BestShifts(positions, count).shifts, ", "));
}

/// Wide, but with the spots still well on both PSDs: a tilt moves them by about twice the distance times it.
double WideSweep_arcsec(const RotarySettings& own) {
  constexpr double kShareOfHalf = 0.4, kTimes = 4.0;
  const auto reach = [](const PsdSettings& psd) {
    return kShareOfHalf * 0.5 * std::min(psd.width_m, psd.height_m) / (2.0 * psd.distance_m);
  };
  const double widest_rad = std::min(reach(own.psd_a), reach(own.psd_b));
  return std::min(kTimes * own.procedure.sweep_rad, widest_rad) / units::arcsec;
}

/// Scans cost next to no time beside the moves.
NextRun LongerReadings(const RotarySettings& own) {
  constexpr int kMost = 10'000'000;
  return plan::LongerReadings("the same run, every reading the mean of sixteen times as many scans", "adc.samples",
                              std::min(kMost / plan::kTimesTheReadings, own.adc.samples) * plan::kTimesTheReadings);
}

/// Two set-ups of the circle, forth and back: the least that leaves something to find causes by.
std::vector<std::string> TwoSetups(const RotarySettings& own, std::vector<std::string> more) {
  more.insert(more.begin(), {"procedure.phases=[\"calibration\", \"full_circle\"]", Shifts(own.procedure.positions, 2),
                             "procedure.passes=[1, -1]"});
  return more;
}

std::vector<NextRun> OfTheCircle(const RotarySettings& own) {
  const int n = own.procedure.positions;
  const std::string circle = "procedure.phases=[\"calibration\", \"full_circle\"]";
  std::vector<NextRun> runs = {{"dwells",
                                "two mountings of the circle with dwells from 0.5 to 20 s",
                                {circle, Shifts(n, 2), "procedure.dwell_s=[0.5, 2, 8, 20]"},
                                plan::kOtherKind},
                               {"two-shifts", "two mountings of the circle, forth and back", TwoSetups(own, {}),
                                plan::kSameKind},
                               {"other-shifts",
                                "four mountings at the most informative shifts",
                                {circle, Shifts(n, std::min(4, n)), "procedure.passes=[1, -1, -1, 1]"},
                                plan::kSameKind}};
  if (n % 2 == 0 && n > 6)
    runs.push_back({"half-the-stops",
                    "every other measuring position, six mountings, forth and back",
                    {circle, fmt::format("procedure.positions={}", n / 2), Shifts(n / 2, std::min(6, n / 2)),
                     "procedure.passes=[1, -1]"},
                    plan::kSameKind});
  return runs;
}

std::vector<NextRun> OfTheSweeps(const RotarySettings& own) {
  const std::string points = "procedure.sweep_points=25";
  return {{"sweeps", "finer sweeps in yaw and in tilt beside the autocollimator, then two mountings", TwoSetups(own, {points}),
           plan::kSameKind},
          {"wide-sweeps", "the same with sweeps as wide as the PSDs allow",
           TwoSetups(own, {points, fmt::format("procedure.sweep_arcsec={:.6g}", WideSweep_arcsec(own))}), plan::kOtherKind},
          {"farther", "the same with both PSDs half as far again",
           TwoSetups(own, {points, fmt::format("psd_a.distance_mm={}", 1.5 * own.psd_a.distance_m / units::mm),
                           fmt::format("psd_b.distance_mm={}", 1.5 * own.psd_b.distance_m / units::mm)}),
           plan::kOtherKind}};
}

std::vector<NextRun> InAnotherRoom(const Scenario& scenario, const RotarySettings& own) {
  constexpr double kWarmer_K = 2.0;
  const double warm_degC = scenario.environment.temperature_degC + kWarmer_K;
  return {{"warming", "two mountings while the temperature rises by 2 K per hour",
           TwoSetups(own, {fmt::format("environment.drift_K_h={}", kWarmer_K)}), plan::kOtherKind},
          {"warm", "finer sweeps and two mountings at a temperature 2 K higher",
           TwoSetups(own, {"procedure.sweep_points=25", fmt::format("environment.temperature_degC={}", warm_degC)}),
           plan::kOtherKind}};
}

}  // namespace

std::vector<NextRun> NextRunsOf(const Scenario& scenario) {
  const RotarySettings& own = RotaryOf(scenario);
  std::vector<NextRun> runs = {LongerReadings(own)};
  for (const std::vector<NextRun>& more : {OfTheCircle(own), OfTheSweeps(own), InAnotherRoom(scenario, own)})
    runs.insert(runs.end(), more.begin(), more.end());
  return runs;
}

}  // namespace twinbench::benches::rotary
