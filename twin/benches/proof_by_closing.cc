#include "twin/benches/proof_by_closing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/expected.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"
#include "twin/procedure/doubted_instruments.h"
#include "twin/procedure/jumps.h"
#include "twin/procedure/step_proof.h"

namespace twinbench {
namespace {

using plausible::Expected;
using procedure::ClaimedColumn;

Duration DwellOf(const Reading& reading) {
  return std::isfinite(reading.dwell_s) ? FromSeconds(reading.dwell_s) : Duration(0);
}

/// By which a pass comes to its first place from behind; 0: it does not.
double RunUp_rad(const Scenario& scenario) {
  if (scenario.bench == kEncoderBench) return 0.5 * units::turn / EncoderOf(scenario).encoder_procedure.stops;
  if (scenario.bench != kTurntableBench) return 0.0;
  const TurntableProcedureSettings& s = TurntableOf(scenario).turntable_procedure;
  return s.run_up_steps * units::turn / s.positions;
}

ClaimedColumn ClaimOf(const Expected& expected, const Scenario& scenario) {
  const auto column = std::ranges::find(FormatOf(scenario.bench).columns, expected.column, &ReadingColumn::name);
  return {.column = *column, .noise = expected.noise, .follows = expected.by_axes, .is_angle = expected.is_angle};
}

std::vector<ClaimedColumn> ClaimsOfMachine(const Scenario& scenario) {
  std::vector<ClaimedColumn> claims;
  for (const Expected& expected : ExpectedOf(scenario, {}))
    if (expected.by_axes) claims.push_back(ClaimOf(expected, scenario));
  if (scenario.bench == kTurntableBench)
    for (ClaimedColumn& claim : claims)
      claim.noise = TurntableOf(scenario).ReadingNoise_rad();  // also of x that is nulled
  return claims;
}

std::vector<ClaimedColumn> ClaimsOfTables(const Scenario& scenario) {
  const RotarySettings& s = RotaryOf(scenario);
  std::vector<ClaimedColumn> claims;
  for (const Expected& expected : ExpectedOf(scenario, {})) {
    claims.push_back(ClaimOf(expected, scenario));
    claims.back().noise =
        std::hypot(s.amplifier.noise_V / std::sqrt(s.adc.samples), expected.step / std::sqrt(12.0));
    claims.back().repeats = 3.0 * s.amplifier.hum_V + 5e-4 * s.adc.range_V;
  }
  return claims;
}

std::vector<ClaimedColumn> ClaimsOfProbe(const Scenario& scenario) {
  constexpr double kShareOfVolts = 0.03, kShareOfPixels = 1e-3;  // that drifts and reversals may change: ten micrometres or so
  std::vector<ClaimedColumn> claims;
  for (const Expected& expected : ExpectedOf(scenario, {})) {
    claims.push_back(ClaimOf(expected, scenario));
    claims.back().repeats = (expected.column.ends_with("_V") ? kShareOfVolts : kShareOfPixels) *
                            FormatOf(scenario.bench).range_of(scenario, expected.column);
  }
  return claims;
}

/// Poses close nothing: behind every tenth of a mounting the axes go back to its first.
std::function<void(const Reading&)> ProofByFirstPose(MachineBench& bench, const Scenario& scenario,
                                                     const procedure::MachineOptions& options) {
  constexpr int kEvery = 10;
  return [&bench, &options, claims = ClaimsOfProbe(scenario), first = std::optional<Reading>()](const Reading& reading) mutable {
    const auto kept = std::ranges::find(options.kept, reading.setup, &Reading::setup);
    if (!first || first->setup != reading.setup || first->reading == reading.reading) first = kept == options.kept.end() ? reading : *kept;
    if ((reading.reading - first->reading + 1) % kEvery != 0) return;
    std::vector<double> by;
    for (const Quantity& axis : benches::freeform::kCommanded) by.push_back(axis(*first) - axis(reading));
    try {
      procedure::RequireAsBefore(claims, procedure::ShownBeside(bench, by, options), *first);
    } catch (const DeviceFault& fault) {
      if (fault.kind() != FaultKind::kImplausible) throw;
      throw DeviceFault(FaultKind::kChanged, "instruments",
                        fmt::format("behind reading {} the axes went back to reading {}: {}", reading.reading, first->reading, fault.what()));
    }
  };
}

}  // namespace

std::function<void(const Reading&)> ProofByClosing(MachineBench& bench, const Scenario& scenario,
                                                   const procedure::MachineOptions& options) {
  if (scenario.bench == kFreeformBench) return ProofByFirstPose(bench, scenario, options);
  const double run_up_rad = RunUp_rad(scenario);
  if (!(run_up_rad > 0.0)) return [](const Reading&) {};
  const bool is_table = scenario.bench == kTurntableBench;
  const std::vector<ClaimedColumn> claims = ClaimsOfMachine(scenario);
  return [&bench, &options, run_up_rad, is_table, claims,
          closing = procedure::Closing(claims, options.kept)](Reading reading) mutable {
    if (is_table) reading.target_rad = bench.machine.State()[0].commanded;  // a face is nulled
    closing.Took(reading);
    const Reading* const then = closing.Asks();
    if (!then) return;
    const Reading shown = procedure::ShownAgain(bench, -then->direction * run_up_rad, DwellOf(reading), options);
    for (const ClaimedColumn& claim : claims) claim.column.number(reading) = ValueOf(claim, shown);
    if (!is_table) reading.reference_rad = shown.reference_rad;
    closing.Require(reading);
  };
}

std::function<void(const Reading&)> ProofByClosing(RotaryBench& bench, const Scenario& scenario,
                                                   const procedure::Options& options,
                                                   const std::function<Reading(const Reading&)>& show) {
  const double run_up_rad =
      RotaryOf(scenario).procedure.run_up_steps * units::turn / RotaryOf(scenario).procedure.positions;
  const std::vector<ClaimedColumn> claims = ClaimsOfTables(scenario);
  return [&bench, &options, run_up_rad, claims, show,
          closing = procedure::Closing(claims, options.kept)](const Reading& reading) mutable {
    closing.Took(reading);
    for (const std::size_t a : {0, 1})
      procedure::RequireNotReversed(claims[a], &claims[a + 2], reading, closing.taken());
    for (const std::size_t y : {1, 3}) procedure::RequireNotReversed(claims[y], nullptr, reading, closing.taken());
    const Reading* const then = closing.Asks();
    if (!then || !(run_up_rad > 0.0)) return;
    procedure::ComeAgain(bench, -then->direction * run_up_rad, DwellOf(reading), options);
    closing.Require(show(reading));
  };
}

}  // namespace twinbench
