#include <cmath>

#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/benches/turntable_autocollimator/diagnosis/outliers.h"
#include "twin/benches/turntable_autocollimator/diagnosis/seating.h"
#include "twin/benches/turntable_autocollimator/diagnosis/turntable_run.h"
#include "twin/benches/turntable_autocollimator/diagnosis/turntable_search.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/factory.h"
#include "twin/diagnose/conclusion.h"

namespace twinbench::benches::turntable {
namespace {

diagnose::AnswerWords Words(const diagnose::turntable::Places& places, bool has_polygon) {
  return {[places, has_polygon](const std::string& effect, const Eigen::VectorXd& unknowns) {
            const std::string bias = diagnose::turntable::BiasInWords(places, unknowns);
            const std::string shown_by = WhatWouldShow(effect, has_polygon);
            return shown_by.empty() ? bias : bias + "; would be shown by " + shown_by;
          },
          [has_polygon](const std::string& effect, const std::string& rival) {
            return NextMeasurement(effect, rival, has_polygon);
          }};
}

/// Sizes were measured in the usual deviation of the run.
diagnose::Cause DisturbedCause(const diagnose::NoiseCause& outlying, diagnose::LinearRun run) {
  run.sigma.setConstant(diagnose::turntable::UsualSigma_rad(run));
  return diagnose::OutlierCause(outlying, run);
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  const diagnose::turntable::SearchedTurntable searched = diagnose::turntable::SearchTurntable(
      readings, scenario, options.excluded, diagnose::AnalysisOptionsOf(options), FollowRecord);
  const diagnose::turntable::TurntableRun& turntable = *searched.turntable;
  std::vector<diagnose::Cause> first = searched.first;
  if (searched.outlying) first.push_back(DisturbedCause(*searched.outlying, turntable.run));
  diagnose::DiagnosisRun result = diagnose::Conclude(turntable.run, searched.analysis, first,
                                                     Words(turntable.places, TurntableOf(scenario).HasPolygon()));
  if (searched.outlying) result.diagnosis.noise.push_back(searched.outlying->words);
  result.diagnosis.left_out = turntable.left_out;
  if (searched.first.empty() && std::isfinite(searched.smallest_seating_rad))
    result.diagnosis.detectable.push_back(diagnose::turntable::DetectableSeating(searched.smallest_seating_rad));
  return result;
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  return diagnose::turntable::BuildRun(readings, scenario, FollowRecord).run;
}

}  // namespace twinbench::benches::turntable
