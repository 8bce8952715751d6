#include "twin/diagnose/written_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/errors.h"
#include "twin/diagnose/aliased_orders.h"
#include "twin/diagnose/extend.h"
#include "twin/diagnose/file_fit.h"
#include "twin/diagnose/gain.h"
#include "twin/diagnose/in_frame.h"
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
                              const AgainstScenario& against, const DiagnosisRun& found) {
  const LinearRun extended = against(readings, ReadBack(scenario, found), model);
  if (extended.Rows() != found.run.Rows())
    throw InputError("extended.toml", "with these causes other readings can be compared than without them", "the same ones");
  return found.run.residual - LeftInFrame(extended, found.run, found.noise);
}

/// What the file shows less than the fit did.
class LostInWriting {
 public:
  explicit LostInWriting(const DiagnosisRun& found)
      : fit_(PowerLeft(found, ShownByFit(found.run, found.accepted))),
        explained_(PowerLeft(found, Eigen::VectorXd::Zero(found.run.Rows())) - fit_),
        noise_(std::max(1.0, fit_ / found.run.Rows())) {}

  double Of(const DiagnosisRun& found, const Eigen::VectorXd& removed) const {
    return PowerLeft(found, removed) - fit_;
  }

  /// Enough to be found again, and no mere rest of slopes that are not the same about the cause.
  bool IsSeen(const DiagnosisRun& found, const Eigen::VectorXd& removed) const {
    constexpr double kRest = 0.01;  // of what was found
    return Of(found, removed) > std::max(tuning::kBaarda * tuning::kBaarda * noise_, kRest * explained_);
  }

  void Tell(const DiagnosisRun& found, const Eigen::VectorXd& removed, std::vector<std::string>& notes) const {
    constexpr double kClearly = 0.02;  // of what was found
    const double lost = Of(found, removed);
    if (!IsSeen(found, removed) || !(lost > kClearly * explained_)) return;
    notes.push_back(
        fmt::format("the written scenario shows {} of what was found; a second diagnosis will find the rest",
                    Percent(std::max(0.0, 1.0 - lost / explained_))));
  }

 private:
  double fit_, explained_, noise_;
};

/// Sizes that the file itself shows best, where they bring back most of what was lost. Less comes of other reasons
/// than their size.
void TakeIfItHelps(const LostInWriting& lost, const RemovedBy& removed_by, DiagnosisRun& result,
                   Eigen::VectorXd& removed) {
  constexpr double kMost = 0.75;
  DiagnosisRun moved = result;
  Eigen::VectorXd now = removed;
  FitThroughFile(removed_by, moved, now);
  if (lost.Of(moved, now) > (1.0 - kMost) * lost.Of(result, removed)) return;
  result = std::move(moved);
  removed = now;
}

/// The unbiased fraction and its interval may lie anywhere; none of a variance can be removed twice, and a model
/// that adds as much as there was to remove is no better than one that adds more.
void Bound(Gain& gain) {
  for (double* value : {&gain.fraction_removed, &gain.interval95[0], &gain.interval95[1], &gain.another_run})
    *value = std::clamp(*value, -1.0, 1.0);
}

bool IsUnnamed(const Accepted& accepted) {
  return accepted.family.kind == Kind::kUnknown;
}

/// Shapes without a name may spoil what the causes predict: then they go, and stay no more than a proposal.
/// @return whether the causes alone predict readings that they were not fitted to.
bool DoNamedPredict(DiagnosisRun& result) {
  std::vector<Accepted> named = result.accepted;
  if (std::erase_if(named, IsUnnamed) == 0 || named.empty()) return false;
  Gain gain = MeasureGain(result.run, result.noise, named, ShownByFit(result.run, named));
  if (gain.folds == 0 || !gain.positive) return false;
  result.accepted = std::move(named);
  Diagnosis& d = result.diagnosis;
  Bound(gain);
  d.gain = gain;
  d.unknown.probability = std::min(d.unknown.probability, tuning::kNotProven);
  d.notes.push_back("what has no name does not predict passes that it was not fitted to, and is not written");
  return true;
}

/// A cause goes into the model only if it predicts readings that it was not fitted to.
void ProposeOnly(DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  const bool named = d.verdict == Verdict::kNamed || d.verdict == Verdict::kTie;
  if (!named || d.gain.folds == 0 || d.gain.positive || DoNamedPredict(result)) return;
  for (Cause& cause : d.causes) cause.probability = std::min(cause.probability, tuning::kNotProven);
  d.notes.push_back(kNoGainNote);
}

/// Of an answer that is open, members that were not fitted are not expected in the file.
void TellUnsized(DiagnosisRun& result) {
  for (const Cause& cause : result.diagnosis.causes) {
    if (result.diagnosis.verdict == Verdict::kNamed && !HasFittedSize(cause, result.run.bench))
      result.diagnosis.notes.push_back(fmt::format("{} is not written: no size of it was fitted", Place(cause.effect, cause.where)));
  }
}

}  // namespace

void JudgeByFile(const std::vector<Reading>& readings, const Scenario& scenario, const DiagnoseOptions& options,
                 const AgainstScenario& against, DiagnosisRun& result) {
  if (result.accepted.empty()) return;
  const RemovedBy removed_by = [&](const DiagnosisRun& found) {
    return RemovedByFile(readings, scenario, options.model, against, found);
  };
  Diagnosis& d = result.diagnosis;
  try {
    if (options.model != Estimator::kRigorous)
      throw InputError("extended.toml", "the published equations know no effects", "the rigorous model");
    const LostInWriting lost(result);
    Eigen::VectorXd removed = removed_by(result);
    if (lost.IsSeen(result, removed)) TakeIfItHelps(lost, removed_by, result, removed);
    d.gain = MeasureGain(result.run, result.noise, result.accepted, removed);
    lost.Tell(result, removed, d.notes);
  } catch (const InputError& refusal) {
    d.gain = MeasureGain(result.run, result.noise, result.accepted, ShownByFit(result.run, result.accepted));
    d.notes.push_back(fmt::format("the held-out improvement is that of the fit; the scenario with these causes was not tried on the readings: {}",
                                  refusal.what()));
  }
  Bound(d.gain);
  ProposeOnly(result);
  TellUnsized(result);
  TellAliases(result.run, d);
}

}  // namespace twinbench::diagnose
