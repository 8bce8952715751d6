#include "twin/diagnose/disagreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "twin/core/robust_scale.h"
#include "twin/diagnose/accepted_columns.h"

namespace twinbench::diagnose {
namespace {

constexpr double kMany = 100.0;       // times the noise
constexpr double kUnexplained = 0.5;  // of the deviation, where the causes found explain less than they leave

/// In units of the noise of each row; by the middle of the sizes, which single values do not move.
double Typical(const Eigen::VectorXd& left, const Eigen::VectorXd& sigma) {
  return RobustDeviation(left.cwiseQuotient(sigma));
}

}  // namespace

Disagreement DisagreementOf(const DiagnosisRun& found) {
  Disagreement disagreement;
  if (found.run.noise_free || !found.run.sigma_stated) return disagreement;
  const LeftOver left = FitAll(found.run, found.noise, found.accepted);
  disagreement.before = Typical(left.before, found.run.sigma);
  disagreement.after = Typical(left.after, found.run.sigma);
  if (disagreement.before < kMany) return disagreement;
  disagreement.is_plausible = disagreement.after < kMany || disagreement.after < kUnexplained * disagreement.before;
  disagreement.line = fmt::format(
      "the readings differ from the scenario by {:.0f} times their noise; once all that was found is taken into account, by {}",
      disagreement.before, disagreement.after < 1.0 ? "no more than their noise" : fmt::format("{:.0f} times their noise", disagreement.after));
  if (!disagreement.is_plausible)
    disagreement.line += ": are they of this bench, this scenario and in these units?";
  return disagreement;
}

}  // namespace twinbench::diagnose
