#include "twin/diagnose/conclusion.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/at_jumps.h"
#include "twin/diagnose/engine/alone.h"
#include "twin/diagnose/engine/posterior.h"
#include "twin/diagnose/isolability.h"
#include "twin/diagnose/recurrence.h"
#include "twin/diagnose/redundancy.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

/// The family without what points into the case that made it.
Family Detached(Family family) {
  family.columns = nullptr;
  family.at = nullptr;
  family.base = nullptr;
  return family;
}

std::vector<Accepted> AcceptedOf(const Analysis& analysis) {
  std::vector<Accepted> accepted;
  for (const Term& term : analysis.found.terms) {
    const Family& family = analysis.scanner->Families()[static_cast<std::size_t>(term.family)];
    accepted.push_back({Detached(family), term.grid_point, term.shape, term.amplitudes, term.columns});
  }
  return accepted;
}

/// What this run would have shown of each cause, and what it would not.
void AddDetectability(const LinearRun& run, const Analysis& analysis, const AnswerWords& words,
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
    const double information = analysis.scanner->Information(k), top = tuning::kPlausibleTop * a.prior_sd;
    if (top * std::sqrt(information) >= tuning::kBaarda) {
      const double smallest = tuning::kBaarda / std::sqrt(information);
      diagnosis.detectable.push_back(
          {family.effect, family.where, {a.name, a.unit, a.to_SI, smallest, kNaN, a.lower, a.upper}});
      continue;
    }
    const Eigen::MatrixXd column = top * family.ColumnsAt(family.grid / 2).leftCols(1);
    const Eigen::VectorXd unknowns = analysis.projector->Solve(analysis.noise.Whiten(run, column)).col(0);
    diagnosis.invisible.push_back({family.effect, family.where, words.bias(family.effect, unknowns)});
  }
}

void AddNextMeasurements(const AnswerWords& words, std::vector<Cause>& causes) {
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

/// Far values that come by chance are a cause of the catalogue; those that recur are one that nobody has named.
void TellOutliers(const NoiseCause& repair, const LinearRun& run, std::vector<Cause>& first, Diagnosis& diagnosis) {
  const std::string recurs = RecurrenceOf(repair.outliers, run);
  if (recurs.empty()) {
    if (std::ranges::count(first, "outliers", &Cause::effect) == 0) first.push_back(OutlierCause(repair, run));
    return;
  }
  UnknownPart& unknown = diagnosis.unknown;
  diagnosis.verdict = Verdict::kUnknown;
  unknown.probability = std::max(unknown.probability, tuning::kListed);
  unknown.signature += (unknown.signature.empty() ? "" : " | ") + recurs;
  diagnosis.alarm_p = std::min(diagnosis.alarm_p, std::exp(-repair.log_bayes));
}

/// Without far values that are on their way where a cause jumps.
std::vector<NoiseCause> RepairsOf(const LinearRun& run, const Analysis& analysis) {
  std::vector<NoiseCause> repairs = analysis.repairs;
  const auto are_outliers = [](const NoiseCause& repair) { return repair.kind == NoiseCause::Kind::kOutliers; };
  if (std::ranges::none_of(repairs, are_outliers) || analysis.found.terms.empty()) return repairs;
  const Eigen::VectorXd left = FitAll(run, analysis.noise, AcceptedOf(analysis)).after;
  Eigen::VectorXd found = Eigen::VectorXd::Zero(run.Rows());
  for (const Term& term : analysis.found.terms) found += term.columns * term.amplitudes;
  for (NoiseCause& repair : repairs)
    if (are_outliers(repair)) repair.outliers = AwayFromJumps(repair.outliers, run, found, left);
  std::erase_if(repairs, [&](const NoiseCause& repair) { return are_outliers(repair) && repair.outliers.empty(); });
  return repairs;
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
  for (const NoiseCause& repair : RepairsOf(run, analysis)) {
    diagnosis.noise.push_back(repair.words);
    if (repair.kind == NoiseCause::Kind::kOutliers) TellOutliers(repair, run, first, diagnosis);
  }
  for (const NoiseCause& seen : analysis.observations) {
    if (seen.log_bayes > tuning::kWorthTelling) diagnosis.noise.push_back(seen.words);
  }
  for (const Cause& cause : first) diagnosis.alarm_p = std::min(diagnosis.alarm_p, std::exp(-cause.log_evidence));
  if (!first.empty() && diagnosis.verdict == Verdict::kNone) diagnosis.verdict = Verdict::kNamed;
  diagnosis.causes.insert(diagnosis.causes.begin(), first.begin(), first.end());
  diagnosis.readings = run.schedule.Readings();
  return diagnosis;
}

Cause UnfittedCause(const CauseKey& key, double probability) {
  Cause cause;
  std::tie(cause.effect, cause.where) = key;
  cause.probability = probability;
  return cause;
}

/// @return of every place that has a name, the names that the answer leaves out.
std::vector<Cause> LessLikelyOf(const Analysis& analysis) {
  constexpr double kLeast = 0.01;
  std::vector<Cause> less_likely;
  for (const Term& term : analysis.found.terms) {
    const Posterior posterior = PosteriorOf(term, analysis.scanner->Families());
    const std::vector<Share> listed = CredibleSet(posterior);
    if (listed.empty() || posterior.unknown > 0.5) continue;
    for (const auto& [key, p] : Outside(listed, posterior, kLeast)) {
      less_likely.push_back(UnfittedCause(key, p));
      less_likely.back().indistinguishable_from = {{listed.front().first.first, listed.front().first.second}};
    }
  }
  return less_likely;
}

/// Of an answer that is one thing without a name.
/// @param suspects  With the sizes that they have alone.
std::vector<Cause> UnsizedOf(const Analysis& analysis, const std::vector<Cause>& suspects) {
  constexpr double kLeast = 0.01;
  std::vector<Cause> unsized;
  if (analysis.found.terms.size() != 1 || analysis.found.terms.front().log_with_unsized.size() == 0) return unsized;
  Term term = analysis.found.terms.front();
  const auto& families = analysis.scanner->Families();
  Posterior before = PosteriorOf(term, families);
  term.log_posterior = term.log_with_unsized;
  for (const auto& [key, p] : PosteriorOf(term, families).named) {
    const auto alone = std::ranges::find_if(
        suspects, [&name = key](const Cause& c) { return CauseKey(c.effect, c.where) == name; });
    if (p < before.named[key] + kLeast || alone == suspects.end()) continue;
    unsized.push_back(*alone);
    unsized.back().probability = p;
  }
  return unsized;
}

/// What the rows that recur show, for a scenario that repeats it at these readings.
void AcceptRecurrent(const Analysis& analysis, DiagnosisRun& result) {
  for (const NoiseCause& repair : analysis.repairs) {
    if (repair.kind != NoiseCause::Kind::kOutliers || RecurrenceOf(repair.outliers, result.run).empty()) continue;
    const Eigen::VectorXd left = FitAll(result.run, result.noise, result.accepted).after;
    Accepted far;
    far.family.kind = Kind::kUnknown;
    far.family.effect = "far values";
    far.family.amplitudes = {{"size", "1", 1.0, 1.0}};
    far.amplitudes = Eigen::VectorXd::Ones(1);
    far.columns = Eigen::MatrixXd::Zero(result.run.Rows(), 1);
    far.columns(repair.outliers, 0) = left(repair.outliers);
    result.accepted.push_back(std::move(far));
  }
}

}  // namespace

AnalysisOptions AnalysisOptionsOf(const DiagnoseOptions& options) {
  AnalysisOptions how{options.null_runs, options.cache_folder, 4, nullptr, options.design_only};
  how.threads = options.threads;
  return how;
}

bool IsExcluded(const DiagnoseOptions& options, const std::string& effect) {
  return std::ranges::find(options.excluded, effect) != options.excluded.end();
}

Cause DecidedCause(const std::string& effect, const std::string& where, double log_evidence) {
  Cause cause;
  cause.effect = effect;
  cause.where = where;
  cause.probability = tuning::kListed;
  cause.log_evidence = log_evidence;
  cause.rho = std::sqrt(2.0 * std::max(0.0, log_evidence));
  return cause;
}

/// Of their size in the catalogue.
ChannelUnit UnitOfOutliers(const std::string& bench) {
  const EffectEntry* const entry = FindEffect("outliers", bench);
  Require(entry != nullptr, "a bench that counts outliers in a unit has them in its catalogue");
  const EffectParameter& size = *std::ranges::find(entry->parameters, "size", &EffectParameter::name);
  return {size.unit, size.to_SI};
}

Cause OutlierCause(const NoiseCause& noise, const LinearRun& run) {
  Cause cause = DecidedCause("outliers", "", noise.log_bayes);
  std::set<int> readings;
  for (const int row : noise.outliers) readings.insert(run.ReadingOf(row));
  const auto count = static_cast<double>(readings.size());
  const double share = count / std::max(1, run.schedule.Readings());
  const bool is_of_reading = !std::isfinite(run.outlier_per_noise);
  const double size = noise.outlier_size * (is_of_reading ? run.sigma.mean() : run.outlier_per_noise);
  const ChannelUnit told = is_of_reading ? run.UnitOf(0) : UnitOfOutliers(run.bench);
  const double u_size = size / std::sqrt(2.0 * count);
  const double u_share = share / std::sqrt(count);
  cause.parameters = {{"fraction", "1", 1.0, share, u_share, 0.0, 0.5},
                      {"size", told.name, told.to_SI, size, u_size, 0.0, 1e6 * told.to_SI}};
  return cause;
}

DiagnosisRun Conclude(const LinearRun& run, const Analysis& analysis, const std::vector<Cause>& first,
                      const AnswerWords& words) {
  DiagnosisRun result;
  RefuseWithoutRedundancy(run, analysis.redundancy);
  result.diagnosis = DiagnosisOf(run, analysis, first);
  result.structure_p = analysis.null.PValue(analysis.found.first_statistic);
  result.overtones = analysis.found.overtones;
  result.run = run;
  result.noise = analysis.noise;
  result.accepted = AcceptedOf(analysis);
  AcceptRecurrent(analysis, result);
  if (!analysis.design_only)
    result.suspects =
        CausesAlone(run, analysis.noise, *analysis.projector, *analysis.scanner, analysis.found.alone);
  result.less_likely = LessLikelyOf(analysis);
  result.unsized = UnsizedOf(analysis, result.suspects);
  AddDetectability(run, analysis, words, result.diagnosis);
  if (analysis.design_only) result.isolability = std::make_shared<const Isolability>(IsolabilityOf(run, analysis));
  AddNextMeasurements(words, result.diagnosis.causes);
  return result;
}

}  // namespace twinbench::diagnose
