#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "twin/benches/encoder_comparison/axis_unit.h"
#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/diagnosis/closed_turn.h"
#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/benches/encoder_comparison/diagnosis/few_counts.h"
#include "twin/benches/encoder_comparison/diagnosis/glitches.h"
#include "twin/benches/encoder_comparison/diagnosis/harmonic_table.h"
#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"
#include "twin/benches/encoder_comparison/diagnosis/neighbours.h"
#include "twin/benches/encoder_comparison/diagnosis/speed_limit.h"
#include "twin/benches/encoder_comparison/diagnosis/steady_reference.h"
#include "twin/benches/encoder_comparison/diagnosis/stop_errors.h"
#include "twin/benches/encoder_comparison/diagnosis/told.h"
#include "twin/benches/encoder_comparison/diagnosis/wander.h"
#include "twin/benches/encoder_comparison/estimators/coast_passes.h"
#include "twin/benches/encoder_comparison/twin/factory.h"
#include "twin/core/units.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/extend.h"
#include "twin/diagnose/part_of_readings.h"

namespace twinbench::benches::encoder {
namespace {

constexpr std::size_t kEnough = 2500;  // readings: what has many causes takes ten seconds

/// Sizes of a linear axis are told as lengths; what a cause's wave or way is called stays, and a wave's period is a note.
/// @param turn_m  The way that counts as a turn.
void TellLengths(const AxisUnit& unit, double turn_m, diagnose::Diagnosis& diagnosis) {
  const auto tell = [&unit](diagnose::ParameterEstimate& p) {
    if (!p.unit.starts_with("deg") || p.name == "phase" || p.name == "zero") return;
    p.unit.replace(0, 3, unit.name);
    p.to_SI *= unit.to_SI / units::deg;
  };
  for (diagnose::Cause& cause : diagnosis.causes) std::ranges::for_each(cause.parameters, tell);
  for (diagnose::Detectable& seen : diagnosis.detectable) tell(seen.smallest);
  for (const diagnose::Cause& cause : diagnosis.causes)
    for (const diagnose::ParameterEstimate& p : cause.parameters)
      if (p.name == "order")
        diagnosis.notes.push_back(fmt::format("{} of order {:.6g}: a period of {:.4g} mm", cause.effect, p.value, turn_m / p.value / units::mm));
}

/// Times of lines as the comparison of angles that they come to.
std::vector<Reading> AnglesOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return separate::encoder::HaveStamps(readings) ? separate::encoder::AsComparison(readings)
                                                 : diagnose::encoder::OnSteadyCourse(readings, scenario);
}

Eigen::VectorXd ShownBy(const std::vector<Reading>& readings) {
  Eigen::VectorXd shown_rad(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) shown_rad[static_cast<Eigen::Index>(i)] = readings[i].measured_rad;
  return shown_rad;
}

/// Reading numbers at which something happens once. Beside what has no name, a walk above all, steps may be its pieces.
std::vector<double> EventsOf(const diagnose::Diagnosis& found) {
  constexpr double kLikely = 0.5;
  std::vector<double> events;
  if (!found.unknown.signature.empty()) return events;
  for (const diagnose::Cause& cause : found.causes) {
    for (const diagnose::ParameterEstimate& p : cause.parameters)
      if (p.name == "at_reading" && cause.probability >= kLikely) events.push_back(p.value);
  }
  return events;
}

/// Of causes that were taken out before the search, which the conclusion did not see.
void TellNextMeasurements(std::vector<diagnose::Cause>& causes) {
  for (diagnose::Cause& cause : causes)
    if (cause.next_measurement.empty() && !cause.indistinguishable_from.empty())
      cause.next_measurement = NextMeasurement(cause.effect, cause.indistinguishable_from.front().effect);
}

/// Beside a rest that remembers, a size may turn out to be no more than its own uncertainty: then it is hardly there, however sure
/// the search was. A curve of two numbers may be there though neither is known.
void DoubtUnsized(const diagnose::LinearRun& run, std::vector<diagnose::Cause>& causes) {
  constexpr double kSized = 2.5;
  for (diagnose::Cause& cause : causes) {
    const bool is_bent = std::ranges::any_of(cause.parameters, [](const diagnose::ParameterEstimate& p) { return p.name == "curvature" && p.value != 0.0; });
    if (cause.parameters.empty() || is_bent || cause.effect == "outliers") continue;
    const double deviations = diagnose::encoder::Deviations(diagnose::EffectOf(cause, run.bench, ""));
    if (!(deviations > 0.0) || deviations >= kSized) continue;
    cause.probability *= diagnose::encoder::ChanceOfSize(deviations, 0.5 * std::log(run.Rows()));
  }
}

/// A search that has looked at a part of the readings leaves the orders of all to a table: it takes no time.
std::vector<diagnose::Harmonic> HarmonicsOf(const diagnose::encoder::EncoderRun& encoder) {
  return diagnose::encoder::HarmonicTable(encoder, {encoder.run.sigma, {}});
}

diagnose::DiagnosisRun DiagnoseAll(std::vector<Reading> readings, const std::vector<Reading>& all, const Scenario& scenario,
                                   diagnose::DiagnoseOptions options) {
  if (diagnose::encoder::IsClosedTurn(readings)) options.excluded.insert(options.excluded.end(), {"scale", "slip"});
  std::optional<diagnose::encoder::SpeedLimit> limit;
  if (!options.design_only) limit = diagnose::encoder::SpeedLimitOf(readings, scenario, FollowRecord);
  if (limit) readings = limit->allowed;
  const diagnose::encoder::LargeCauses large =
      diagnose::encoder::FindLargeCauses(readings, scenario, options, FollowRecord);
  const diagnose::encoder::Searched& searched = large.Last();
  const diagnose::AnswerWords words{
      [](const std::string&, const Eigen::VectorXd&) { return std::string("nothing but the device's offset"); },
      NextMeasurement};
  diagnose::DiagnosisRun result = diagnose::Conclude(searched.encoder.run, searched.analysis, {}, words);
  diagnose::encoder::AddLargeCauses(large, result);
  TellNextMeasurements(result.diagnosis.causes);
  diagnose::encoder::AddErrorsOfTargets(large, result);
  diagnose::encoder::TellEqualSteps(result);
  diagnose::encoder::TellCurveInPieces(result);
  diagnose::encoder::TellOrFirstOrder(large.first->encoder.context, result);
  diagnose::encoder::TellOrCurve(large.first->encoder.context, result);
  diagnose::encoder::TellOtherLag(large, result.diagnosis);
  diagnose::encoder::TellMeanRatio(result);
  diagnose::encoder::TellWander(large.bent, result);
  diagnose::encoder::TellGlitches(large.first->encoder.glitches, scenario, result);
  if (limit) diagnose::encoder::TellSpeedLimit(*limit, result);
  DoubtUnsized(result.run, result.diagnosis.causes);
  diagnose::encoder::DoubtLeadingLoops(large.first->encoder, result);
  diagnose::encoder::DoubtFewCounts(ShownBy(large.first->encoder.used), result);
  result.diagnosis.left_out = (limit ? limit->asked : searched.encoder).left_out;
  const bool is_all = limit || readings.size() == all.size();
  result.diagnosis.harmonics = is_all ? diagnose::encoder::HarmonicTable(large.first->encoder, {searched.encoder.run.sigma, {}})
                                      : HarmonicsOf(diagnose::encoder::BuildRun(all, scenario, FollowRecord));
  const DeviceSettings& device = EncoderOf(scenario).device;
  if (device.turn_m > 0.0) TellLengths(CoarseUnit(device), device.turn_m, result.diagnosis);
  return result;
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& recorded, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  const std::vector<Reading> all = AnglesOf(recorded, scenario);
  if (const std::vector<Reading> means = diagnose::encoder::MeansOfNeighbours(all, kEnough); !means.empty()) {
    diagnose::DiagnosisRun result = DiagnoseAll(means, means, scenario, options);
    result.diagnosis.notes.push_back(fmt::format("{} means of neighbours were looked at, of {} readings: where something began is known to a mean",
                                                 means.size(), all.size()));
    return result;
  }
  std::vector<Reading> looked_at = diagnose::PartOf(all, {.enough = kEnough});
  diagnose::DiagnosisRun result = DiagnoseAll(looked_at, all, scenario, options);
  if (looked_at.size() == all.size()) return result;
  const std::vector<double> events = EventsOf(result.diagnosis);
  if (!events.empty()) {
    looked_at = diagnose::PartOf(all, {.events = events, .enough = kEnough});
    result = DiagnoseAll(looked_at, all, scenario, options);
  }
  result.diagnosis.notes.push_back(fmt::format("{} of {} readings were looked at, in groups of neighbours{}",
                                               looked_at.size(), all.size(),
                                               events.empty() ? ": where something began is known to a group"
                                                              : ", and all about what happens once"));
  return result;
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  return diagnose::encoder::BuildRun(diagnose::PartOf(AnglesOf(readings, scenario), {.enough = kEnough}), scenario, FollowRecord).run;
}

}  // namespace twinbench::benches::encoder
