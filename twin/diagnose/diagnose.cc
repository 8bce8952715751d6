#include "twin/diagnose/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "twin/core/errors.h"
#include "twin/diagnose/encoder/encoder_run.h"
#include "twin/diagnose/encoder/families.h"
#include "twin/diagnose/encoder/harmonic_table.h"
#include "twin/diagnose/encoder/next_measurement.h"
#include "twin/diagnose/engine/analysis.h"
#include "twin/diagnose/gain.h"
#include "twin/diagnose/hob/families.h"
#include "twin/diagnose/hob/hob_answers.h"
#include "twin/diagnose/hob/next_measurement.h"
#include "twin/diagnose/missing.h"
#include "twin/diagnose/redundancy.h"
#include "twin/diagnose/rotary/conventions.h"
#include "twin/diagnose/rotary/rotary_case.h"
#include "twin/diagnose/rotary_search.h"
#include "twin/diagnose/turntable/disturbed.h"
#include "twin/diagnose/turntable/next_measurement.h"
#include "twin/diagnose/turntable/seating.h"
#include "twin/diagnose/turntable/turntable_search.h"

namespace twinbench::diagnose {
namespace {

constexpr double kBaarda = 4.13;       // non-centrality: found in 80 % of cases at a test of 0.1 %
constexpr double kPlausibleTop = 3.0;  // prior deviations: about the largest size that anybody expects

/// What the reports need from a bench.
struct BenchWords {
  std::function<std::string(const std::string& effect, const Eigen::VectorXd& unknowns)> bias;
  std::function<std::string(const std::string&, const std::string&)> next_measurement;
};

Cause CauseOf(const Discrete& discrete) {
  Cause cause;
  cause.effect = discrete.effect;
  cause.where = discrete.where;
  cause.probability = kMostProbable;
  cause.log_evidence = discrete.log_evidence;
  cause.rho = std::sqrt(2.0 * std::max(0.0, discrete.log_evidence));
  return cause;
}

Cause OutlierCause(const NoiseCause& noise, const LinearRun& run) {
  Cause cause = CauseOf({"outliers", "", noise.log_bayes});
  const double share = static_cast<double>(noise.outliers.size()) / std::max(1, run.schedule.Readings());
  const double size = noise.outlier_size * run.sigma.mean();
  const double u_size = size / std::sqrt(2.0 * static_cast<double>(noise.outliers.size()));
  const double u_share = share / std::sqrt(static_cast<double>(noise.outliers.size()));
  cause.parameters = {{"fraction", "1", 1.0, share, u_share, 0.0, 0.5},
                      {"size", run.unit, run.to_SI, size, u_size, 0.0, 1e6 * run.to_SI}};
  return cause;
}

/// The family without what points into the case that made it.
Family Detached(Family family) {
  family.columns = nullptr;
  family.at = nullptr;
  family.base = nullptr;
  return family;
}

std::vector<Accepted> AcceptedOf(const Analysis& analysis) {
  std::vector<Accepted> accepted;
  for (const Pick& pick : analysis.found.picks) {
    const Family& family = analysis.scanner->Families()[static_cast<std::size_t>(pick.family)];
    accepted.push_back({Detached(family), pick.grid_point, pick.amplitudes, pick.columns});
  }
  return accepted;
}

/// What this run would have shown of each cause, and what it would not.
void AddDetectability(const LinearRun& run, const Analysis& analysis, const BenchWords& words,
                      Diagnosis& diagnosis) {
  const std::vector<Family>& families = analysis.scanner->Families();
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& family = families[static_cast<std::size_t>(k)];
    const auto same = [&family](const auto& entry) {
      return entry.effect == family.effect && entry.where == family.where;
    };
    if (family.kind != Kind::kNamed || std::ranges::any_of(diagnosis.detectable, same) ||
        std::ranges::any_of(diagnosis.invisible, same)) {
      continue;
    }
    const Amplitude& a = family.amplitudes.front();
    const double information = analysis.scanner->Information(k), top = kPlausibleTop * a.prior_sd;
    if (top * std::sqrt(information) >= kBaarda) {
      const double smallest = kBaarda / std::sqrt(information);
      diagnosis.detectable.push_back(
          {family.effect, family.where, {a.name, a.unit, a.to_SI, smallest, kNaN, a.lower, a.upper}});
      continue;
    }
    const Eigen::MatrixXd column = top * family.ColumnsAt(family.grid / 2).leftCols(1);
    const Eigen::VectorXd unknowns = analysis.projector->Solve(analysis.noise.Whiten(run, column)).col(0);
    diagnosis.invisible.push_back({family.effect, family.where, words.bias(family.effect, unknowns)});
  }
}

void AddNextMeasurements(const BenchWords& words, std::vector<Cause>& causes) {
  for (Cause& cause : causes) {
    for (const Rival& rival : cause.indistinguishable_from) {
      if (cause.next_measurement.empty())
        cause.next_measurement = words.next_measurement(cause.effect, rival.effect);
    }
    if (cause.next_measurement.empty() && !cause.indistinguishable_from.empty()) {
      cause.next_measurement = "more passes in both directions, with different dwells, and sweeps in yaw and tilt";
    }
  }
}

std::vector<Cause> CausesOf(const std::vector<Discrete>& discrete) {
  std::vector<Cause> causes;
  for (const Discrete& d : discrete) causes.push_back(CauseOf(d));
  return causes;
}

/// Names what the analysis found.
/// @param first  What was decided without it.
Diagnosis DiagnosisOf(const LinearRun& run, const Analysis& analysis, std::vector<Cause> first) {
  Diagnosis diagnosis;
  Naming naming = Name(analysis.found, analysis.scanner->Families(), analysis.threshold, run.noise_free);
  diagnosis.verdict = naming.verdict;
  diagnosis.causes = std::move(naming.causes);
  diagnosis.unknown = std::move(naming.unknown);
  diagnosis.alarm_p = analysis.null.PValue(analysis.found.first_statistic);
  for (const NoiseCause& repair : analysis.repairs) {
    diagnosis.noise.push_back(repair.words);
    const bool named_already = std::ranges::count(first, "outliers", &Cause::effect) > 0;
    if (repair.kind == NoiseCause::Kind::kOutliers && !named_already) first.push_back(OutlierCause(repair, run));
  }
  constexpr double kWorthTelling = 3.0;
  for (const NoiseCause& seen : analysis.observations) {
    if (seen.log_bayes > kWorthTelling) diagnosis.noise.push_back(seen.words);
  }
  for (const Cause& cause : first) diagnosis.alarm_p = std::min(diagnosis.alarm_p, std::exp(-cause.log_evidence));
  if (!first.empty() && diagnosis.verdict == Verdict::kNone) diagnosis.verdict = Verdict::kNamed;
  diagnosis.causes.insert(diagnosis.causes.begin(), first.begin(), first.end());
  diagnosis.readings = run.schedule.Readings();
  return diagnosis;
}

/// A cause goes into the model only if it predicts readings that it was not fitted to.
void JudgeByGain(DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  d.gain = MeasureGain(result.run, result.noise, result.accepted);
  const bool named = d.verdict == Verdict::kNamed || d.verdict == Verdict::kTie;
  if (!named || result.accepted.empty() || d.gain.folds == 0 || d.gain.positive) return;
  constexpr double kNotProven = 0.6;
  for (Cause& cause : d.causes) cause.probability = std::min(cause.probability, kNotProven);
  d.notes.push_back(
      "the gain on held-out passes is not above zero at 95 %: the cause is a proposal, not part of the model");
}

DiagnosisRun Finish(const LinearRun& run, const Analysis& analysis, const std::vector<Cause>& first,
                    const BenchWords& words) {
  DiagnosisRun result;
  RefuseWithoutRedundancy(run, analysis.redundancy);
  result.diagnosis = DiagnosisOf(run, analysis, first);
  result.run = run;
  result.noise = analysis.noise;
  result.accepted = AcceptedOf(analysis);
  AddDetectability(run, analysis, words, result.diagnosis);
  AddNextMeasurements(words, result.diagnosis.causes);
  JudgeByGain(result);
  return result;
}

BenchWords RotaryWords(const rotary::RotaryCase& rotary) {
  return {[design = rotary.Rotary().design](const std::string&, const Eigen::VectorXd& x) {
            return rotary::BiasInWords(design, x);
          },
          rotary::NextMeasurement};
}

DiagnosisRun DiagnoseRotary(const std::vector<Reading>& as_read, const Scenario& scenario,
                            const DiagnoseOptions& options) {
  rotary::ConventionResult convention{"", 0.0, as_read};
  if (!IsStruck(options, "convention")) convention = rotary::ScreenConventions(as_read, scenario, ForwardModelOf(options));
  SearchedRotary searched = SearchRotary(convention.readings, scenario, options);
  if (!convention.where.empty())
    searched.discrete.insert(searched.discrete.begin(), {"convention", convention.where, convention.log_evidence});
  const rotary::RotaryCase& rotary = *searched.rotary;
  DiagnosisRun result =
      Finish(rotary.Rotary().run, searched.analysis, CausesOf(searched.discrete), RotaryWords(rotary));
  for (const char* where : {"reverse_target", "reverse_reference", "index_offset"}) {
    result.diagnosis.invisible.push_back(
        {"convention", where, "the positions that the separated errors belong to"});
  }
  result.diagnosis.left_out = rotary.Rotary().left_out;
  return result;
}

DiagnosisRun DiagnoseEncoder(const std::vector<Reading>& readings, const Scenario& scenario,
                             const DiagnoseOptions& options) {
  const encoder::EncoderRun encoder = encoder::BuildRun(readings, scenario, options.follow);
  const std::vector<Family> families = encoder::Families(encoder, options.struck);
  AnalysisOptions how = AnalysisOptionsOf(options);
  how.most_causes = 8;  // an angle device may well have an error of many orders
  const Analysis analysis = Analyse(encoder.run, families, how);
  const BenchWords words{
      [](const std::string&, const Eigen::VectorXd&) { return std::string("nothing but the device's offset"); },
      encoder::NextMeasurement};
  DiagnosisRun result = Finish(encoder.run, analysis, {}, words);
  result.diagnosis.left_out = encoder.left_out;
  result.diagnosis.harmonics = encoder::HarmonicTable(encoder, analysis.noise);
  return result;
}

BenchWords TurntableWords(const turntable::Places& places) {
  return {[places](const std::string& effect, const Eigen::VectorXd& unknowns) {
            const std::string bias = turntable::BiasInWords(places, unknowns);
            const std::string shown_by = turntable::WhatWouldShow(effect);
            return shown_by.empty() ? bias : bias + "; would be shown by " + shown_by;
          },
          turntable::NextMeasurement};
}

/// Sizes were measured in the usual deviation of the run.
Cause DisturbedCause(const NoiseCause& disturbed, LinearRun run) {
  run.sigma.setConstant(turntable::UsualSigma_rad(run));
  return OutlierCause(disturbed, run);
}

DiagnosisRun DiagnoseTurntable(const std::vector<Reading>& readings, const Scenario& scenario,
                               const DiagnoseOptions& options) {
  const turntable::SearchedTurntable searched =
      turntable::SearchTurntable(readings, scenario, options.struck, AnalysisOptionsOf(options), options.follow);
  const turntable::TurntableRun& turntable = *searched.turntable;
  std::vector<Cause> first = searched.first;
  if (searched.disturbed) first.push_back(DisturbedCause(*searched.disturbed, turntable.run));
  DiagnosisRun result = Finish(turntable.run, searched.analysis, first, TurntableWords(turntable.places));
  if (searched.disturbed) result.diagnosis.noise.push_back(searched.disturbed->words);
  result.diagnosis.left_out = turntable.left_out;
  if (searched.first.empty() && std::isfinite(searched.smallest_seating_rad))
    result.diagnosis.detectable.push_back(turntable::DetectableSeating(searched.smallest_seating_rad));
  return result;
}

DiagnosisRun DiagnoseHob(const std::vector<Reading>& readings, const Scenario& scenario,
                         const DiagnoseOptions& options) {
  const hob::HobRun hob = hob::BuildRun(readings, scenario, options.follow);
  const std::vector<Family> families = hob::Families(hob, options.struck);
  AnalysisOptions how = AnalysisOptionsOf(options);
  how.null_runs = hob::NullRuns(hob, options.null_runs);
  how.most_causes = 6;
  const Analysis analysis = hob::AnalyseToFirstOrder(hob, families, how);
  const BenchWords words{[orders = scenario.transmission.free_orders](
                             const std::string&, const Eigen::VectorXd& x) { return hob::BiasInWords(orders, x); },
                         hob::NextMeasurement};
  DiagnosisRun result = Finish(hob.run, analysis, hob::DisturbedCauses(hob, options.struck), words);
  hob::ToReadings(hob, result);
  return result;
}

}  // namespace

DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                      const DiagnoseOptions& options) {
  DiagnosisRun result = scenario.bench == kRotaryBench      ? DiagnoseRotary(readings, scenario, options)
                        : scenario.bench == kTurntableBench ? DiagnoseTurntable(readings, scenario, options)
                        : scenario.bench == kHobBench       ? DiagnoseHob(readings, scenario, options)
                                                            : DiagnoseEncoder(readings, scenario, options);
  const std::vector<std::string> missing = MissingColumns(readings, scenario.bench);
  result.diagnosis.notes.insert(result.diagnosis.notes.end(), missing.begin(), missing.end());
  return result;
}

}  // namespace twinbench::diagnose
