#include "twin/diagnose/written_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/extend.h"
#include "twin/diagnose/gain.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/words.h"

namespace twinbench::diagnose {
namespace {

/// As a user gets it: by way of its text.
Scenario ReadBack(const Scenario& scenario, const DiagnosisRun& result) {
  return ParseScenario(ExtendedToml(scenario, result, ""), "extended.toml", ".");
}

/// What the file takes from the residuals, by row.
Eigen::VectorXd RemovedByFile(const std::vector<Reading>& readings, const Scenario& scenario, Estimator model,
                              const AgainstScenario& against, const DiagnosisRun& result) {
  const LinearRun extended = against(readings, ReadBack(scenario, result), model);
  if (extended.Rows() != result.run.Rows())
    throw InputError("extended.toml", "it shows other readings than the scenario", "the same ones");
  return result.run.residual - extended.residual;
}

/// What is said where the file shows clearly less than the fit.
void TellWhatIsLost(const DiagnosisRun& result, const Columns& fit, const Eigen::VectorXd& removed,
                    std::vector<std::string>& notes) {
  constexpr double kClearly = 0.02;  // of what was found
  const LinearRun& run = result.run;
  const Projector projector(result.noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const auto power_without = [&](const Eigen::VectorXd& shown) {
    const Eigen::VectorXd left = run.residual - shown;
    return projector.Apply(result.noise.Whiten(run, Eigen::MatrixXd(left))).squaredNorm();
  };
  const Eigen::MatrixXd y = result.noise.Whiten(run, Eigen::MatrixXd(run.residual));
  const Eigen::VectorXd amplitudes =
      FitAmplitudes(projector, result.noise.Whiten(run, fit.S), y, fit.prior_precision);
  const double found = power_without(fit.S * amplitudes), by_file = power_without(removed);
  const double explained = power_without(Eigen::VectorXd::Zero(run.Rows())) - found;
  const double noise = std::max(1.0, found / projector.DegreesOfFreedom());
  const double lost = by_file - found;
  if (!(explained > 0.0) || lost < kClearly * explained || lost < tuning::kBaarda * tuning::kBaarda * noise) return;
  notes.push_back(
      fmt::format("the written scenario shows {} of what was found; a second diagnosis will find the rest",
                  Percent(std::max(0.0, 1.0 - lost / explained))));
}

/// The unbiased fraction and its interval may lie anywhere; none of a variance can be removed twice, and a model
/// that adds as much as there was to remove is no better than one that adds more.
void Bound(Gain& gain) {
  for (double* value : {&gain.fraction_removed, &gain.interval95[0], &gain.interval95[1]})
    *value = std::clamp(*value, -1.0, 1.0);
}

/// A cause goes into the model only if it predicts readings that it was not fitted to.
void ProposeOnly(Diagnosis& d) {
  const bool named = d.verdict == Verdict::kNamed || d.verdict == Verdict::kTie;
  if (!named || d.gain.folds == 0 || d.gain.positive) return;
  for (Cause& cause : d.causes) cause.probability = std::min(cause.probability, tuning::kNotProven);
  d.notes.push_back(kNoGainNote);
}

}  // namespace

void JudgeByFile(const std::vector<Reading>& readings, const Scenario& scenario, const DiagnoseOptions& options,
                 const AgainstScenario& against, DiagnosisRun& result) {
  if (result.accepted.empty()) return;
  Diagnosis& d = result.diagnosis;
  const Columns fit = ColumnsOf(result.accepted, result.run.Rows());
  try {
    const Eigen::VectorXd removed = RemovedByFile(readings, scenario, options.model, against, result);
    d.gain = MeasureGain(result.run, result.noise, result.accepted, removed);
    TellWhatIsLost(result, fit, removed, d.notes);
  } catch (const InputError& refusal) {
    d.gain = MeasureGain(result.run, result.noise, result.accepted, ShownByFit(result.run, result.accepted));
    d.notes.push_back(fmt::format("the gain is that of the fit, for the written scenario cannot be followed: {}",
                                  refusal.what()));
  }
  Bound(d.gain);
  ProposeOnly(d);
}

}  // namespace twinbench::diagnose
